/// Bodies that roll on moving ground.

#include <string>

#include "tests/mechanics/known_scene.h"
#include "tests/physics/world.h"
#include "tests/scenes/ball.h"
#include "tests/scenes/box.h"

namespace taut::mechanics {
namespace {

using test::Distance, test::Norm;

constexpr double kRadius = 0.03;

enum class TurnedBy { kMotion, kHinge };

/// Returns a table that rotates with `spin` about the vertical through `axis`, and on it a ball at
/// (0.5, 0) that rolls with 0.4 m/s along y. The table on a hinge is so heavy that the ball does
/// not slow it down.
ModelDef Turntable(double spin, const Vec3& axis, TurnedBy by) {
  ModelDef def;
  const Material rough{5, 5};
  const Vec3 middle = axis - Vec3{0, 0, 0.05};
  const int table = scenes::AddBox(def, "table", 1e8, {9, 9, 0.05}, middle, {}, rough);
  if (by == TurnedBy::kMotion) {
    def.bodies[table].fixed = true;
    MotionDef motion;
    motion.name = "turn", motion.body = table;
    motion.axis = {0, 0, 1}, motion.center_m = axis;
    motion.turn.speed = {{0, spin}};
    def.motions.push_back(motion);
  } else {
    def.bodies[table].angular_velocity_rad_per_s = {0, 0, spin};
    JointDef hinge;
    hinge.name = "hinge", hinge.kind = JointKind::kHinge, hinge.body_b = table;
    hinge.axis = {0, 0, 1}, hinge.from_m = hinge.to_m = axis;
    def.joints.push_back(hinge);
  }
  const Vec3 place{0.5, 0, kRadius}, velocity{0, 0.4, 0};
  const int ball = scenes::AddBall(def, "ball", 0.2, kRadius, place, rough);
  const Vec3 table_there = Cross({0, 0, spin}, place - axis);
  const Vec3 relative = velocity - Vec3{table_there.x, table_there.y, 0};
  def.bodies[ball].velocity_m_per_s = velocity;
  def.bodies[ball].angular_velocity_rad_per_s = (1 / kRadius) * Cross({0, 0, 1}, relative);
  return def;
}

/// The ball's center circles a fixed point with 2/7 of the table's angular velocity. Source: the
/// classical problem, e.g. Weltner, Am. J. Phys. 47 (1979) 984.
void RollInACircle(Report& report, double spin, double h, const Vec3& axis, TurnedBy by) {
  const ModelDef def = Turntable(spin, axis, by);
  WorldBatch world = test::MakeBatch(def);
  const Vec3 start = world.Body(0, 1).position_m, v = world.Body(0, 1).velocity_m_per_s;
  const Vec3 center = start + (3.5 / spin) * Cross({0, 0, 1}, v);
  const double radius = Distance(start, center);
  double worst_radius = 0, worst_slip = 0;
  const int blocks = report.IsFull() ? 30 : 5;
  for (int n = 0; n < blocks; ++n) {
    world.Step(h, test::StepsIn(1, h));
    const BodyState ball = world.Body(0, 1);
    worst_radius = std::max(worst_radius, std::fabs(Distance(ball.position_m, center) - radius));
    const Vec3 contact = ball.position_m - Vec3{0, 0, kRadius};
    const Vec3 slip = ball.velocity_m_per_s +
                      Cross(ball.angular_velocity_rad_per_s, {0, 0, -kRadius}) -
                      Cross({0, 0, spin}, contact - axis);
    worst_slip = std::max(worst_slip, Norm(slip));
  }
  const std::string of =
      ", " + std::to_string(spin).substr(0, 4) + " rad/s, step " + std::to_string(h).substr(0, 5) +
      " s" + (by == TurnedBy::kHinge ? ", on a hinge" : "") + (axis.x != 0 ? ", axis aside" : "");
  report.AtMost("change of the circle's radius" + of, "m", worst_radius, 1e-5);
  report.AtMost("slip" + of, "m/s", worst_slip, 1e-9);
  report.AtMost("status bits" + of, "1", world.Status(0).bits, 0);
}

void BallOnATurntable(Report& report) {
  for (const double spin : {2.0, 6.0, 12.0}) {
    RollInACircle(report, spin, 1e-3, {0, 0, 0}, TurnedBy::kMotion);
  }
  RollInACircle(report, 6, 4e-3, {0, 0, 0}, TurnedBy::kMotion);
  RollInACircle(report, 6, 1e-3, {0.1, -0.2, 0}, TurnedBy::kMotion);
  RollInACircle(report, 6, 1e-3, {0, 0, 0}, TurnedBy::kHinge);
}

/// Two drums with the same rotation carry a plank at v = w r, without slip.
void PlankOnDrums(Report& report) {
  ModelDef def;
  const Material rough{1, 1};
  const double radius = 0.05, spin = 3;
  for (const double x : {-0.3, 0.3}) {
    const int drum = scenes::AddBall(def, x < 0 ? "left" : "right", 1, 0.01, {x, 0, 0}, {});
    def.spheres.back().collides = false;
    def.bodies[drum].fixed = true;
    CapsuleDef roller;
    roller.name = def.bodies[drum].name, roller.body = drum, roller.radius_m = radius;
    roller.from_m = {x, -0.2, 0}, roller.to_m = {x, 0.2, 0}, roller.material = rough;
    def.capsules.push_back(roller);
    MotionDef motion;
    motion.name = roller.name, motion.body = drum, motion.axis = {0, 1, 0};
    motion.center_m = {x, 0, 0}, motion.turn.speed = {{0, spin}};
    def.motions.push_back(motion);
  }
  const Vec3 half{1, 0.1, 0.01};
  const int plank = scenes::AddBox(def, "plank", 1, half, {-0.3, 0, radius + half.z}, {}, rough);
  def.bodies[plank].velocity_m_per_s = {spin * radius, 0, 0};
  WorldBatch world = test::MakeBatch(def);
  world.Step(1e-3, 4000);
  const BodyState end = world.Body(0, plank);
  report.Near("displacement in 4 s", "m", end.position_m.x + 0.3, 4 * spin * radius, 1e-7);
  report.AtMost("difference from the surface speed of the drums", "m/s",
                Distance(end.velocity_m_per_s, {spin * radius, 0, 0}), 1e-9);
}

const SceneEntry kTurntable("rolling", "Ball on a turntable",
                            "circle with 2/7 of the table's angular velocity", BallOnATurntable);
const SceneEntry kPlank("rolling", "Plank on two driven drums", "v = w r", PlankOnDrums);

}  // namespace
}  // namespace taut::mechanics
