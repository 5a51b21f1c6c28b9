/// Rigid body on a ball joint: spinning top and spherical pendulum.

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/constants.h"
#include "tests/mechanics/energy_range.h"
#include "tests/mechanics/known_scene.h"
#include "tests/mechanics/runge_kutta.h"
#include "tests/physics/world.h"

namespace taut::mechanics {
namespace {

using test::Distance;
using test::MakeBatch;
using test::StepsIn;

/// A body of 1 kg on a ball joint at the origin. The moments are about the center of mass along the
/// body's axes, whose z axis passes through the joint; the body starts rotated by `tilt_rad` about
/// the y axis of W.
struct BodyOnBall {
  Vec3 moments_kg_m2;
  double arm_m;  ///< Position of the center of mass along the body's z axis.
  double tilt_rad;
  Vec3 spin_rad_per_s;  ///< Components along the body's axes.
};

Quat Tilt(double angle_rad) { return {std::cos(angle_rad / 2), 0, std::sin(angle_rad / 2), 0}; }

ModelDef ModelOf(const BodyOnBall& top) {
  ModelDef def;
  const Quat q = Tilt(top.tilt_rad);
  const Vec3 x = Rotate(q, {1, 0, 0}), y = Rotate(q, {0, 1, 0}), z = Rotate(q, {0, 0, 1});
  const Vec3& m = top.moments_kg_m2;
  BodyDef body;
  body.name = "top", body.mass_kg = 1, body.com_m = top.arm_m * z;
  body.inertia_kg_m2 = {m.x * x.x * x.x + m.y * y.x * y.x + m.z * z.x * z.x,
                        m.x * x.y * x.y + m.y * y.y * y.y + m.z * z.y * z.y,
                        m.x * x.z * x.z + m.y * y.z * y.z + m.z * z.z * z.z,
                        m.x * x.x * x.y + m.y * y.x * y.y + m.z * z.x * z.y,
                        m.x * x.x * x.z + m.y * y.x * y.z + m.z * z.x * z.z,
                        m.x * x.y * x.z + m.y * y.y * y.z + m.z * z.y * z.z};
  body.angular_velocity_rad_per_s = Rotate(q, top.spin_rad_per_s);
  body.velocity_m_per_s = Cross(body.angular_velocity_rad_per_s, body.com_m);
  def.bodies.push_back(body);
  JointDef pin;
  pin.name = "pin", pin.body_b = 0;
  def.joints.push_back(pin);
  return def;
}

/// Returns the center of mass after `time_s` by Euler's equations about the joint.
Vec3 ReferencePlace(const BodyOnBall& top, double time_s) {
  const double extra = top.arm_m * top.arm_m;
  const double a = top.moments_kg_m2.x + extra, b = top.moments_kg_m2.y + extra,
               c = top.moments_kg_m2.z;
  const auto rates = [&](double, const std::array<double, 7>& s) {
    const Quat q{s[0], s[1], s[2], s[3]};
    const double p = s[4], u = s[5], r = s[6];
    const Vec3 down = Rotate(Conjugate(q), {0, 0, -kG});
    return std::array<double, 7>{0.5 * (-q.x * p - q.y * u - q.z * r),
                                 0.5 * (q.w * p + q.y * r - q.z * u),
                                 0.5 * (q.w * u + q.z * p - q.x * r),
                                 0.5 * (q.w * r + q.x * u - q.y * p),
                                 ((b - c) * u * r - top.arm_m * down.y) / a,
                                 ((c - a) * r * p + top.arm_m * down.x) / b,
                                 (a - b) * p * u / c};
  };
  const Quat q = Tilt(top.tilt_rad);
  const Vec3& w = top.spin_rad_per_s;
  const auto end = Integrate<7>(rates, 0, {q.w, q.x, q.y, q.z, w.x, w.y, w.z}, time_s, 1e-11);
  const double square = end[0] * end[0] + end[1] * end[1] + end[2] * end[2] + end[3] * end[3];
  return (top.arm_m / square) * Rotate({end[0], end[1], end[2], end[3]}, {0, 0, 1});
}

double PlaceError(const BodyOnBall& top, double step_s, double time_s) {
  WorldBatch world = MakeBatch(ModelOf(top));
  world.Step(step_s, StepsIn(time_s, step_s));
  return Distance(world.Body(0, 0).position_m, ReferencePlace(top, time_s));
}

BodyOnBall Top(double spin_rad_per_s) {
  return {{0.01, 0.01, 0.002}, 0.1, 0.5, {0, 0, spin_rad_per_s}};
}

void SpinningTop(Report& report) {
  const double time_s = report.IsFull() ? 20 : 4;
  for (const double spin : {50.0, 200.0, 1000.0}) {
    const std::string name = std::to_string(static_cast<int>(spin)) + " rad/s, 1 ms";
    WorldBatch world = MakeBatch(ModelOf(Top(spin)));
    const EnergyRange seen = Run(world, 1e-3, time_s);
    report.AtMost("error of the energy, " + name, "J", seen.Off(), 4e-3);
    report.AtMost("steps with a warning (status bit), " + name, "1", seen.flagged, 0);
  }
  const BodyOnBall top = Top(200);
  const double at_1ms = PlaceError(top, 1e-3, 1), at_half = PlaceError(top, 5e-4, 1);
  report.AtMost("position error after 1 s, 200 rad/s, 1 ms", "m", at_1ms, 1e-4);
  report.Order("position error, 200 rad/s, 1 and 0.5 ms", at_1ms, at_half, 2, 1.9);
}

void SphericalPendulum(Report& report) {
  const BodyOnBall pendulum{{0.02, 0.02, 0.001}, -0.5, 0, {3, 1, 5}};
  WorldBatch world = MakeBatch(ModelOf(pendulum));
  const EnergyRange seen = Run(world, 1e-3, report.IsFull() ? 600 : 120);
  report.AtMost("error of the energy, 1 ms", "J", seen.Off(), 3e-5);
  report.AtMost("gap of the joint", "m", seen.gap_m, 1e-11);
  // Three different moments, and an angular velocity along no axis of symmetry.
  const BodyOnBall uneven{{0.02, 0.05, 0.03}, -0.5, 0.3, {3, 1, 5}};
  const double at_1ms = PlaceError(uneven, 1e-3, 2), at_half = PlaceError(uneven, 5e-4, 2);
  report.AtMost("position error after 2 s, three different moments of inertia, 1 ms", "m", at_1ms,
                1e-4);
  report.Order("position error, 1 and 0.5 ms", at_1ms, at_half, 2, 1.9);
}

const SceneEntry kSpinningTop("joints", "Spinning top on a ball joint",
                              "energy; Euler's equations by Runge-Kutta", SpinningTop);
const SceneEntry kSphericalPendulum("joints", "Spherical pendulum with spin",
                                    "energy; Euler's equations by Runge-Kutta", SphericalPendulum);

}  // namespace
}  // namespace taut::mechanics
