// Importer of controllers with feedback of NTRT's tetrahedral complex: a JSON file and the networks
// (.nnw) to which it refers. NTRT's code is the only definition of these formats
// (JSONFeedbackControl, JSONGoalControl and tgCPGCableControl at commit f0c52e93); comments below
// cite it.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <sstream>

#include "base/input_file.h"
#include "description/gait/gait_import.h"
#include "description/gait/gait_parts.h"

namespace taut::description {
namespace {

namespace fs = std::filesystem;

constexpr int kRoles = 8;  // number of cables per joint
/// Small step, since amplitudes converge at rates up to 600 1/s.
constexpr double kFeedbackStepS = 0.001;
/// Cables of a joint in the order of NTRT's nodes.
const std::vector<std::string> kOscillators{"outer_front", "outer_right", "outer_back",
                                            "outer_left",  "inner_front", "inner_right",
                                            "inner_left",  "inner_back"};
const std::vector<std::string> kSaid{"frequency", "amplitude", "phase"};

/// Reads the numbers of `KEY: {params: [[...], ...]}`, each from 0 to 1, with `columns` numbers per
/// row.
std::vector<std::vector<double>> ReadParams(const Value& root, const char* key, std::size_t rows,
                                            std::size_t columns, const Scope& scope) {
  const Value* of = root.Find(key);
  const Value* params = of ? of->Find("params") : nullptr;
  std::vector<std::vector<double>> out;
  const std::size_t errors_before = scope.out.items().size();
  if (params) {
    for (const ValuePtr& row : Items(params, key, scope)) {
      auto numbers = ReadNumbers(*row, key, columns, scope);
      if (!numbers) return {};
      for (const double x : *numbers) {
        if (!(x >= 0.0 && x <= 1.0)) {
          scope.out.Error("ntrt.parameter_out_of_range", row->at,
                          std::string(key) + ": parameters must be within 0..1");
          return {};
        }
      }
      out.push_back(std::move(*numbers));
    }
  }
  if (out.size() == rows) return out;
  if (scope.out.items().size() == errors_before) {
    scope.out.Error("ntrt.wrong_number_of_rows", of ? of->at : root.at,
                    std::string(key) + ".params must have " + std::to_string(rows) +
                        " rows, as in NTRT's controllers of spines with eight cables per joint");
  }
  return {};
}

/// Reads the network of `KEY: {params: {neuralFilename: ..., numStates: ...}}`. Its file contains
/// for each input, then for the bias, one weight per hidden neuron. Then it contains for each
/// hidden neuron, then for the bias, one weight per output. The bias neuron has the constant output
/// -1.
std::optional<NetworkSpec> ReadNetwork(const Value& root, const char* key, const fs::path& folder,
                                       const std::vector<std::string>& outputs,
                                       const Scope& scope) {
  const Value* of = root.Find(key);
  const Value* params = of ? of->Find("params") : nullptr;
  if (!params) return std::nullopt;
  MapReader map(*params, key, scope);
  for (const Entry& entry : params->entries) map.Know(entry.key);
  map.RefuseOthers();
  const auto whole = [&](const char* name) {
    const Value* value = map.Require(name);
    return value ? ReadInteger(*value, map.Path(name), 1, 1000, scope).value_or(0) : 0;
  };
  const int inputs = whole("numStates"), hidden = whole("numHidden"), said = whole("numActions");
  const Value* file = map.Require("neuralFilename");
  if (!file || inputs == 0 || hidden == 0 || said == 0) return std::nullopt;
  if (inputs != 2 || said != static_cast<int>(outputs.size())) {
    scope.out.Error("ntrt.wrong_network", params->at,
                    std::string(key) + ": a network with " + std::to_string(inputs) +
                        " inputs and " + std::to_string(said) + " outputs cannot be imported",
                    "expected 2 inputs and " + std::to_string(outputs.size()) +
                        " outputs; gaits have no networks that set tensions");
    return std::nullopt;
  }
  const std::string path = (folder / ReadText(*file, map.Path("neuralFilename"), scope)).string();
  auto text = base::ReadInputFile(path, kMaxFileBytes, "", scope.out);
  if (!text) return std::nullopt;
  std::replace(text->begin(), text->end(), ',', ' ');
  std::istringstream words(*text);
  std::vector<double> weights;
  bool good = true;
  for (std::string word; words >> word;) good = good && ToNumber(word, weights.emplace_back());
  const auto in = static_cast<std::size_t>(inputs), mid = static_cast<std::size_t>(hidden);
  const std::size_t count = (in + 1) * mid + (mid + 1) * outputs.size();
  if (!good || weights.size() != count) {
    scope.out.Error("ntrt.wrong_number_of_weights", {path, 1, 1},
                    "the file must contain " + std::to_string(count) +
                        " numbers, for a network with " + std::to_string(inputs) + ", " +
                        std::to_string(hidden) + " and " + std::to_string(said) + " neurons");
    return std::nullopt;
  }
  NetworkSpec network;
  for (std::size_t j = 0; j < mid; ++j) {
    Neuron neuron{"h" + std::to_string(j + 1), {}, -weights[in * mid + j], {}};
    for (std::size_t i = 0; i < in; ++i) neuron.weights.push_back(weights[i * mid + j]);
    network.hidden.push_back(std::move(neuron));
  }
  const std::size_t first = (in + 1) * mid;
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    Neuron neuron{outputs[k], {}, -weights[first + mid * outputs.size() + k], {}};
    for (std::size_t j = 0; j < mid; ++j) {
      neuron.weights.push_back(weights[first + j * outputs.size() + k]);
    }
    network.outputs.push_back(std::move(neuron));
  }
  return network;
}

}  // namespace

std::optional<GaitSpec> ImportFeedback(const Value& root, const std::string& path,
                                       Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  const NameTable no_names;
  const Scope scope{no_names, out};
  const auto nodes = ReadParams(root, "nodeVals", 1, 5, scope);
  const auto edges = ReadParams(root, "edgeVals", 100, 2, scope);
  const fs::path folder = fs::path(path).parent_path();
  FeedbackCpgGait cpg;
  cpg.cable_network = ReadNetwork(root, "feedbackVals", folder, kSaid, scope);
  std::vector<std::string> of_joint;
  for (const std::string& name : kOscillators) {
    for (const std::string& said : kSaid) of_joint.push_back(name + "_" + said);
  }
  cpg.goal_network = ReadNetwork(root, "goalVals", folder, of_joint, scope);
  if (out.items().size() != errors_before) return std::nullopt;
  if (cpg.goal_network) {  // NTRT's x is taut's y, NTRT's z is taut's x
    for (Neuron& neuron : cpg.goal_network->hidden) std::swap(neuron.weights[0], neuron.weights[1]);
  }
  // Ranges of the learned numbers: frequency 0 to 30 rad/s, squared amplitude 0 to 300 (cm/s)^2.
  // Effects of a feedback of 1: -0.5 to 10 rad/s^2, 0 to 200 (cm/s)^2, -0.5 to 6.28 rad/s. NTRT
  // uses the squared amplitude as convergence rate, too.
  const std::vector<double>& node = nodes[0];
  const double square = 300.0 * node[1];
  cpg.frequency_hz = 30.0 * node[0] / (2.0 * std::numbers::pi);
  cpg.convergence_per_s = square;
  cpg.frequency_gain_hz_per_s = (-0.5 + 10.5 * node[2]) / (2.0 * std::numbers::pi);
  cpg.amplitude_gain = square > 0.0 ? 200.0 * node[3] / square : 0.0;
  cpg.phase_gain_rad_per_s = -0.5 + 6.78 * node[4];
  cpg.integrator_step_s = kFeedbackStepS;
  cpg.symmetry = CpgSymmetry::kIndex;
  if (!(square > 0.0)) {
    out.Error("ntrt.no_amplitude", root.at, "nodeVals: the amplitude must not be 0");
    return std::nullopt;
  }
  for (const std::string& name : kOscillators) {
    FeedbackOscillator oscillator;
    oscillator.name = name;
    oscillator.cables = {{name}};
    oscillator.amplitude = kMetre * std::sqrt(square);
    cpg.oscillators.push_back(std::move(oscillator));
  }
  const std::vector<std::string> names = IndexGroups(kRoles);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::vector<double>& edge = edges[edges.size() - 1 - i];  // NTRT takes actions from the
                                                                    // end of the list
    cpg.groups.push_back({names[i], edge[0] / kMetre,
                          -std::numbers::pi + 2.0 * std::numbers::pi * edge[1], SourceRef{}});
  }
  GaitSpec gait;
  gait.name = "ntrt_feedback";
  gait.description = "Learned by NTRT, imported from " + fs::path(path).filename().string() + ".";
  gait.feedback_cpg = std::move(cpg);
  return gait;
}

}  // namespace taut::description
