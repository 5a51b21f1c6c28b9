// State space of the linearized step against simulated steps and closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/vec.h"
#include "taut/analysis.h"
#include "tests/linear/linear_robots.h"

namespace taut::test {
namespace {

constexpr double kStep = 0.001;

StateSpace Find(const ExperimentSpec& experiment, const LinearOptions& options = {}) {
  Diagnostics out;
  StateSpace system = FindStateSpace(experiment, options, out);
  EXPECT_TRUE(out.ok()) << out.Format();
  return system;
}

/// Worlds at a system's equilibrium, with all of the step's memory there.
class Worlds {
 public:
  Worlds(const ExperimentSpec& e, const StateSpace& system, int count)
      : batch_(Model::Compile(e.robot.def, out_), Options(count)) {
    for (std::size_t b = 0; b < system.pose.bodies.size(); ++b) {
      batch_.SetBodyState(0, static_cast<int>(b), system.pose.bodies[b]);
    }
    for (std::size_t c = 0; c < system.pose.rest_lengths_m.size(); ++c) {
      batch_.SetRestLength(0, static_cast<int>(c), system.pose.rest_lengths_m[c]);
      batch_.SetRestLengthTarget(0, static_cast<int>(c), system.pose.rest_lengths_m[c]);
    }
    batch_.Step(kStep, 1000);
    for (int w = 1; w < count; ++w) batch_.Restore(w, batch_.Save(0));
  }
  WorldBatch& batch() { return batch_; }

 private:
  static WorldBatchOptions Options(int count) {
    WorldBatchOptions options;
    options.worlds = count;
    options.tolerance_m_per_s = 1e-12;
    return options;
  }
  Diagnostics out_;
  WorldBatch batch_;
};

/// Returns position, small rotation since `from`, velocity and angular velocity of a body, in this
/// order.
std::vector<double> MotionOf(const BodyState& s, const BodyState& from) {
  Quat turn = s.orientation * Conjugate(from.orientation);
  if (turn.w < 0) turn = {-turn.w, -turn.x, -turn.y, -turn.z};
  const Vec3 x = s.position_m - from.position_m;
  const Vec3 &v = s.velocity_m_per_s, &w = s.angular_velocity_rad_per_s;
  return {x.x, x.y, x.z, 2 * turn.x, 2 * turn.y, 2 * turn.z, v.x, v.y, v.z, w.x, w.y, w.z};
}

/// Returns the kind of a motion, by which A's entries are scaled: position, rotation, velocity,
/// angular velocity.
int KindOf(int motion) { return motion % 12 / 3; }

/// Compares the effect of steps on small changes of each body's motion, in lanes, with A^n.
/// `lift_m`: height by which bodies are lifted off their contacts (docs/theory/linear.md).
void ComparesWithSteps(const ExperimentSpec& e, int steps, double lift_m) {
  const StateSpace system = Find(e);
  ASSERT_TRUE(system.found) << system.why;
  EXPECT_EQ(system.derivatives, Derivatives::kExact);
  const int bodies = static_cast<int>(e.robot.def.bodies.size()), motions = 12 * bodies;
  Worlds worlds(e, system, 4 * motions);
  WorldBatch& batch = worlds.batch();
  std::vector<BodyState> from;
  for (int b = 0; b < bodies; ++b) from.push_back(batch.Body(0, b));
  const double small[] = {1e-8, 4e-8, 1e-5, 1e-4};
  const double sides[] = {1, -1, 0.5, -0.5};
  for (int j = 0; j < motions; ++j) {
    for (int k = 0; k < 4; ++k) {
      const int world = 4 * j + k;
      for (int b = 0; b < bodies; ++b) {
        BodyState s = from[static_cast<std::size_t>(b)];
        s.position_m.z += lift_m;
        s.velocity_m_per_s = s.angular_velocity_rad_per_s = {};
        if (b == j / 12) {
          const double by = sides[k] * small[KindOf(j)];
          const Vec3 way{j % 3 == 0 ? by : 0, j % 3 == 1 ? by : 0, j % 3 == 2 ? by : 0};
          if (KindOf(j) == 0) s.position_m = s.position_m + way;
          if (KindOf(j) == 1) {
            s.orientation = Quat{1, way.x / 2, way.y / 2, way.z / 2} * s.orientation;
          }
          if (KindOf(j) == 2) s.velocity_m_per_s = way;
          if (KindOf(j) == 3) s.angular_velocity_rad_per_s = way;
        }
        batch.SetBodyState(world, b, s);
      }
    }
  }
  batch.Step(kStep, steps);

  // Columns of A^n; a velocity set by hand is also the step's previous velocity.
  const int n = system.A.rows;
  const auto number = [&](const std::string& name) {
    const auto found = FindSignal(system.states, name);
    return found ? *found : -1;
  };
  std::vector<int> place(static_cast<std::size_t>(motions)), before(place.size(), -1);
  const char* const kinds[] = {"position_", "turn_", "velocity_", "spin_"};
  const char* const axes[] = {"x", "y", "z"};
  for (int j = 0; j < motions; ++j) {
    const std::string body =
        "body/" + e.robot.def.bodies[static_cast<std::size_t>(j / 12)].name + "/";
    place[static_cast<std::size_t>(j)] = number(body + kinds[KindOf(j)] + axes[j % 3]);
    if (KindOf(j) >= 2) {
      before[static_cast<std::size_t>(j)] =
          number(body + kinds[KindOf(j)] + "before_" + axes[j % 3]);
    }
  }
  Matrix said(motions, motions), done(motions, motions);
  for (int j = 0; j < motions; ++j) {
    std::vector<double> x(static_cast<std::size_t>(n));
    x[static_cast<std::size_t>(place[static_cast<std::size_t>(j)])] = 1;
    const int also = before[static_cast<std::size_t>(j)];
    if (also >= 0) x[static_cast<std::size_t>(also)] = 1;
    for (int step = 0; step < steps; ++step) {
      std::vector<double> next(x.size());
      for (int i = 0; i < n; ++i) {
        for (int k = 0; k < n; ++k) {
          next[static_cast<std::size_t>(i)] += system.A(i, k) * x[static_cast<std::size_t>(k)];
        }
      }
      x = next;
    }
    for (int i = 0; i < motions; ++i) {
      said(i, j) = x[static_cast<std::size_t>(place[static_cast<std::size_t>(i)])];
      const int b = i / 12;
      double at[4];
      for (int k = 0; k < 4; ++k) {
        at[k] = MotionOf(batch.Body(4 * j + k, b),
                         from[static_cast<std::size_t>(b)])[static_cast<std::size_t>(i % 12)];
      }
      const double d = small[KindOf(j)];
      done(i, j) = (4 * (at[2] - at[3]) / d - (at[0] - at[1]) / (2 * d)) / 3;
    }
  }
  double largest[4][4] = {}, worst[4][4] = {};
  for (int i = 0; i < motions; ++i) {
    for (int j = 0; j < motions; ++j) {
      double& most = largest[KindOf(i)][KindOf(j)];
      double& off = worst[KindOf(i)][KindOf(j)];
      most = std::max(most, std::fabs(done(i, j)));
      off = std::max(off, std::fabs(done(i, j) - said(i, j)));
    }
  }
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      EXPECT_GT(largest[i][j], 0);
      EXPECT_LT(worst[i][j], 2e-6 * largest[i][j]) << kinds[i] << " by " << kinds[j];
    }
  }
}

TEST(StateSpace, IsWhatStepsDoToAPrism) {
  for (const int steps : {1, 2, 20}) {
    ComparesWithSteps(ExperimentOf(Standing("prism3")), steps, 2e-8);
  }
}

TEST(StateSpace, IsWhatStepsDoToSixStruts) {
  ComparesWithSteps(ExperimentOf(Standing("six_strut")), 1, 2e-8);
}

TEST(StateSpace, IsExactUnderImpedanceControl) {
  const StateSpace system = Find(UnderImpedance(ExperimentOf(Standing("six_strut")), 100, 3));
  ASSERT_TRUE(system.found) << system.why;
  EXPECT_EQ(system.derivatives, Derivatives::kExact);
  EXPECT_LT(system.disagreement, 2e-6);
}

/// The prism's cables are stiff at its step: implicit in tension and direction (linear.md, section
/// 3).
TEST(StateSpace, OfImplicitGroupsHasDifferences) {
  const StateSpace system = Find(UnderImpedance(ExperimentOf(Standing("prism3")), 100, 3));
  ASSERT_TRUE(system.found) << system.why;
  EXPECT_EQ(system.derivatives, Derivatives::kDifferences);
}

/// Tetraspine3 after sliding to its rest state, where it sticks.
TEST(StateSpace, IsExactForASpineThatSticks) {
  ExperimentSpec e = ExperimentOf(Standing("tetraspine3"));
  const StateSpace sliding = Find(e);
  EXPECT_FALSE(sliding.found);
  EXPECT_NE(sliding.why.find("is at the limit of slipping"), std::string::npos) << sliding.why;
  Diagnostics out;
  LinearOptions options;
  options.at = FindSettledStart(e, out)->pose;
  for (CapsuleDef& capsule : e.robot.def.capsules) {
    capsule.material.static_friction = capsule.material.kinetic_friction = 1.0;
  }
  for (PlaneDef& plane : e.robot.def.planes) {
    plane.material.static_friction = plane.material.kinetic_friction = 1.0;
  }
  const StateSpace system = Find(e, options);
  ASSERT_TRUE(system.found) << system.why;
  EXPECT_EQ(system.derivatives, Derivatives::kExact);
  EXPECT_LT(system.disagreement, 2e-6);
}

TEST(StateSpace, JointsAndLimitedActuators) {
  Diagnostics out;
  const auto e = LoadExperiment(TAUT_SOURCE_DIR "/share/experiments/puppy_stand.yaml", {}, out);
  ASSERT_TRUE(e) << out.Format();
  const StateSpace system = Find(*e);
  ASSERT_TRUE(system.found) << system.why;
  EXPECT_EQ(system.derivatives, Derivatives::kExact);
  EXPECT_LT(system.disagreement, 1e-5);
}

/// Undamped and floating, the step is the leapfrog scheme: eq. I4 of docs/theory/integrator.md
/// computes its frequencies from the structure's natural frequencies, which statics computes
/// without steps.
TEST(StateSpace, FrequenciesAreThoseOfStaticsWithTheStepsDispersion) {
  Diagnostics out;
  const auto robot = LoadRobot(TAUT_SOURCE_DIR "/share/models/prism3.yaml", {}, out);
  ASSERT_TRUE(robot) << out.Format();
  ExperimentSpec e = ExperimentOf(robot->def);
  e.robot.def.gravity_m_per_s2 = {};
  for (CableDef& cable : e.robot.def.cables) cable.damping_n_s_per_m = 0;
  e.step_s = 2e-4;  // at 1 ms its cables are stiff
  const StateSpace system = Find(e);
  ASSERT_TRUE(system.found) << system.why;
  std::vector<double> swings_hz;
  for (const LinearMode& mode : ModesOf(system)) {
    if (mode.frequency_hz < 1) continue;
    swings_hz.push_back(mode.frequency_hz);
    EXPECT_LT(std::fabs(mode.damping), 1e-6);
  }
  const Modes modes = FindModes(ModelAt(e.robot.def, system.pose));
  std::vector<double> wanted_hz;
  for (const Mode& mode : modes.modes) {
    if (mode.kind != Mode::Kind::kElastic) continue;
    const double w = 2 * std::numbers::pi * mode.frequency_hz;
    wanted_hz.push_back(std::acos(1 - w * w * e.step_s * e.step_s / 2) /
                        (2 * std::numbers::pi * e.step_s));
  }
  ASSERT_EQ(swings_hz.size(), wanted_hz.size());
  std::sort(wanted_hz.begin(), wanted_hz.end());
  for (std::size_t i = 0; i < wanted_hz.size(); ++i) {
    EXPECT_NEAR(swings_hz[i], wanted_hz[i], 1e-7 * wanted_hz[i]) << i;
  }
}

/// A weight on one damped cable: its response equals a damped oscillator's, in closed form.
TEST(StateSpace, RespondsLikeAnOscillator) {
  ModelDef def;
  BodyDef body;
  body.name = "weight", body.mass_kg = 0.5, body.inertia_kg_m2 = {1e-3, 1e-3, 1e-3, 0, 0, 0};
  def.bodies.push_back(body);
  def.gravity_m_per_s2 = {0, 0, -9.81};
  CableDef cable;
  cable.name = "cable", cable.stiffness_n_per_m = 200, cable.damping_n_s_per_m = 2;
  cable.rest_length_m = 1;
  cable.attachments = {{kWorld, {0, 0, 1}}, {0, {0, 0, 0}}};
  def.cables.push_back(cable);
  NodeDef node;
  node.name = "centre", node.body = 0;
  def.nodes.push_back(node);
  const StateSpace system = Find(ExperimentOf(def));
  ASSERT_TRUE(system.found) << system.why;
  const auto input = FindSignal(system.inputs, "node/centre/force_z");
  const auto output = FindSignal(system.outputs, "node/centre/position_z");
  ASSERT_TRUE(input && output);
  const FrequencyResponse r = ResponseOf(system, *input, *output, {0, 0.5, 2, 3.18, 5, 20});
  EXPECT_NEAR(r.magnitude[0], 1 / 200.0, 1e-6 / 200);
  for (std::size_t i = 1; i < r.frequency_hz.size(); ++i) {
    const std::complex<double> s(0, 2 * std::numbers::pi * r.frequency_hz[i]);
    const std::complex<double> x =
        1.0 / (0.5 * s * s + 2.0 * s + 200.0) * std::exp(-s * (kStep / 2));
    // Zero-order hold (half a step late), and the scheme's error of second order.
    const double w_h = std::abs(s) * kStep, bound = 2 * w_h * w_h + 1e-4;
    EXPECT_NEAR(r.magnitude[i], std::abs(x), bound * std::abs(x)) << r.frequency_hz[i];
    EXPECT_NEAR(std::remainder(r.phase_rad[i] - std::arg(x), 2 * std::numbers::pi), 0, bound);
  }
}

TEST(StateSpace, RefusesWhatHasNoDerivative) {
  ExperimentSpec e = ExperimentOf(Standing("prism3"));
  e.robot.def.planes.clear();  // it falls, so there is no rest state
  LinearOptions options;
  options.most_s = 0.5;
  Diagnostics out;
  StateSpace system = FindStateSpace(e, options, out);
  EXPECT_FALSE(system.found);
  ExperimentSpec trembling = UnderImpedance(ExperimentOf(Standing("prism3")), 100, 20);
  options.most_s = 2;
  system = FindStateSpace(trembling, options, out);
  EXPECT_FALSE(system.found);
  EXPECT_NE(system.why.find("does not come to rest within 2 s: its speed is then"),
            std::string::npos)
      << system.why;
}

}  // namespace
}  // namespace taut::test
