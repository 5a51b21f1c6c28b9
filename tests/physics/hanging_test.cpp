/// Hanging cables, and stiff cables between light bodies: tensions and positions against closed
/// forms.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/constants.h"
#include "tests/physics/world.h"
#include "tests/scenes/solids.h"

namespace taut::test {
namespace {

int AddPointMass(ModelDef& def, const std::string& name, double mass_kg, const Vec3& p) {
  BodyDef body;
  body.name = name;
  body.mass_kg = mass_kg;
  body.com_m = p;
  body.inertia_kg_m2 = scenes::SphereInertia(mass_kg, 0.05);
  def.bodies.push_back(body);
  return static_cast<int>(def.bodies.size()) - 1;
}

void AddHangingCable(ModelDef& def, const AttachmentDef& from, const AttachmentDef& to,
                     double stiffness, double damping, double rest_length) {
  CableDef cable;
  cable.name = "cable_" + std::to_string(def.cables.size());
  cable.attachments = {from, to};
  cable.stiffness_n_per_m = stiffness;
  cable.damping_n_s_per_m = damping;
  cable.rest_length_m = rest_length;
  def.cables.push_back(cable);
}

/// Equal masses on a line of equal elastic cables between two points of the same height. With the
/// horizontal force H everywhere, cable i has the vertical force V_i = m g ((n - 1) / 2 - i), the
/// tension sqrt(H^2 + V_i^2) and the length L + T_i / k, from which all positions follow.
struct HangingChain {
  int cables = 20;
  double mass_kg = 0.05, rest_length_m = 0.1, stiffness_n_per_m = 500, horizontal_n = 3;
  std::vector<double> tension_n;  ///< Tension of each cable.
  std::vector<Vec3> places_m;     ///< Positions of the ends and the masses.

  ModelDef Solve() {
    Vec3 p;
    places_m = {p};
    for (int i = 0; i < cables; ++i) {
      const double vertical = mass_kg * kG * ((cables - 1) / 2.0 - i);
      const double tension = std::hypot(horizontal_n, vertical);
      const double length = rest_length_m + tension / stiffness_n_per_m;
      p = p + (length / tension) * Vec3{horizontal_n, 0, -vertical};
      tension_n.push_back(tension);
      places_m.push_back(p);
    }
    ModelDef def;
    for (std::size_t i = 0; i + 1 < places_m.size(); ++i) {
      AttachmentDef from{static_cast<int>(i) - 1, places_m[i]};
      AttachmentDef to{static_cast<int>(i), places_m[i + 1]};
      if (i + 2 < places_m.size()) {
        AddPointMass(def, "mass_" + std::to_string(i), mass_kg, to.position_m);
      } else {
        to.body = kWorld;
      }
      AddHangingCable(def, from, to, stiffness_n_per_m, 0, rest_length_m);
    }
    return def;
  }
};

TEST(Hanging, AChainOfMassesStaysInItsClosedForm) {
  // The chain starts in the closed form, undamped: if the simulation's equilibrium differed, the
  // chain would swing about it, with twice the difference.
  for (const double stiffness : {500.0, 1e5, 1e6}) {
    for (const double h : kThreeStepsS) {
      HangingChain chain;
      chain.stiffness_n_per_m = stiffness;
      const ModelDef def = chain.Solve();
      WorldBatch world = MakeBatch(def);
      double away = 0, wrong = 0;
      for (int n = 0; n < StepsIn(5, h); ++n) {
        world.Step(h);
        if (n % 10 != 0) continue;
        for (int i = 0; i < chain.cables - 1; ++i) {
          const Vec3 place = chain.places_m[static_cast<std::size_t>(i) + 1];
          away = std::max(away, Distance(world.Body(0, i).position_m, place));
        }
        for (int i = 0; i < chain.cables; ++i) {
          const double tension = chain.tension_n[static_cast<std::size_t>(i)];
          wrong = std::max(wrong, std::fabs(world.Cable(0, i).elastic_n / tension - 1));
        }
      }
      EXPECT_LT(away, 1e-9) << stiffness << ' ' << h;
      EXPECT_LT(wrong, 1e-5) << stiffness << ' ' << h;
      EXPECT_EQ(world.Status(0).bits, kStatusOk) << stiffness << ' ' << h;
    }
  }
}

TEST(Hanging, AChainOfManyMassesHangsAsDeepAsTheCatenary) {
  // y = a (cosh(x / a) - 1), a = H / (weight per length), between ends that are half a mass's share
  // further out. A polygon of n chords differs from it by a share of 1 / n^2.
  HangingChain chain;
  chain.cables = 64;
  chain.rest_length_m = 1.0 / 32;
  chain.mass_kg = 0.01;
  chain.stiffness_n_per_m = 1e6;
  chain.horizontal_n = 1.5;
  const ModelDef def = chain.Solve();
  WorldBatch world = MakeBatch(def);
  world.Step(1e-3, 1000);
  const double span = chain.places_m.back().x, depth = -world.Body(0, 31).position_m.z;
  const double a = chain.horizontal_n / (chain.mass_kg * kG / chain.rest_length_m);
  EXPECT_NEAR(depth, a * (std::cosh(span / (2 * a)) - 1), depth / (64 * 64 / 4));
}

TEST(Hanging, StiffCablesBetweenLightBodiesCarryTheirWeightsAfterAFall) {
  // Three bodies of 0.1 kg one below the other, on cables of 1e6 N/m that are slack by 1 mm at the
  // start: they fall, are caught, and settle with the cables' damping (a tenth of critical).
  for (const double stiffness : {1e6, 1e7}) {
    for (const double h : kThreeStepsS) {
      ModelDef def;
      const double damping = 0.2 * std::sqrt(0.1 * stiffness);
      AttachmentDef above{kWorld, {0, 0, 0}};
      for (int i = 0; i < 3; ++i) {
        const Vec3 p{0, 0, -0.299 * (i + 1)};
        const AttachmentDef below{AddPointMass(def, "body_" + std::to_string(i), 0.1, p), p};
        AddHangingCable(def, above, below, stiffness, damping, 0.3);
        above = below;
      }
      WorldBatch world = MakeBatch(def);
      double largest = 0;
      for (int n = 0; n < StepsIn(10, h); ++n) {
        world.Step(h);
        for (int i = 0; i < 3; ++i) {
          largest = std::max(largest, Norm(world.Body(0, i).velocity_m_per_s));
        }
      }
      EXPECT_LT(largest, 1) << "falls of some millimetres: sqrt(2 g 3 mm) = 0.24 m/s";
      for (int i = 0; i < 3; ++i) {
        const double weight = (3 - i) * 0.1 * kG;
        EXPECT_NEAR(world.Cable(0, i).tension_n, weight, 1e-3 * weight) << stiffness << ' ' << h;
      }
      EXPECT_EQ(world.Status(0).bits, kStatusOk) << stiffness << ' ' << h;
    }
  }
}

TEST(Hanging, AnUndampedCableAtOmegaH006KeepsPeriodAndAmplitudeForAHundredPeriods) {
  // A common benchmark of integrators: period within 0.1 %, amplitude within 1 %. Measured from the
  // motion, not from the scheme's formula: upward crossings and highest points, by a parabola
  // through three samples (accurate to (w h)^4).
  const double h = 1e-3, w = 0.06 / h, mass = 0.1, stiffness = mass * w * w;
  const double sag = mass * kG / stiffness, amplitude = 0.5 * sag;
  ModelDef def;
  const Vec3 start{0, 0, -(1 + sag + amplitude)};
  AddPointMass(def, "mass", mass, start);
  AddHangingCable(def, {kWorld, {}}, {0, start}, stiffness, 0, 1);
  WorldBatch world = MakeBatch(def);
  const auto place = [&] { return world.Body(0, 0).position_m.z + 1 + sag; };
  double before = place(), here = before, crossing = -1, last_crossing = -1, first_top = 0, top = 0;
  int periods = -1;
  for (int n = 1; periods < 100; ++n) {
    ASSERT_LT(n, 12000);
    world.Step(h);
    const double after = place();
    if (n > 1 && here > 0 && here > before && here >= after) {
      const double bend = before - 2 * here + after, slope = (after - before) / 2;
      top = here - slope * slope / (2 * bend);
      if (!(first_top > 0)) first_top = top;
    }
    if (here < 0 && after >= 0) {
      last_crossing = (n - 1 + here / (here - after)) * h;
      if (crossing < 0) crossing = last_crossing;
      ++periods;
    }
    before = here;
    here = after;
  }
  const double period = (last_crossing - crossing) / 100, exact = 2 * 3.14159265358979 / w;
  EXPECT_NEAR(period, exact, 1e-3 * exact);
  EXPECT_NEAR(period / exact - 1, -0.06 * 0.06 / 24, 1e-6) << "and by as much as (I4) says";
  EXPECT_NEAR(first_top, amplitude, 1e-3 * amplitude);
  EXPECT_NEAR(top, first_top, 0.01 * first_top);
}

TEST(Hanging, AMassThatACableCatchesAgainAndAgainKeepsTheEnergyOfItsFall) {
  // The force has a kink where the cable goes slack, and its effect depends on its place within the
  // step. Without damping, for a minute, some hundred catches.
  const double h = 1e-3;
  // From w h = 0.3 the implicit midpoint rule applies: it may lose energy in a catch, but not add
  // any.
  for (const double angle : {0.03, 0.06, 0.1, 0.5, 0.7, 0.9}) {  // w h
    for (int i = 0; i < 5; ++i) {
      const double mass = 0.5, stiffness = mass * angle * angle / (h * h), fall = 0.05 + 0.002 * i;
      ModelDef def;
      const Vec3 start{0, 0, -(1 - fall)};
      AddPointMass(def, "mass", mass, start);
      AddHangingCable(def, {kWorld, {}}, {0, start}, stiffness, 0, 1);
      WorldBatch world = MakeBatch(def);
      const auto energy = [&] {
        const Energy e = world.TotalEnergy(0);
        return e.kinetic_j + e.gravity_j + e.elastic_j;
      };
      const double before = energy();
      double worst = 0;
      int catches = 0;
      bool slack = true;
      for (int n = 0; n < StepsIn(60, h); ++n) {
        world.Step(h);
        const bool now_slack = !(world.Cable(0, 0).tension_n > 0);
        if (slack && !now_slack) ++catches;
        slack = now_slack;
        const double change = energy() - before;
        if (slack) worst = std::max(worst, angle < 0.3 ? std::fabs(change) : change);
      }
      EXPECT_LT(worst, 0.01 * mass * kG * fall) << angle << ", fall " << fall;
      EXPECT_GT(catches, angle < 0.3 ? 100 : 2);
    }
  }
}

TEST(Hanging, AStiffCableThatIsTautAtTheStartKeepsItsEnergyFromTheFirstStepOn) {
  for (const double stiffness : {1e6, 1e7}) {
    const double mass = 0.1, sag = mass * kG / stiffness;
    ModelDef def;
    const Vec3 start{0, 0, -(1 + 1.5 * sag)};
    AddPointMass(def, "mass", mass, start);
    AddHangingCable(def, {kWorld, {}}, {0, start}, stiffness, 0, 1);
    WorldBatch world = MakeBatch(def);
    const auto energy = [&] {
      const Energy e = world.TotalEnergy(0);
      return e.kinetic_j + e.gravity_j + e.elastic_j;
    };
    const double before = energy(), swing = stiffness * sag * sag / 8;
    world.Step(1e-3, 1000);
    EXPECT_NEAR(energy(), before, 0.01 * swing) << stiffness;
  }
}

}  // namespace
}  // namespace taut::test
