/// Free rotation of a body with three different moments of inertia.

#include "tests/mechanics/known_scene.h"
#include "tests/mechanics/runge_kutta.h"
#include "tests/physics/world.h"

namespace taut::mechanics {
namespace {

constexpr Vec3 kMoments{0.01, 0.02, 0.028}, kSpin{0.5, 6, 0.5};

/// Returns the orientation after `time_s` from Euler's equations: quaternion w, x, y, z and body
/// rates.
Quat ReferenceOrientation(double time_s) {
  const auto rates = [](double, const std::array<double, 7>& y) {
    const double w = y[0], x = y[1], v = y[2], z = y[3], p = y[4], q = y[5], r = y[6];
    return std::array<double, 7>{0.5 * (-x * p - v * q - z * r),
                                 0.5 * (w * p + v * r - z * q),
                                 0.5 * (w * q + z * p - x * r),
                                 0.5 * (w * r + x * q - v * p),
                                 (kMoments.y - kMoments.z) / kMoments.x * q * r,
                                 (kMoments.z - kMoments.x) / kMoments.y * r * p,
                                 (kMoments.x - kMoments.y) / kMoments.z * p * q};
  };
  const auto y = Integrate<7>(rates, 0, {1, 0, 0, 0, kSpin.x, kSpin.y, kSpin.z}, time_s);
  return {y[0], y[1], y[2], y[3]};
}

double AngleBetween(const Quat& a, const Quat& b) {
  // From the vector part of a^-1 b, which is exact for small angles.
  const double x = a.w * b.x - b.w * a.x - (a.y * b.z - a.z * b.y);
  const double y = a.w * b.y - b.w * a.y - (a.z * b.x - a.x * b.z);
  const double z = a.w * b.z - b.w * a.z - (a.x * b.y - a.y * b.x);
  return 2 * std::asin(std::min(1.0, std::sqrt(x * x + y * y + z * z)));
}

double Error(double step_s, double time_s) {
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  BodyDef body;
  body.mass_kg = 1;
  body.inertia_kg_m2.xx = kMoments.x;
  body.inertia_kg_m2.yy = kMoments.y;
  body.inertia_kg_m2.zz = kMoments.z;
  body.angular_velocity_rad_per_s = kSpin;
  def.bodies.push_back(body);
  WorldBatch world = test::MakeBatch(def);
  world.Step(step_s, test::StepsIn(time_s, step_s));
  return AngleBetween(world.Body(0, 0).orientation, ReferenceOrientation(time_s));
}

void TumblingBody(Report& report) {
  const double time_s = 5, at_2ms = Error(2e-3, time_s), at_1ms = Error(1e-3, time_s);
  report.AtMost("orientation error after 5 s, 1 ms", "rad", at_1ms, 3e-4);
  report.Order("orientation, 2 and 1 ms", at_2ms, at_1ms, 2, 1.9);
}

const SceneEntry kTumblingBody("rotation", "Body that tumbles about its middle axis",
                               "Euler's equations by Runge-Kutta, tolerance 1e-12", TumblingBody);

}  // namespace
}  // namespace taut::mechanics
