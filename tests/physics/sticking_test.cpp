/// Second-order accuracy of sticking contacts (docs/theory/contact.md, eq. 12a) against closed
/// forms.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/constants.h"
#include "tests/physics/world.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/rod.h"

namespace taut::test {
namespace {

constexpr double kRadian = 57.29577951308232;
const Material kRough{100, 100, 0};

/// Returns the angular speed at 45 degrees of a thin rod that falls over about its lower end from 5
/// degrees, relative to w^2 = 3 g / L (cos 5 - cos 45).
double SpeedAt45(double h) {
  const double length = 1, r = 1e-4, start = 5 / kRadian, end = 45 / kRadian;
  ModelDef def;
  scenes::AddGround(def, kRough);
  scenes::AddRod(def, "rod", 1, r, {0, 0, r},
                 {length * std::sin(start), 0, r + length * std::cos(start)}, kRough);
  WorldBatch world = MakeBatch(def);
  double angle_before = start, w_before = 0;
  for (int n = 0; n < StepsIn(3, h); ++n) {
    world.Step(h);
    const Vec3 along = world.NodePosition(0, 1) - world.NodePosition(0, 0);
    const double angle = std::acos(along.z / Norm(along));
    const double w = Norm(world.Body(0, 0).angular_velocity_rad_per_s);
    if (angle > end) {
      const double at45 = w_before + (end - angle_before) / (angle - angle_before) * (w - w_before);
      return at45 / std::sqrt(3 * kG / length * (std::cos(start) - std::cos(end)));
    }
    angle_before = angle;
    w_before = w;
  }
  return NAN;
}

TEST(Sticking, ARodFallsOverAboutItsEndToSecondOrder) {
  // The rod rolls on a tip of 0.1 mm, which alone slows it by a share of 1.06e-4.
  for (const double h : {2e-3, 1e-3, 5e-4, 2.5e-4}) {
    EXPECT_NEAR(SpeedAt45(h) - 1, -1.06e-4, 5e-6 * (h / 2e-3) * (h / 2e-3) + 1e-6) << h;
  }
}

struct TopMotion {
  double precession_rad_per_s = 0, least_deg = 90, largest_deg = 0;
};

/// A disc on a stem of 50 mm that spins on its tip with 400 rad/s, inclined by 20 degrees, in the
/// steady precession of the closed form.
constexpr double kStem = 0.05, kDisc = 0.03, kTopMass = 0.2, kSpin = 400, kTilt = 20 / kRadian;
double SteadyPrecession() {
  // I1 W^2 cos a - I3 s W + m g l = 0, I1 about the tip, s the total spin about the axis
  const double i3 = kTopMass * kDisc * kDisc / 2, i1 = i3 / 2 + kTopMass * kStem * kStem;
  const double a = i1 * std::cos(kTilt), b = -i3 * kSpin, c = kTopMass * kG * kStem;
  return (-b - std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

TopMotion Spin(double h) {
  const Vec3 axis{std::sin(kTilt), 0, std::cos(kTilt)};
  const double r = 1e-6, i3 = kTopMass * kDisc * kDisc / 2, i1 = i3 / 2;
  ModelDef def;
  scenes::AddGround(def, kRough);
  BodyDef body;
  body.name = "top";
  body.mass_kg = kTopMass;
  body.com_m = Vec3{0, 0, r} + kStem * axis;
  const auto extra = [&](double p, double q) { return (i3 - i1) * p * q; };
  body.inertia_kg_m2 = {i1 + extra(axis.x, axis.x), i1 + extra(axis.y, axis.y),
                        i1 + extra(axis.z, axis.z), extra(axis.x, axis.y),
                        extra(axis.x, axis.z),      extra(axis.y, axis.z)};
  const double w = SteadyPrecession();
  body.angular_velocity_rad_per_s = Vec3{0, 0, w} + (kSpin - w * std::cos(kTilt)) * axis;
  body.velocity_m_per_s = Cross(body.angular_velocity_rad_per_s, kStem * axis);
  def.bodies.push_back(body);
  def.spheres.push_back({"tip", 0, {0, 0, r}, r, kRough, true});
  WorldBatch world = MakeBatch(def);
  TopMotion motion;
  double turned = 0;
  Vec3 before = axis;
  const double time_s = 2;
  for (int n = 0; n < StepsIn(time_s, h); ++n) {
    world.Step(h);
    const BodyState top = world.Body(0, 0);
    const Vec3 now = Rotate(top.orientation, axis);
    turned += std::atan2(before.x * now.y - before.y * now.x, before.x * now.x + before.y * now.y);
    const double tilt_deg = kRadian * std::acos(now.z / Norm(now));
    motion.least_deg = std::min(motion.least_deg, tilt_deg);
    motion.largest_deg = std::max(motion.largest_deg, tilt_deg);
    before = now;
  }
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
  motion.precession_rad_per_s = turned / time_s;
  return motion;
}

TEST(Sticking, ATopPrecessesAsSteadilyAsTheClosedFormSays) {
  for (const double h : {1e-3, 5e-4, 2.5e-4}) {
    const TopMotion motion = Spin(h);
    EXPECT_NEAR(motion.precession_rad_per_s / SteadyPrecession(), 1, 5e-4) << h;
    EXPECT_GT(motion.least_deg, 20 - 0.15) << h;
    EXPECT_LT(motion.largest_deg, 20 + 0.15) << h;
  }
}

}  // namespace
}  // namespace taut::test
