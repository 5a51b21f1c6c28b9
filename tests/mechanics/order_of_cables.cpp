/// Order in which a model lists its cables: the dampers' passes depend on it
/// (docs/theory/integrator.md, eq. I8), by less than the error of the step.

#include <algorithm>

#include "tests/mechanics/known_scene.h"
#include "tests/physics/world.h"
#include "tests/scenes/six_strut.h"

namespace taut::mechanics {
namespace {

using test::Distance;
using test::MakeBatch;
using test::StepsIn;

ModelDef OrderedRobot(double damping_n_s_per_m, bool on_ground, bool reversed) {
  scenes::SixStrut robot;
  robot.length_m = 0.6;
  robot.rod_mass_kg = 0.1;
  robot.stiffness_n_per_m = 100;  // explicit forces
  robot.tension_n = 5;
  robot.damping_n_s_per_m = damping_n_s_per_m;
  robot.center_m = {0, 0, 0.35};
  ModelDef def = robot.Def();
  if (on_ground) {
    PlaneDef ground;
    ground.name = "ground";
    ground.material = robot.material;
    def.planes.push_back(ground);
  } else {
    def.gravity_m_per_s2 = {};
  }
  // Off equilibrium, so that the cables work.
  for (CableDef& cable : def.cables) cable.rest_length_m *= 0.9;
  def.bodies[0].velocity_m_per_s = {0.5, -0.3, 0.2};
  if (reversed) std::reverse(def.cables.begin(), def.cables.end());
  return def;
}

double Apart(const ModelDef& a, double step_a, const ModelDef& b, double step_b) {
  constexpr double kTimeS = 0.3;
  WorldBatch one = MakeBatch(a), other = MakeBatch(b);
  one.Step(step_a, StepsIn(kTimeS, step_a));
  other.Step(step_b, StepsIn(kTimeS, step_b));
  double most = 0;
  for (int i = 0; i < static_cast<int>(a.bodies.size()); ++i) {
    most = std::max(most, Distance(one.Body(0, i).position_m, other.Body(0, i).position_m));
  }
  return most;
}

void ReversedCables(Report& report) {
  for (const bool on_ground : {false, true}) {
    const std::string where = on_ground ? "on the ground" : "free";
    for (const double damping : {0.0, 1.0, 5.0, 20.0}) {
      const ModelDef as_listed = OrderedRobot(damping, on_ground, false);
      const double order = Apart(as_listed, 1e-3, OrderedRobot(damping, on_ground, true), 1e-3);
      const double step = Apart(as_listed, 1e-3, as_listed, 2.5e-4);
      report.AtMost(where + ", " + std::to_string(static_cast<int>(damping)) +
                        " N s/m: change due to the cable order, relative to the error of the step",
                    "1", order / step, 0.1);
    }
  }
}

const SceneEntry kReversed(
    "cables", "Six-strut with its cables listed in reverse",
    "after 0.3 s at 1 ms, the poses change by less than the error of the step", ReversedCables);

}  // namespace
}  // namespace taut::mechanics
