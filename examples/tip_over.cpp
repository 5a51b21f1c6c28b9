// Example of a batch: the force on a corner of the floating table (docs/tutorial_structures.md) at
// which it tips over.
//
//   tip_over docs/tutorial_structures/table.yaml
//
// 32 worlds of one robot, each with a different force. By hand: the pressed corner is as far
// outside of the line through the nearest two feet as the center of mass is inside of it, so a
// rigid table tips when the force exceeds its weight. The corner of a real one sags outwards, which
// lengthens the lever. The example asserts that a table with stiff cables tips at its weight,
// within 1 %, and that a table with cables ten times softer tips earlier.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "taut/spec.h"
#include "taut/world_batch.h"

namespace {

constexpr int kWorlds = 32;
constexpr double kFirstN = 2.4,
                 kBetweenN = 0.025;  // world i: kFirstN + i kBetweenN

/// Returns the description of the table on a floor, with outer cables of the given stiffness.
std::optional<taut::ModelDef> TableOnFloor(const std::string& path, const std::string& side_n_per_m,
                                           taut::Diagnostics& diagnostics) {
  const taut::Overrides overrides{{"side_n_per_m", side_n_per_m},
                                  {"hanger_n_per_m", "5 * side_n_per_m"}};
  auto robot = taut::LoadRobot(path, overrides, diagnostics);
  if (!robot) return std::nullopt;
  taut::PlaneDef floor;
  floor.name = "floor";
  robot->def.planes.push_back(floor);
  return robot->def;
}

int NodeCalled(const taut::ModelDef& def, const std::string& name) {
  const auto found = std::find_if(def.nodes.begin(), def.nodes.end(),
                                  [&](const taut::NodeDef& node) { return node.name == name; });
  return found == def.nodes.end() ? -1 : static_cast<int>(found - def.nodes.begin());
}

/// Returns the least force that tips a table over [N]; negative on failure.
double TippingForce(const taut::ModelDef& def, taut::Diagnostics& diagnostics) {
  const std::shared_ptr<const taut::Model> model = taut::Model::Compile(def, diagnostics);
  const int corner = NodeCalled(def, "upper.a");
  if (!model || corner < 0) return -1.0;
  taut::WorldBatchOptions options;
  options.worlds = kWorlds;
  options.threads = 0;  // one per core; the result does not depend on it
  taut::WorldBatch batch(model, options);

  constexpr double kStepS = 0.001;
  constexpr int kRampSteps = 2000, kHoldSteps = 3000, kStepsABurst = 10;
  for (int step = 0; step < kRampSteps + kHoldSteps; step += kStepsABurst) {
    const double share = std::min(1.0, static_cast<double>(step) / kRampSteps);
    for (int world = 0; world < kWorlds; ++world) {
      batch.SetNodeForce(world, corner, {0.0, 0.0, -share * (kFirstN + world * kBetweenN)});
    }
    batch.Step(kStepS, kStepsABurst);
  }
  for (int world = 0; world < kWorlds; ++world) {
    if (batch.Status(world).bits != taut::kStatusOk) return -1.0;
    if (batch.NodePosition(world, corner).z < 0.1) return kFirstN + world * kBetweenN;
  }
  return -1.0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: tip_over docs/tutorial_structures/table.yaml\n", stderr);
    return 2;
  }
  taut::Diagnostics diagnostics;
  const auto soft = TableOnFloor(argv[1], "1000", diagnostics);
  const auto stiff = TableOnFloor(argv[1], "1e4", diagnostics);
  if (!soft || !stiff) {
    std::fputs(diagnostics.Format().c_str(), stderr);
    return 1;
  }
  double weight_n = 0.0;
  for (const taut::BodyDef& body : stiff->bodies) weight_n += 9.81 * body.mass_kg;
  const double soft_n = TippingForce(*soft, diagnostics);
  const double stiff_n = TippingForce(*stiff, diagnostics);
  std::printf("weight %.4f N; tips over at %.4f N (stiff cables), %.4f N (soft cables)\n", weight_n,
              stiff_n, soft_n);
  const bool good =
      std::abs(stiff_n - weight_n) < 0.01 * weight_n && soft_n > 0.0 && soft_n < stiff_n;
  return good ? 0 : 1;
}
