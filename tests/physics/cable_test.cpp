/// Force law of a cable between two points (docs/theory/cables.md): paper eq. (1), slack and stiff
/// cables.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "tests/physics/world.h"
#include "tests/scenes/hanging_mass.h"

namespace taut::test {
namespace {

double Height(const WorldBatch& world) { return world.Body(0, 0).position_m.z; }
double Rise(const WorldBatch& world) { return world.Body(0, 0).velocity_m_per_s.z; }

TEST(Cable, AnUndampedSpringFollowsTheLeapfrogsClosedFormForAHundredPeriods) {
  // x_n = A cos(n theta), v_n = -A w^2 h sin(n theta) / sin(theta), cos(theta) = 1 - (w h)^2 / 2,
  // about the sag: the amplitude is exact, the period is short by (w h)^2 / 24 of it.
  scenes::HangingMass scene;
  const double amplitude = 0.004, w = std::sqrt(scene.stiffness_n_per_m / scene.mass_kg);
  const double middle = scene.rest_length_m + scene.sag_m();
  scene.length_m = middle + amplitude;
  for (const double h : kThreeStepsS) {
    WorldBatch world = MakeBatch(scene.Def());
    const double theta = 2 * std::asin(w * h / 2);
    const int steps = StepsIn(100 * 6.2831853 / w, h);
    for (int n = 1; n <= steps; ++n) {
      world.Step(h);
      // Each step rounds lengths of 1 m, and k times that rounding is a wrong velocity change w^2 h
      // eps: as an amplitude, w h eps < eps. Errors of an oscillator add up, they do not grow.
      ASSERT_NEAR(-Height(world) - middle, amplitude * std::cos(n * theta), RoundOff(n, 1)) << h;
      ASSERT_NEAR(-Rise(world), -amplitude * w * w * h * std::sin(n * theta) / std::sin(theta),
                  RoundOff(n, w))
          << h;
      ASSERT_GT(world.Cable(0, 0).tension_n, 0);
    }
  }
}

/// The integration scheme of a mass on a damped spring: the spring at the middle of the step, the
/// damper with the mean of the rates before and after the step. In its first step the other forces
/// on the mass are unknown: the scheme assumes that they balance the tension at rest. `x`, `v`:
/// downward from the static equilibrium.
struct DampedSpring {
  double k, b, m, x, v;
  bool first = true;
  void Step(double h) {
    const double g = 9.81, middle = x + h / 2 * v;
    // Without the tension's contribution:
    const double mean = v + h / 2 * (first ? (k * middle + m * g) / m : g);
    const double tension = (k * (middle + m * g / k) + b * mean) / (1 + h * b / (2 * m));
    v += h * (g - tension / m);
    x = middle + h / 2 * v;
    first = false;
  }
};

TEST(Cable, ADampedSpringFollowsTheSchemesRecurrence) {
  scenes::HangingMass scene;
  scene.damping_n_s_per_m = 1.5;
  const double middle = scene.rest_length_m + scene.sag_m();
  scene.length_m = middle + 0.006;
  for (const double h : kThreeStepsS) {
    WorldBatch world = MakeBatch(scene.Def());
    DampedSpring spring{scene.stiffness_n_per_m, scene.damping_n_s_per_m, scene.mass_kg, 0.006, 0};
    for (int n = 1; n <= StepsIn(2, h); ++n) {
      world.Step(h);
      spring.Step(h);
      ASSERT_NEAR(-Height(world) - middle, spring.x, RoundOff(n, 1)) << h;
      ASSERT_NEAR(-Rise(world), spring.v, RoundOff(n, 30)) << h;
    }
  }
}

TEST(Cable, ADamperThatHoldsTheTensionAtZeroDoesSoWhileTheCableIsStretched) {
  // A mass moves towards the other end so fast that b dl outweighs k (l - L): it must keep its
  // speed until the cable is slack, and after that, too.
  const double speed = 0.5, stretch = 0.1;
  for (const double damping : {200.0, 2000.0, 2e5}) {  // h b / m from 0.1 to 400 at these steps
    for (const double h : kThreeStepsS) {
      scenes::HangingMass scene;
      scene.gravity_m_per_s2 = 0;
      scene.damping_n_s_per_m = damping;
      scene.length_m = scene.rest_length_m + stretch;
      ASSERT_GT(damping * speed, scene.stiffness_n_per_m * stretch);
      ModelDef def = scene.Def();
      def.bodies[0].velocity_m_per_s = {0, 0, speed};
      WorldBatch world = MakeBatch(def);
      world.Step(h);  // starts with the tension of a cable at rest
      const double coasting = Rise(world);
      for (int n = 2; n <= StepsIn(0.3, h); ++n) {
        world.Step(h);
        ASSERT_NEAR(Rise(world), coasting, RoundOff(n, 1)) << damping << ' ' << h << ' ' << n;
      }
    }
  }
}

TEST(Cable, ADampedSpringDecaysAsTheDifferentialEquationSaysToSecondOrder) {
  scenes::HangingMass scene;
  scene.damping_n_s_per_m = 1.5;
  const double a = 0.006, middle = scene.rest_length_m + scene.sag_m();
  scene.length_m = middle + a;
  const double decay = scene.damping_n_s_per_m / (2 * scene.mass_kg);
  const double w = std::sqrt(scene.stiffness_n_per_m / scene.mass_kg - decay * decay);
  std::array<double, 2> errors{};
  for (std::size_t i = 0; i < 2; ++i) {
    const double h = i == 0 ? 1e-3 : 5e-4;
    WorldBatch world = MakeBatch(scene.Def());
    for (int n = 1; n <= StepsIn(0.5, h); ++n) {
      world.Step(h);
      const double t = n * h;
      const double x = a * std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t));
      errors[i] = std::max(errors[i], std::fabs(-Height(world) - middle - x));
    }
  }
  // Second order: errors below (w h)^2 of the amplitude (w h = 0.028), over w t = 14 radians.
  EXPECT_LT(errors[0], 14 * 0.0008 * a);
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.2);
}

/// Returns two balls without shapes on the x axis with 1 m of cable between them.
ModelDef Couple(double stiffness, double damping, double distance, double closing_m_per_s) {
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  for (int i = 0; i < 2; ++i) {
    BodyDef body;
    body.name = i == 0 ? "left" : "right";
    body.mass_kg = i == 0 ? 0.2 : 0.3;
    body.com_m = {i * distance, 0, 0};
    body.velocity_m_per_s = {(i == 0 ? 1 : -1) * closing_m_per_s / 2, 0, 0};
    body.inertia_kg_m2 = scenes::SphereInertia(body.mass_kg, 0.05);
    def.bodies.push_back(body);
  }
  CableDef cable;
  cable.name = "cable";
  cable.attachments = {{0, {0, 0, 0}}, {1, {distance, 0, 0}}};
  cable.stiffness_n_per_m = stiffness;
  cable.damping_n_s_per_m = damping;
  cable.rest_length_m = 1;
  def.cables.push_back(cable);
  return def;
}

TEST(Cable, ASlackCableIsAbsentAndItsDamperToo) {
  for (const double stiffness : {1e3, 1e7}) {  // explicit force, and solved implicitly
    for (const double closing : {0.4, -0.4}) {
      const double start = closing > 0 ? 0.99 : 0.55;
      WorldBatch world = MakeBatch(Couple(stiffness, 50, start, closing));
      for (int n = 1; n <= 1000; ++n) {
        world.Step(1e-3);
        ASSERT_EQ(world.Body(0, 0).velocity_m_per_s.x, closing / 2);
        ASSERT_EQ(world.Body(0, 1).velocity_m_per_s.x, -closing / 2);
        const CableState cable = world.Cable(0, 0);
        ASSERT_EQ(cable.tension_n, 0);
        ASSERT_EQ(cable.elastic_n, 0);
        ASSERT_NEAR(cable.length_m, start - closing * n * 1e-3, RoundOff(n, 1));
        ASSERT_NEAR(cable.rate_m_per_s, -closing, RoundOff(1, 1));
      }
      EXPECT_EQ(world.Status(0).bits, kStatusOk);
    }
  }
}

TEST(Cable, ATautCableConservesMomentumAndPullsItsEndsTogether) {
  WorldBatch world = MakeBatch(Couple(1e3, 5, 0.98, -0.4));
  const Vec3 before = world.Momentum(0);
  world.Step(1e-3, 300);
  EXPECT_LT(world.Body(0, 1).velocity_m_per_s.x - world.Body(0, 0).velocity_m_per_s.x, 0);
  EXPECT_LE(Distance(world.Momentum(0), before), RoundOff(300, 0.1));
}

/// Returns the tension of a cable [N] with k = 1000 N/m and b = 50 N s/m at `stretch` (at 0.01 m
/// the spring pulls with 10 N), while its ends part at `rate`: as reported, and as computed from
/// the velocity change of one step.
std::array<double, 2> TensionAt(DampingLaw law, double stretch, double rate) {
  ModelDef def = Couple(1e3, 50, 1 + stretch, -rate);
  def.cables[0].damping_law = law;
  WorldBatch world = MakeBatch(def);
  const double reported = world.Cable(0, 0).tension_n;
  // A short step: the stretch changes by a share of 1e-7 at most.
  const double h = 1e-9;
  world.Step(h);
  return {reported, (world.Body(0, 0).velocity_m_per_s.x + rate / 2) * 0.2 / h};
}

TEST(Cable, TheTensionIsSpringPlusDamperAndNeverNegative) {
  struct Case {
    DampingLaw law;
    double stretch, rate, tension;
  };
  const std::vector<Case> cases{
      {DampingLaw::kExact, 0.01, 0.1, 15},   {DampingLaw::kExact, 0.01, 1.0, 60},
      {DampingLaw::kExact, 0.01, -0.1, 5},   {DampingLaw::kExact, 0.01, -0.5, 0},
      {DampingLaw::kExact, -0.01, 1.0, 0},   {DampingLaw::kExact, -0.01, -1.0, 0},
      {DampingLaw::kClamped, 0.01, 0.1, 15},  // |damper| = 5 < spring = 10: equal to the exact law
      {DampingLaw::kClamped, 0.01, -0.1, 5},  //
      {DampingLaw::kClamped, 0.01, 1.0, 20},  // damper 50, limited to the spring's 10
      {DampingLaw::kClamped, 0.01, -0.5, 0},  // damper -25, limited to -10
      {DampingLaw::kClamped, -0.01, 1.0, 0},
  };
  for (const Case& c : cases) {
    const auto [reported, felt] = TensionAt(c.law, c.stretch, c.rate);
    const std::string what = std::string(c.law == DampingLaw::kExact ? "exact" : "clamped") +
                             ", stretch " + std::to_string(c.stretch) + ", rate " +
                             std::to_string(c.rate);
    // The stretch is the difference of lengths of 1 m: rounded to 1e-16 m, times k.
    EXPECT_NEAR(reported, c.tension, RoundOff(1, 1e3)) << what;
    // Rounding of the velocity, divided by h / m; and the stretch changes by rate h / 2.
    EXPECT_NEAR(felt, c.tension, RoundOff(1, 1) * 0.2 / 1e-9 + 1e-6 * c.tension) << what;
  }
}

TEST(Cable, AStiffCableFollowsTheMidpointRulesClosedFormAndKeepsItsEnergy) {
  // Too stiff for explicit forces, the cable is integrated by the implicit midpoint rule: x_n is a
  // rotation by theta with tan(theta / 2) = w h / 2 in the plane of x and v / w, for any w h.
  for (const double stiffness : {1e6, 1e7, 1e9}) {
    scenes::HangingMass scene;
    scene.stiffness_n_per_m = stiffness;
    const double h = 1e-3, w = std::sqrt(stiffness / scene.mass_kg), sag = scene.sag_m();
    const double middle = scene.rest_length_m + sag, theta = 2 * std::atan(w * h / 2);
    scene.length_m = middle;
    WorldBatch world = MakeBatch(scene.Def());
    const double amplitude = 0.7 * sag;  // the cable stays taut
    world.SetBodyState(0, 0, {{0, 0, -middle - amplitude}, {}, {}, {}});
    const double x0 = -Height(world) - middle;
    for (int n = 1; n <= 2000; ++n) {
      world.Step(h);
      const double x = x0 * std::cos(n * theta);
      // A velocity error of the size of the solver's tolerance changes the oscillation by that over
      // w. The length's rounding is at most an angle of w h: a velocity of w^2 h eps, or an
      // amplitude of w h eps.
      const double allowed = SolverError(n) / w + RoundOff(n, 1 + w * h);
      ASSERT_NEAR(-Height(world) - middle, x, allowed) << stiffness << " N/m, step " << n;
    }
    EXPECT_EQ(world.Status(0).bits, kStatusOk);
  }
}

TEST(Cable, AStiffCableHoldsAWeightWithTheRightTension) {
  for (const double stiffness : {1e3, 1e5, 1e6, 1e7}) {
    for (const double h : kThreeStepsS) {
      scenes::HangingMass scene;
      scene.mass_kg = 0.1;
      scene.stiffness_n_per_m = stiffness;
      scene.damping_n_s_per_m = std::sqrt(0.1 * stiffness);  // half of the critical damping
      WorldBatch world = MakeBatch(scene.Def());
      world.Step(h, StepsIn(20, h));
      const CableState cable = world.Cable(0, 0);
      const double weight = 0.1 * 9.81;
      // Lengths of 1 m are rounded to 2e-16 m.
      EXPECT_NEAR(cable.elastic_n, weight, 1e-9 * weight + 4e-16 * stiffness)
          << stiffness << " N/m at " << h << " s";
      EXPECT_NEAR(cable.length_m - cable.rest_length_m, scene.sag_m(),
                  1e-9 * scene.sag_m() + 4e-16);
      EXPECT_EQ(world.Status(0).bits, kStatusOk);
    }
  }
}

TEST(Cable, AStiffCableThatCatchesAFallDoesNotAddEnergy) {
  for (const double stiffness : {1e5, 1e6, 1e7, 1e8}) {
    for (const double h : kThreeStepsS) {
      scenes::HangingMass scene;
      scene.mass_kg = 0.1;
      scene.stiffness_n_per_m = stiffness;
      scene.length_m = 0.9;
      if (h * h * stiffness / scene.mass_kg <= 4) continue;  // not stiff at this step
      WorldBatch world = MakeBatch(scene.Def());
      const auto energy = [&] {
        const Energy e = world.TotalEnergy(0);
        return e.kinetic_j + e.gravity_j + e.elastic_j;
      };
      const double fall = 0.1 * 9.81 * 0.1, start = energy();
      bool caught = false;
      for (int n = 0; n < StepsIn(2, h); ++n) {
        world.Step(h);
        caught = caught || world.Cable(0, 0).tension_n > 0;
        ASSERT_LE(energy() - start, 1e-6 * fall) << stiffness << " N/m at " << h << ", step " << n;
      }
      EXPECT_TRUE(caught);
    }
  }
}

}  // namespace
}  // namespace taut::test
