/// Cable wrapping on free rods: energy and momentum.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/mechanics/known_scene.h"
#include "tests/physics/touch_scenes.h"

namespace taut::mechanics {
namespace {

struct Gain {
  double most = 0;    ///< Largest energy gain, as a share of the initial energy.
  double silent = 0;  ///< Same for the flights that end without a status bit.
  int told = 0;       ///< Flights that gain more than kMostGain and have a status.
  double drift = 0;   ///< Change of momentum as a share of the initial momentum.
};
constexpr double kMostGain = 1e-3;

/// Returns rods and balls as arranged, or displaced and rotated at random.
ModelDef Scene(int rods, double stiffness, double friction, unsigned seed) {
  ModelDef def = test::AcrossFreeRods(rods, stiffness);
  def.cables[0].touch_friction = friction;
  if (seed == 0) return def;
  std::mt19937 random(seed);
  const auto within = [&](double size) {
    return size * (2.0 * (static_cast<double>(random()) / 4294967295.0) - 1.0);
  };
  for (int i = 0; i < rods; ++i) {
    BodyDef& body = def.bodies[static_cast<std::size_t>(i)];
    const Vec3 old = body.com_m;
    const double dx = within(0.02), dz = within(0.02), yaw = within(0.3);
    body.com_m = old + Vec3{dx, 0, dz};
    const Vec3 along{std::sin(yaw), std::cos(yaw), 0};
    body = test::RodOf(body.mass_kg, body.com_m, along, 0.5, 0.004);
    CapsuleDef& rod = def.capsules[static_cast<std::size_t>(i)];
    rod.from_m = body.com_m - 0.5 * along;
    rod.to_m = body.com_m + 0.5 * along;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    Vec3& v = def.bodies[static_cast<std::size_t>(rods) + i].velocity_m_per_s;
    v.x += within(2), v.y += within(2), v.z += within(2);
  }
  return def;
}

Gain Fly(const ModelDef& def, double step_s) {
  WorldBatch world = test::MakeBatch(def);
  const double start = test::EnergyOf(world);
  const Vec3 momentum = world.Momentum(0);
  Gain gain;
  for (int i = 0; i < test::StepsIn(0.4, step_s); ++i) {
    world.Step(step_s);
    gain.most = std::max(gain.most, (test::EnergyOf(world) - start) / start);
  }
  if (world.Status(0).bits == kStatusOk) {
    gain.silent = gain.most;
  } else if (gain.most > kMostGain) {
    gain.told = 1;
  }
  gain.drift = test::Distance(world.Momentum(0), momentum) / test::Norm(momentum);
  return gain;
}

/// Returns the largest gains with 1 to 20 rods, from starts `first` to `last`.
Gain WorstGain(double stiffness, double friction, double step_s, unsigned first, unsigned last) {
  Gain worst;
  for (const int rods : {1, 2, 3, 5, 10, 20}) {
    for (unsigned seed = first; seed <= last; ++seed) {
      const Gain now = Fly(Scene(rods, stiffness, friction, seed), step_s);
      worst.most = std::max(worst.most, now.most);
      worst.silent = std::max(worst.silent, now.silent);
      worst.told += now.told;
      worst.drift = std::max(worst.drift, now.drift);
    }
  }
  return worst;
}

void IntoFreeRods(Report& report) {
  constexpr double kStiffnesses[] = {1e3, 1e4, 1e5, 1e6};
  constexpr unsigned kRandomStarts = 6;
  for (const double friction : {0.0, 0.3}) {
    for (const double stiffness : kStiffnesses) {
      for (const double step_s : {1e-3, 2.5e-4}) {
        if (!report.IsFull() && step_s < 1e-3 && stiffness > 1e4) continue;
        const std::string name = fmt::format("{:g} N/m, friction {:g}, {:g} ms, 1 to 20 rods",
                                             stiffness, friction, 1e3 * step_s);
        const Gain worst = WorstGain(stiffness, friction, step_s, 0, 0);
        report.AtMost("energy gain above the initial value, " + name, "1", worst.most, kMostGain);
        report.AtMost("change of momentum, " + name, "1", worst.drift, 1e-11);
        if (!report.IsFull()) continue;
        const Gain random = WorstGain(stiffness, friction, step_s, 1, kRandomStarts);
        report.AtMost(
            "energy gain above the initial value, 36 random starts, runs without a status bit", "1",
            random.silent, 1.5e-3);
        report.AtMost("random starts with a gain above 1e-3, all with a status bit", "1",
                      random.told, 1);
      }
    }
  }
}

const SceneEntry kIntoFreeRods("touching cables", "Cable that flies into free rods",
                               "energy does not increase, momentum is conserved", IntoFreeRods);

}  // namespace
}  // namespace taut::mechanics
