// Validation of the motions of kinematic bodies.
#include <set>

#include "math/vec.h"
#include "sim/compile/checker.h"

namespace taut::sim {
namespace {

void CheckLaw(const TimeLaw& law, const std::string& what, Checker& check) {
  double last = -1;
  bool rises = true, finite = true;
  for (const auto& [t, speed] : law.speed) {
    rises = rises && t > last && (last >= 0 || t >= 0);
    finite = finite && std::isfinite(t) && std::isfinite(speed);
    last = t;
  }
  check.Require(finite, what + ": times and speeds must be finite");
  check.Require(!finite || rises, what + ": times must increase, from 0 s or later");
  check.Require(std::isfinite(law.amplitude) && std::isfinite(law.phase_rad),
                what + ": amplitude and phase must be finite");
  check.NonNegative(law.frequency_hz, what + ": frequency");
}

}  // namespace

void CheckMotions(const ModelDef& def, Checker& check) {
  std::set<int> moved;
  for (const MotionDef& m : def.motions) {
    const std::string name = "motion " + m.name;
    const auto unit = [&](const Vec3& v, const char* what) {
      check.Require(std::fabs(Dot(v, v) - 1) < 1e-9, name + ": " + what + " must be a unit vector");
    };
    unit(m.direction, "the direction");
    unit(m.axis, "the axis");
    check.Finite(m.center_m, name + ": center");
    CheckLaw(m.slide, name + ": slide", check);
    CheckLaw(m.turn, name + ": turn", check);
    const bool known = m.body >= 0 && m.body < static_cast<int>(def.bodies.size());
    check.Require(known, name + " refers to a body that does not exist");
    if (!known) continue;
    check.Require(def.bodies[static_cast<std::size_t>(m.body)].fixed,
                  name + ": its body must be fixed: forces do not move it");
    check.Require(moved.insert(m.body).second, name + ": its body already has a motion");
  }
}

}  // namespace taut::sim
