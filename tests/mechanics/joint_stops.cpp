/// Joint limits: resting contact, rebound and release.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/mechanics/jointed_mass.h"
#include "tests/mechanics/known_scene.h"
#include "tests/mechanics/runge_kutta.h"
#include "tests/physics/joint_scenes.h"

namespace taut::mechanics {
namespace {

using test::EnergyOf, test::MakeBatch, test::Norm, test::StepsIn;

/// Returns a thin rod of 1 m and 1 kg that rotates about its end at the origin.
ModelDef RodAlong(const Vec3& to) {
  ModelDef def;
  scenes::AddRod(def, "rod", 1, 1e-3, {}, to, {});
  return def;
}

std::string At(double step_s, double restitution) {
  const int us = static_cast<int>(std::lround(step_s * 1e6));
  return "e " + std::to_string(restitution).substr(0, 3) + ", " + std::to_string(us) + " us";
}

/// Returns a mass on a rope of 0.5 m.
ModelDef Rope(const Vec3& at, const Vec3& velocity, double restitution = 0) {
  ModelDef def = PointMass(at, velocity);
  JointDef rope = JointAt(JointKind::kDistance, {}, {0, 0, 1});
  rope.to_m = at, rope.most = 0.5, rope.restitution = restitution;
  def.joints.push_back(rope);
  return def;
}

void SwingingRope(Report& report) {
  for (const double h : {1e-3, 4e-3}) {
    const std::string step = h > 2e-3 ? ", 4 ms" : ", 1 ms";
    WorldBatch world = MakeBatch(Rope({0.1, 0, 0}, {1, 2, 0.5}));
    const double start = EnergyOf(world), never = 1e300;
    double longest = 0, shortest = never, pushed = 0, gained = 0;
    double least = never, most = -never;
    for (int n = 1; n <= StepsIn(60, h); ++n) {
      world.Step(h);
      const Vec3 at = world.Body(0, 0).position_m;
      const double energy = EnergyOf(world), time_s = n * h;
      longest = std::max(longest, Norm(at));
      pushed = std::max(pushed, Dot(world.Joint(0, 0).force_n, at));
      gained = std::max(gained, energy - start);
      if (time_s < 2) continue;  // from here on the rope is taut
      shortest = std::min(shortest, Norm(at));
      least = std::min(least, energy), most = std::max(most, energy);
    }
    const double scale = h * h / 1e-6;
    report.AtMost("excess of the largest length in 60 s over 0.5 m" + step, "m", longest - 0.5,
                  1e-9);
    report.AtMost("deficit of the least length while taut below 0.5 m" + step, "m", 0.5 - shortest,
                  1e-9);
    report.AtMost("energy gain above the initial value" + step, "J", gained, 1e-12);
    report.AtMost("variation of the energy while taut" + step, "J", most - least, 3e-5 * scale);
    report.AtMost("outward force of the rope times its length" + step, "N m", pushed, 0);
    report.Near("status bits" + step, "1", world.Status(0).bits, kStatusOk, 0);
  }
}

/// Released at the lowest point with v^2 = 3.5 g L, a mass leaves its circle after 120 degrees and
/// flies on a parabola until the rope snatches.
struct Flight {
  static constexpr double kLength = 0.5;
  double speed = std::sqrt(3.5 * kG * kLength);
  double apex_m = 0.6875 * kLength;
  double radial = 0;  ///< Speed along the rope when it is taut again [m/s].

  Flight() {
    const double v = std::sqrt(0.5 * kG * kLength), s = std::sqrt(0.75), c = -0.5;
    const double x0 = kLength * s, z0 = -kLength * c, vx = v * c, vz = v * s;
    const auto x = [&](double t) { return x0 + vx * t; };
    const auto z = [&](double t) { return z0 + vz * t - kG / 2 * t * t; };
    double low = 0.05, high = 1;
    for (int i = 0; i < 200; ++i) {
      const double t = (low + high) / 2;
      (std::hypot(x(t), z(t)) > kLength ? high : low) = t;
    }
    radial = (x(low) * vx + z(low) * (vz - kG * low)) / kLength;
  }
};

void SlackRope(Report& report) {
  const Flight flight;
  for (const double e : {0.0, 0.5, 1.0}) {
    for (const double h : {1e-3, 2.5e-4}) {
      WorldBatch world = MakeBatch(Rope({0, 0, -0.5}, {flight.speed, 0, 0}, e));
      const double start = EnergyOf(world);
      double top = 0, pushed = 0, longest = 0;
      bool slack = false, again = false;
      int after = 0;
      while (world.Time(0) < 2 && after < 4) {
        world.Step(h);
        const Vec3 at = world.Body(0, 0).position_m;
        const double force = Norm(world.Joint(0, 0).force_n);
        if (!again) top = std::max(top, at.z);
        longest = std::max(longest, Norm(at));
        pushed = std::max(pushed, Dot(world.Joint(0, 0).force_n, at));
        slack = slack || force == 0, again = again || (slack && force > 0);
        if (again) ++after;
      }
      const double lost = (1 - e * e) * flight.radial * flight.radial / 2;
      const double off = std::abs(start - EnergyOf(world) - lost);
      report.AtMost("energy lost in the snatch, " + At(h, e), "J", off, 30 * h * h);
      report.Near("apex, " + At(h, e), "m", top, flight.apex_m, 20 * h * h);
      report.AtMost("largest length above 0.5 m, " + At(h, e), "m", longest - 0.5, 1e-9);
      report.AtMost("outward force of the rope times its length, " + At(h, e), "N m", pushed, 0);
    }
  }
}

void SpinningBodyOnRope(Report& report) {
  // The rope is attached 0.1 m from the body's center of mass; 38 J.
  const double spin = 200, tilt = 0.3;
  double change[2] = {};
  for (int k = 0; k < 2; ++k) {
    const double h = k == 0 ? 1e-3 : 2.5e-4;
    const Vec3 up{std::sin(tilt), 0, std::cos(tilt)};
    ModelDef def = PointMass(-0.6 * up, {0, 1, 0});
    BodyDef& body = def.bodies[0];  // moments of 0.002 kg m^2 along `up`, 0.01 across it
    body.inertia_kg_m2 = {0.01 - 0.008 * up.x * up.x, 0.01, 0.01 - 0.008 * up.z * up.z, 0,
                          -0.008 * up.x * up.z,       0};
    body.angular_velocity_rad_per_s = {0.3 * spin, 0, spin};
    JointDef rope = JointAt(JointKind::kDistance, {}, {0, 0, 1});
    rope.to_m = -0.5 * up, rope.most = 0.5;
    def.joints.push_back(rope);
    WorldBatch world = MakeBatch(def);
    const double start = EnergyOf(world);
    double longest = 0;
    for (int n = StepsIn(report.IsFull() ? 60 : 5, h); n > 0; --n) {
      world.Step(h);
      change[k] = std::max(change[k], std::abs(EnergyOf(world) - start));
      longest = std::max(longest, world.Joint(0, 0).coordinate);
    }
    const std::string step = k == 0 ? ", 1 ms" : ", 250 us";
    report.AtMost("change of the energy" + step, "J", change[k], 1.5e-5 * h * h / 1e-6);
    report.AtMost("largest length above 0.5 m" + step, "m", longest - 0.5, 1e-9);
  }
  report.Order("change of the energy, 1 ms and 250 us", change[0], change[1], 4, 1.8);
}

void CircleInCone(Report& report) {
  // The rod starts inside the cone, swings onto it and circles along it.
  const double start = 0.55, limit = 0.6;
  const Vec3 along{std::sin(start), 0, -std::cos(start)}, turn{0, 0, 6};
  for (const double h : {1e-3, 2.5e-4}) {
    ModelDef def = RodAlong(along);
    def.bodies[0].angular_velocity_rad_per_s = turn - Dot(turn, along) * along;
    def.bodies[0].velocity_m_per_s = Cross(turn, 0.5 * along);
    JointDef cone = JointAt(JointKind::kBall, {}, {0, 0, -1});
    cone.turned = {std::cos(start / 2), 0, -std::sin(start / 2), 0};
    cone.most = limit;
    def.joints.push_back(cone);
    WorldBatch world = MakeBatch(def);
    double widest = 0, narrowest = 1, settled = 0, swing = 0;
    const double time_s = report.IsFull() || h > 5e-4 ? 20 : 5;
    for (int n = 1; n <= StepsIn(time_s, h); ++n) {
      world.Step(h);
      const double angle = world.Joint(0, 0).coordinate;
      widest = std::max(widest, angle);
      if (n * h < 2) {
        settled = EnergyOf(world);
        continue;
      }
      narrowest = std::min(narrowest, angle);
      swing = std::max(swing, std::abs(EnergyOf(world) - settled));
    }
    const std::string step = h > 5e-4 ? ", 1 ms" : ", 250 us";
    report.AtMost("widest angle above 0.6 rad" + step, "rad", widest - limit, 1e-9);
    report.AtMost("narrowest angle below 0.6 rad" + step, "rad", limit - narrowest, 1e-9);
    // Error of third order in the step; the rod has 0.2 J.
    report.AtMost("change of the energy on the cone" + step, "J", swing, 20 * h * h * h);
  }
}

/// Returns two rods at a right angle, pinned at an end; a spring of 50 N m presses their elbow
/// against its limit.
ModelDef Elbow(bool pinned) {
  ModelDef def;
  scenes::AddRod(def, "upper", 1, 0.01, {}, {0.4, 0, 0}, {});
  scenes::AddRod(def, "lower", 0.5, 0.01, {0.4, 0, 0}, {0.4, 0, 0.3}, {});
  for (CapsuleDef& capsule : def.capsules) capsule.collides = false;
  if (pinned) def.joints.push_back(JointAt(JointKind::kHinge, {}, {0, 1, 0}));
  JointDef elbow = JointAt(JointKind::kHinge, {0.4, 0, 0}, {0, 1, 0});
  elbow.name = "elbow", elbow.body_a = 0, elbow.body_b = 1;
  elbow.least = 0, elbow.stiffness = 50, elbow.rest = -1;
  def.joints.push_back(elbow);
  return def;
}

void PressedElbow(Report& report) {
  // One rigid body about the pin: I a'' = torque of both weights.
  const double inertia = 0.4 * 0.4 / 3 + 1e-4 / 4 +  // upper
                         0.5 * (0.3 * 0.3 / 12 + 1e-4 / 4 + 0.4 * 0.4 + 0.15 * 0.15);
  const auto rates = [&](double, const std::array<double, 2>& y) {
    // The elbow is at (cos a, -sin a) 0.4; a rotation about y moves x to -z, and z to x.
    const double x = 0.2 * std::cos(y[0]), x2 = 0.4 * std::cos(y[0]) + 0.15 * std::sin(y[0]);
    return std::array<double, 2>{y[1], kG * (x + 0.5 * x2) / inertia};
  };
  const double wanted = Integrate<2>(rates, 0, {0, 0}, 3)[0];
  double off[2] = {};
  for (int k = 0; k < 2; ++k) {
    const double h = k == 0 ? 2e-3 : 1e-3;
    WorldBatch world = MakeBatch(Elbow(true));
    double moved = 0;
    for (int n = 0; n < StepsIn(3, h); ++n) {
      world.Step(h);
      moved = std::max(moved, std::abs(world.Joint(0, 1).coordinate));
    }
    off[k] = std::abs(world.Joint(0, 0).coordinate - wanted);
    const std::string step = k == 0 ? ", 2 ms" : ", 1 ms";
    report.AtMost("elbow away from its stop" + step, "rad", moved, 1e-9);
    report.AtMost("angle of the pin after 3 s" + step, "rad", off[k], k == 0 ? 2e-5 : 5e-6);
  }
  report.Order("angle of the pin, 2 and 1 ms", off[0], off[1], 2, 1.8);
}

void FreeElbow(Report& report) {
  ModelDef def = Elbow(false);
  def.gravity_m_per_s2 = {};
  for (BodyDef& body : def.bodies) {
    body.angular_velocity_rad_per_s = {2, 3, -1};
    body.velocity_m_per_s = Cross(body.angular_velocity_rad_per_s, body.com_m);
  }
  WorldBatch world = MakeBatch(def);
  const Vec3 p = world.Momentum(0), l = world.AngularMomentum(0);
  const double start = EnergyOf(world);
  double moved = 0, change = 0;
  for (int n = 0; n < 10000; ++n) {
    world.Step(1e-3);
    moved = std::max(moved, std::abs(world.Joint(0, 0).coordinate));
    change = std::max(change, std::abs(EnergyOf(world) - start));
  }
  report.AtMost("elbow away from its stop", "rad", moved, 1e-9);
  report.AtMost("change of the momentum, 10 s", "N s", Norm(world.Momentum(0) - p), 1e-11);
  report.AtMost("change of the angular momentum, 10 s", "N m s", Norm(world.AngularMomentum(0) - l),
                1e-11);
  report.AtMost("change of the energy, 10 s", "J", change, 1e-5 * start);
}

constexpr double kStopSteps[] = {4e-3, 1e-3, 2.5e-4}, kRestitutions[] = {0.5, 0.8, 1.0};

/// Reports the largest error of `error(restitution, step, which)` over some starts, for all
/// restitutions and steps: second order, plus the share `lost` of the energy at any step size.
template <class F>
void Rebounds(Report& report, double bound_1ms, double lost, const F& error) {
  const int starts = report.IsFull() ? 20 : 5;
  for (const double e : kRestitutions) {
    for (const double h : kStopSteps) {
      double worst = 0;
      for (int i = 0; i < starts; ++i) worst = std::max(worst, error(e, h, i));
      const double scale = h * h / 1e-6;
      report.AtMost("height after the rebound, relative, " + At(h, e), "1", worst,
                    bound_1ms * scale * (e == 1 ? 0.05 : 1) + lost);
    }
  }
}

/// Energy loss in a rod's pin at the impact, from E = m (w L)^2 / 6: with the compliance of its
/// row, c = 1e-7 of 4 / m, and the impulse l = m w L (1 + e) / 2, eq. 3a of joints.md gives the
/// loss c l^2 / 2 = 3e-7 (1 + e)^2 E.
constexpr double kPinTakes = 12e-7;

void BouncingSlider(Report& report) {
  Rebounds(report, 1e-5, 1e-12, [](double e, double h, int i) {
    const double height = 0.5 + 0.0011 * i, falls_s = std::sqrt(2 * height / kG);
    ModelDef def = PointMass({0, 0, height}, {});
    JointDef slide = JointAt(JointKind::kPrismatic, {0, 0, height}, {0, 0, 1});
    slide.least = -height, slide.restitution = e;
    def.joints.push_back(slide);
    WorldBatch world = MakeBatch(def);
    world.Step(h, StepsIn(falls_s * (1 + e), h));  // after the rebound; the apex is halfway to this
                                                   // time
    const BodyState now = world.Body(0, 0);
    const double v = now.velocity_m_per_s.z, top = now.position_m.z + v * v / (2 * kG);
    return std::abs(top / (e * e * height) - 1);
  });
}

/// Steps until the joint's rate is no longer positive.
void StepPastRebound(WorldBatch& world, double step_s) {
  double last = 0;
  while (world.Time(0) < 10 && !(last > 0 && world.Joint(0, 0).rate <= 0)) {
    last = world.Joint(0, 0).rate;
    world.Step(step_s);
  }
}

void HingeStop(Report& report) {
  // A level rod falls on a limit below it: after the rebound its energy is e^2 times the energy of
  // the fall.
  Rebounds(report, 2e-4, kPinTakes, [](double e, double h, int i) {
    const double stop = 1.2 + 0.013 * i;
    ModelDef def = RodAlong({1, 0, 0});
    JointDef hinge = JointAt(JointKind::kHinge, {}, {0, 1, 0});
    hinge.most = stop, hinge.restitution = e;
    def.joints.push_back(hinge);
    WorldBatch world = MakeBatch(def);
    const double start = EnergyOf(world), fall = kG / 2 * std::sin(stop);
    StepPastRebound(world, h);
    return std::abs((EnergyOf(world) - start + fall) / (e * e * fall) - 1);
  });
}

void ConeStop(Report& report) {
  // A hanging rod swings upward against its cone.
  Rebounds(report, 2e-4, kPinTakes, [](double e, double h, int i) {
    const double stop = 0.6 + 0.013 * i, turn = 6, kinetic = turn * turn / 6;
    ModelDef def = RodAlong({0, 0, -1});
    def.bodies[0].angular_velocity_rad_per_s = {0, -turn, 0};
    def.bodies[0].velocity_m_per_s = {turn / 2, 0, 0};
    JointDef ball = JointAt(JointKind::kBall, {}, {0, 0, -1});
    ball.most = stop, ball.restitution = e;
    def.joints.push_back(ball);
    WorldBatch world = MakeBatch(def);
    const double start = EnergyOf(world), climb = kG / 2 * (1 - std::cos(stop));
    StepPastRebound(world, h);
    const double left = EnergyOf(world) - start + kinetic - climb;
    return std::abs(left / (e * e * (kinetic - climb)) - 1);
  });
}

const SceneEntry kSpinningBodyOnRope("joint stops", "Body that spins at 200 rad/s on a rope",
                                     "conservation of energy", SpinningBodyOnRope);
const SceneEntry kSwingingRope("joint stops", "Rope with a mass that swings for a minute",
                               "length of the rope; energy does not increase", SwingingRope);
const SceneEntry kSlackRope("joint stops", "Rope that goes slack and snatches",
                            "circle and parabola; Newton's law at the snatch", SlackRope);
const SceneEntry kCircleInCone("joint stops", "Rod that goes round along the cone of a ball joint",
                               "angle of the cone; energy", CircleInCone);
const SceneEntry kPressedElbow("joint stops", "Elbow pressed on its stop swings as one body",
                               "compound pendulum by Runge-Kutta", PressedElbow);
const SceneEntry kFreeElbow("joint stops", "Elbow pressed on its stop tumbles in free space",
                            "momenta and energy", FreeElbow);
const SceneEntry kBouncingSlider("joint stops", "Slider that falls on its stop",
                                 "height after the rebound: e^2 of the height of the fall",
                                 BouncingSlider);
const SceneEntry kHingeStop("joint stops", "Rod that falls on the stop of its hinge",
                            "energy after the rebound: e^2 of the energy of the fall", HingeStop);
const SceneEntry kConeStop("joint stops", "Rod that is thrown against its cone",
                           "energy after the rebound: e^2 of the energy of the impact", ConeStop);
}  // namespace
}  // namespace taut::mechanics
