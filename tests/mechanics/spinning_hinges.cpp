/// Hinges that rotate by many radians a step, and their dampers.

#include <cmath>
#include <cstdlib>
#include <string>

#include "tests/mechanics/jointed_mass.h"
#include "tests/mechanics/known_scene.h"
#include "tests/physics/world.h"

namespace taut::mechanics {
namespace {

using test::MakeBatch;

/// Returns a rotor on a hinge along y without gravity, `beside_m` off its axis.
ModelDef Rotor(double rate_rad_per_s, double beside_m = 0) {
  ModelDef def = PointMass({0, 0, beside_m}, {beside_m * rate_rad_per_s, 0, 0}, 0.01);
  def.gravity_m_per_s2 = {};
  def.bodies[0].angular_velocity_rad_per_s = {0, rate_rad_per_s, 0};
  def.joints.push_back(JointAt(JointKind::kHinge, {}, {0, 1, 0}));
  return def;
}

void SpinningHinge(Report& report) {
  for (const double rate : {200.0, 490.0, 3000.0, 3200.0, -7000.0, 50000.0}) {
    WorldBatch world = MakeBatch(Rotor(rate));
    world.Step(1e-3, 1000);
    const std::string name = std::to_string(static_cast<int>(rate)) + " rad/s, 1 ms";
    // Angles t < 0.25 rad per half step have a relative error of t^4 / 120, others are exact.
    const double half_step = 0.5e-3 * std::abs(rate);
    const double missing = half_step < 0.25 ? std::pow(half_step, 4) / 100 : 1e-12;
    report.Near("angle after 1 s at " + name, "rad", world.Joint(0, 0).coordinate, rate,
                missing * std::abs(rate));
    report.Near("rate at " + name, "rad/s", world.Joint(0, 0).rate, rate, 1e-9 * std::abs(rate));
  }
}

void RotorBesideItsHinge(Report& report) {
  // Half a radian per step is resolved; three are not, and the status reports it.
  for (const double rate : {500.0, 3000.0}) {
    WorldBatch world = MakeBatch(Rotor(rate, 1e-3));
    world.Step(1e-3, 1000);
    const std::string name =
        std::to_string(static_cast<int>(rate)) + " rad/s, 1 mm off the hinge, 1 ms";
    const double wanted = rate < 1000 ? kStatusOk : kStatusStepTooLong;
    report.Near("status bits at " + name, "1", world.Status(0).bits, wanted, 0);
    if (rate > 1000) continue;
    report.Near("angle after 1 s at " + name, "rad", world.Joint(0, 0).coordinate, rate,
                1e-4 * rate);
  }
}

void BrakedRotor(Report& report) {
  // A damper stops a rotor: I w' = -d w, so it rotates by I w0 / d in total.
  ModelDef def = Rotor(5000);
  def.joints[0].damping = 0.05;
  WorldBatch world = MakeBatch(def);
  world.Step(1e-3, 8000);
  // The first half step uses the initial rate; later means are of second order.
  report.Near("angle until the rotor stops, from 5000 rad/s, 1 ms", "rad",
              world.Joint(0, 0).coordinate, 1000, 1e-3);
}

const SceneEntry kSpinningHinge("joint stops", "Hinge that spins by many radians a step",
                                "angle = rate times time", SpinningHinge);
const SceneEntry kRotorBesideItsHinge("joint stops", "Rotor with its center of mass off the hinge",
                                      "angle = rate times time, or a status bit",
                                      RotorBesideItsHinge);
const SceneEntry kBrakedRotor("joint stops", "Rotor braked by a damper", "angle I w / d",
                              BrakedRotor);

}  // namespace
}  // namespace taut::mechanics
