#include "view_statics.h"

#include <algorithm>

#include "taut/analysis.h"

namespace taut::cli {
namespace {

/// Modes listed on the page, as many as `taut analyze` computes by default.
constexpr std::size_t kMostModes = 10;

viewer::Json VectorsJson(const std::vector<Vec3>& vectors) {
  viewer::Json json = viewer::Json::array();
  for (const Vec3& v : vectors) json.push_back(viewer::ToJson(v));
  return json;
}

}  // namespace

viewer::Json ViewStatics(const ExperimentSpec& experiment) {
  const ModelDef& def = experiment.robot.def;
  LoadCaseSpec unloaded;
  unloaded.weight = false;
  const Equilibrium at = FindEquilibrium(def, unloaded);
  const ForceAnalysis forces = AnalyseForces(def);
  viewer::Json modes = viewer::Json::array();
  const Modes found = at.found ? FindModes(ModelAt(def, at.pose), unloaded) : Modes{};
  for (const Mode& mode : found.modes) {
    if (mode.kind == Mode::Kind::kRigid || modes.size() == kMostModes) continue;
    modes.push_back({{"kind", NameOf(mode.kind)},
                     {"frequency_hz", mode.frequency_hz},
                     {"translation_m", VectorsJson(mode.translation_m)},
                     {"rotation_rad", VectorsJson(mode.turn_rad)}});
  }
  return {{"found", at.found},
          {"reason", at.found ? found.why : at.why},
          {"self_stress_states", forces.self_stress.size()},
          {"feasible", std::any_of(forces.self_stress.begin(), forces.self_stress.end(),
                                   [](const SelfStress& state) { return state.feasible; })},
          {"mechanisms", forces.mechanisms.size()},
          {"rigid_motions", forces.rigid},
          {"cable_tension_n", at.cable_tension_n},
          {"modes", std::move(modes)}};
}

}  // namespace taut::cli
