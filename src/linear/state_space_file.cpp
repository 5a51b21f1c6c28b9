// Writer of state-space matrices in an HDF5 file.
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

/// Adds the equilibrium pose: positions, and rotations from the described orientations.
void AddPose(const StateSpace& system, Matrix& position, Matrix& orientation,
             trace::Hdf5Content& content) {
  const int count = static_cast<int>(system.pose.bodies.size());
  position = Matrix(count, 3), orientation = Matrix(count, 4);
  for (int b = 0; b < count; ++b) {
    const BodyState& body = system.pose.bodies[static_cast<std::size_t>(b)];
    const Vec3& p = body.position_m;
    const Quat& q = body.orientation;
    position(b, 0) = p.x, position(b, 1) = p.y, position(b, 2) = p.z;
    orientation(b, 0) = q.w, orientation(b, 1) = q.x, orientation(b, 2) = q.y;
    orientation(b, 3) = q.z;
  }
  content.texts.emplace_back("/rest/bodies", system.bodies);
  content.matrices.emplace_back("/rest/position_m", &position);
  content.matrices.emplace_back("/rest/orientation", &orientation);
  content.texts.emplace_back("/rest/cables", system.cables);
  content.lists.emplace_back("/rest/rest_length_m", system.pose.rest_lengths_m);
}

}  // namespace

bool WriteStateSpace(const StateSpace& system, const std::string& path, Diagnostics& out) {
  trace::Hdf5Content content;
  content.attributes = {
      {"format", "taut linear"},
      {"taut_version", kVersion},
      {"derivatives", system.derivatives == Derivatives::kExact ? "exact" : "differences"}};
  content.numbers = {{"format_version", 1},
                     {"period_s", system.period_s},
                     {"step_s", system.step_s},
                     {"disagreement", system.disagreement}};
  content.matrices = {{"/A", &system.A}, {"/B", &system.B}, {"/C", &system.C}, {"/D", &system.D}};
  AddSignals("states", system.states, content);
  AddSignals("inputs", system.inputs, content);
  AddSignals("outputs", system.outputs, content);
  content.texts.emplace_back("/remarks", system.remarks);
  Matrix position, orientation;
  AddPose(system, position, orientation, content);
  return trace::WriteHdf5(path, content, out);
}

}  // namespace taut
