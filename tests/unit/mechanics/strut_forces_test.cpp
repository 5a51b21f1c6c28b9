// Axial forces of rods and reactions of anchored bodies (taut/statics.h), against closed forms
// (docs/theory/loads.md)
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "math/vec.h"
#include "taut/loads.h"
#include "tests/constants.h"
#include "tests/scenes/rod.h"
#include "tests/scenes/solids.h"

namespace taut::test {
namespace {

AxialForce Only(const ModelDef& def, const std::vector<BodyForce>& forces) {
  const auto struts = StrutForces(def, forces);
  EXPECT_EQ(struts.size(), 1u);
  return struts.empty() ? AxialForce{} : struts[0].axial;
}

/// A rod of 0.4 m and 0.3 kg with balls at its ends
ModelDef Rod(const Vec3& middle_m, const Vec3& along, double start_kg, double end_kg) {
  ModelDef def;
  scenes::Parts parts;
  const Vec3 from = middle_m - 0.2 * along, to = middle_m + 0.2 * along;
  parts.AddCylinder(0.3, from, to, 0.01);
  if (start_kg > 0) parts.AddSphere(start_kg, from, 0.02);
  if (end_kg > 0) parts.AddSphere(end_kg, to, 0.015);
  def.bodies.push_back(parts.Body("rod"));
  def.capsules.push_back({"rod", 0, from, to, 0.01, {}});
  return def;
}

/// N(s) is the weight of the part below s.
TEST(StrutForces, AHangingRodBearsNothingAtItsLowerEndAndAllAtItsUpper) {
  for (const auto& [low_kg, high_kg] : {std::pair(0.0, 0.0), {0.1, 0.0}, {0.1, 0.25}}) {
    const ModelDef def = Rod({0, 0, 1}, {0, 0, 1}, low_kg, high_kg);
    const double weight = (0.3 + low_kg + high_kg) * kG;
    const AxialForce n = Only(def, {{0, {0, 0, 1.2}, {0, 0, weight}}});
    EXPECT_NEAR(n.least_n, low_kg * kG, 1e-12);
    EXPECT_NEAR(n.middle_n, (low_kg + 0.15) * kG, 1e-12);
    EXPECT_NEAR(n.greatest_n, (low_kg + 0.3) * kG, 1e-12);
  }
}

/// Held at a third of its length from above: the part below hangs, the part above stands.
TEST(StrutForces, ARodThatIsHeldBetweenItsEndsBearsBothWays) {
  const ModelDef def = Rod({0, 0, 1}, {0, 0, 1}, 0, 0);
  const AxialForce n = Only(def, {{0, {0, 0, 1.2 - 0.4 / 3}, {0, 0, 0.3 * kG}}});
  EXPECT_NEAR(n.least_n, -0.3 * kG / 3, 1e-12);
  EXPECT_NEAR(n.greatest_n, 0.3 * kG * 2 / 3, 1e-12);
}

TEST(StrutForces, ALeaningLadderIsPressedByItsFootAndItsWeight) {
  // Smooth wall at x = 0.5, rough ground: the wall's force is m g / 2 / tan(a), with a from the
  // ground.
  const double c = 0.5, s = std::sqrt(0.75), m = 2;
  ModelDef def;
  scenes::AddRod(def, "ladder", m, 0.01, {0, 0, 0}, {c, 0, s}, {});
  const double wall = m * kG / 2 * c / s;
  const AxialForce n =
      Only(def, {{0, {0, 0, 0}, {wall, 0, m * kG}}, {0, {c, 0, s}, {-wall, 0, 0}}});
  EXPECT_NEAR(n.least_n, -(wall * c + m * kG * s), 1e-12);  // at its foot
  EXPECT_NEAR(n.greatest_n, -wall * c, 1e-12);              // at its top
  EXPECT_NEAR(n.middle_n, -(wall * c + m * kG * s / 2), 1e-12);
}

/// m w^2 / 2 l (l^2 / 4 - x^2), largest in its middle, where no force acts
TEST(StrutForces, ASpinningRodIsPulledMostInItsMiddle) {
  ModelDef def = Rod({}, {1, 0, 0}, 0, 0);
  def.gravity_m_per_s2 = {};
  def.bodies[0].angular_velocity_rad_per_s = {3, 0, 7};
  const AxialForce n = Only(def, {});
  EXPECT_NEAR(n.greatest_n, 0.3 * 49 * 0.4 / 8, 1e-12);
  EXPECT_NEAR(n.middle_n, n.greatest_n, 1e-12);
  EXPECT_NEAR(n.least_n, 0, 1e-12);
}

/// Swung about its end by a pin: m w^2 l / 2 at the pin, zero at the other end
TEST(StrutForces, ASlungRodIsPulledMostAtItsPin) {
  ModelDef def = Rod({0.2, 0, 0}, {1, 0, 0}, 0, 0);
  def.gravity_m_per_s2 = {};
  def.bodies[0].angular_velocity_rad_per_s = {0, 0, 5};
  const AxialForce n = Only(def, {{0, {0, 0, 0}, {-0.3 * 25 * 0.2, 0, 0}}});
  EXPECT_NEAR(n.greatest_n, 0.3 * 25 * 0.2, 1e-12);
  EXPECT_NEAR(n.middle_n, 0.3 * 25 * 0.2 * 0.75, 1e-12);
  EXPECT_NEAR(n.least_n, 0, 1e-12);
}

/// Between two forces the maximum of m w^2 / 2 l (l^2 / 4 - x^2) + a x / l is at x = a / m w^2.
TEST(StrutForces, TheGreatestForceMayBeBetweenForces) {
  ModelDef def = Rod({}, {1, 0, 0}, 0, 0);
  def.gravity_m_per_s2 = {};
  def.bodies[0].angular_velocity_rad_per_s = {0, 0, 10};
  const double spin = 0.3 * 100, pull = 0.1 * spin;  // maximum 0.1 m from the middle
  const AxialForce n = Only(def, {{0, {0.2, 0, 0}, {pull, 0, 0}}});
  const auto closed = [&](double x) {
    return pull * (0.5 + x / 0.4) + spin / 0.8 * (0.04 - x * x);
  };
  EXPECT_NEAR(n.greatest_n, closed(0.1), 1e-12);
  EXPECT_NEAR(n.middle_n, closed(0), 1e-12);
  EXPECT_NEAR(n.least_n, 0, 1e-12);
}

/// Three struts and nine cables without weight: at each end the three cables balance the strut.
TEST(StrutForces, APrismsStrutIsPressedByTheCablesAtItsEnd) {
  ModelDef def;
  def.gravity_m_per_s2 = {};
  constexpr double kTurn = 2 * 3.14159265358979323846 / 3;
  const auto low = [](int i) {
    return Vec3{0.1 * std::cos(i * kTurn), 0.1 * std::sin(i * kTurn), 0};
  };
  const auto high = [&](int i) {
    const double a = i * kTurn + 1.25 * kTurn;  // 150 degrees
    return Vec3{0.1 * std::cos(a), 0.1 * std::sin(a), 0.2};
  };
  for (int i = 0; i < 3; ++i) scenes::AddRod(def, "strut", 0.03, 0.005, low(i), high(i), {});
  // Force per length: equal in side cables and struts, smaller by sqrt(3) in the triangles
  // (Connelly and Terrell).
  const double per_length = 100;
  const auto cable = [&](int a, const Vec3& from, int b, const Vec3& to, double n_per_m) {
    const Vec3 d = to - from;
    const double length = std::sqrt(Dot(d, d)), tension = n_per_m * length;
    def.cables.push_back(
        {"cable", {{a, from}, {b, to}}, 1000, 0.0, length - tension / 1000, {}, {}});
  };
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    cable(i, low(i), next, low(next), per_length / std::sqrt(3.0));
    cable(i, high(i), next, high(next), per_length / std::sqrt(3.0));
    cable(i, high(i), next, low(next), per_length);
  }
  const auto struts = StrutForces(def, StartForces(def, {}));
  ASSERT_EQ(struts.size(), 3u);
  const Vec3 d = high(0) - low(0);
  for (const StrutForce& strut : struts) {
    EXPECT_NEAR(strut.axial.least_n, -per_length * std::sqrt(Dot(d, d)), 1e-9);
    EXPECT_NEAR(strut.axial.greatest_n, strut.axial.least_n, 1e-9);
  }
}

/// A ball joint in the world holds a mast's lower end, two cables hold its upper end.
TEST(StrutForces, JointsActOnRods) {
  ModelDef def;
  def.gravity_m_per_s2 = {};
  scenes::AddRod(def, "mast", 2, 0.01, {0, 0, 0}, {0, 0, 1}, {});
  JointDef foot;
  foot.name = "foot", foot.kind = JointKind::kBall, foot.body_b = 0;
  def.joints.push_back(foot);
  for (const double side : {-1.0, 1.0}) {
    def.cables.push_back(
        {"stay", {{0, {0, 0, 1}}, {kWorld, {0.75 * side, 0, 0}}}, 100, 0.0, 1.15, {}, {}});
  }
  const auto loads = StartJointLoads(def);
  const AxialForce n = Only(def, StartForces(def, loads));
  EXPECT_NEAR(n.least_n, -2 * 10 * 0.8, 1e-9);  // 10 N each, with a vertical share of 4/5
  EXPECT_NEAR(n.greatest_n, n.least_n, 1e-9);
}

TEST(AnchorReactions, AnAnchorHoldsWeightsCablesAndJoints) {
  ModelDef def;
  BodyDef beam;
  beam.name = "beam", beam.mass_kg = 2, beam.com_m = {0, 0, 2}, beam.fixed = true;
  def.bodies.push_back(beam);
  scenes::AddRod(def, "rod", 3, 0.01, {0.5, 0, 2}, {0.5, 0, 1}, {});
  JointDef pin;
  pin.name = "pin", pin.kind = JointKind::kBall, pin.body_a = 0, pin.body_b = 1;
  pin.from_m = pin.to_m = {0.5, 0, 2};
  def.joints.push_back(pin);
  def.cables.push_back({"side", {{0, {0, 0.1, 2}}, {kWorld, {0, 1.1, 2}}}, 100, 0.0, 0.9, {}, {}});
  const auto held = AnchorReactions(def, StartForces(def, StartJointLoads(def)));
  ASSERT_EQ(held.size(), 1u);
  EXPECT_EQ(held[0].body, 0);
  const Vec3 force = held[0].force_n, torque = held[0].torque_n_m;
  EXPECT_NEAR(force.x, 0, 1e-9);
  EXPECT_NEAR(force.y, -10, 1e-9);
  EXPECT_NEAR(force.z, 5 * kG, 1e-9);
  // The rod hangs 0.5 m ahead in +x: its weight exerts a torque about +y, which the reaction
  // balances.
  EXPECT_NEAR(torque.x, 0, 1e-9);
  EXPECT_NEAR(torque.y, -0.5 * 3 * kG, 1e-9);
  EXPECT_NEAR(torque.z, 0, 1e-9);
}

TEST(StartForces, AreWhatStartLoadsAddUp) {
  ModelDef def;
  scenes::AddRod(def, "a", 1, 0.01, {0, 0, 0}, {1, 0, 0}, {});
  scenes::AddRod(def, "b", 1, 0.01, {0, 1, 0}, {1, 1, 0.3}, {});
  def.cables.push_back({"routed",
                        {{0, {0, 0, 0}}, {1, {0.5, 1, 0.15}}, {0, {1, 0, 0}}, {kWorld, {2, 1, 1}}},
                        50,
                        0.0,
                        1.0,
                        {},
                        {}});
  std::vector<Vec3> force(2), torque(2);
  for (const BodyForce& f : StartForces(def, {})) {
    if (f.body == kWorld) continue;
    const auto b = static_cast<std::size_t>(f.body);
    force[b] = force[b] + f.force_n;
    torque[b] = torque[b] + Cross(f.point_m - def.bodies[b].com_m, f.force_n);
  }
  const auto loads = StartLoads(def);
  for (std::size_t b = 0; b < 2; ++b) {
    const Vec3 df = force[b] - loads[b].cable_force_n, dt = torque[b] - loads[b].cable_torque_n_m;
    EXPECT_LT(Dot(df, df) + Dot(dt, dt), 1e-20);
    EXPECT_GT(Dot(force[b], force[b]), 1);
  }
}

}  // namespace
}  // namespace taut::test
