#include <utility>

#include "taut/state_space.h"
#include "taut/version.h"
#include "trace/hdf5_matrices.h"

namespace taut {
namespace {

void AddSignals(const std::string& kind, const std::vector<LinearSignal>& signals,
                trace::Hdf5Content& content) {
  std::vector<std::string> names, units;
  std::vector<double> at;
  for (const LinearSignal& signal : signals) {
    names.push_back(signal.name), units.push_back(signal.unit), at.push_back(signal.at);
  }
  content.texts.emplace_back("/" + kind + "/name", std::move(names));
  content.texts.emplace_back("/" + kind + "/unit", std::move(units));
  content.lists.emplace_back("/" + kind + "/at", std::move(at));
}

}  // namespace

bool WriteStateSpace(const StateSpace& system, const std::string& path, Diagnostics& out) {
  trace::Hdf5Content content;
  content.attributes = {
      {"format", "taut linear"},
      {"taut_version", kVersion},
      {"derivatives", system.derivatives == Derivatives::kExact ? "exact" : "differences"}};
  content.numbers = {
      {"format_version", 1}, {"period_s", system.period_s}, {"disagreement", system.disagreement}};
  content.matrices = {{"/A", &system.A}, {"/B", &system.B}, {"/C", &system.C}, {"/D", &system.D}};
  AddSignals("states", system.states, content);
  AddSignals("inputs", system.inputs, content);
  AddSignals("outputs", system.outputs, content);
  content.texts.emplace_back("/remarks", system.remarks);
  return trace::WriteHdf5(path, content, out);
}

}  // namespace taut
