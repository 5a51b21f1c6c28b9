/// Stability limit of the time step under joint forces (docs/theory/joints.md, eq. 8): stable and
/// without status just below it, unstable and reported just above.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/mechanics/known_scene.h"
#include "tests/physics/joint_scenes.h"

namespace taut::mechanics {
namespace {

using test::MakeBatch, test::Norm;

constexpr double kStep = 1e-3, kLinkLength = 0.1;

JointDef Pin(JointKind kind, int a, int b, const Vec3& from, const Vec3& to) {
  JointDef joint;
  joint.name = "joint" + std::to_string(b), joint.kind = kind, joint.body_a = a, joint.body_b = b;
  joint.from_m = from, joint.to_m = to, joint.axis = {0, 1, 0};
  return joint;
}
int AddMass(ModelDef& def, double mass_kg, double inertia_kg_m2, const Vec3& at) {
  BodyDef body;
  const int number = static_cast<int>(def.bodies.size());
  body.name = "mass" + std::to_string(number), body.mass_kg = mass_kg, body.com_m = at;
  body.inertia_kg_m2.xx = body.inertia_kg_m2.yy = body.inertia_kg_m2.zz = inertia_kg_m2;
  def.bodies.push_back(body);
  return number;
}

/// Largest lateral deviation of body `b` in 1 s, its growth from step 10 to step 20, and the status
/// of the world.
struct Outcome {
  double strays_m = 0, growth = 0;
  std::uint32_t bits = 0, early_bits = 0;  ///< Status bits at the end, and after 20 ms.
};
Outcome Follow(const ModelDef& def, int b) {
  WorldBatch world = MakeBatch(def);
  Outcome out;
  for (int n = 0; n < 1000; ++n) {
    world.Step(kStep);
    const Vec3 at = world.Body(0, b).position_m;
    const double sideways = std::hypot(at.x, at.y);
    if (n + 1 == 10) out.growth = 1 / sideways;
    if (n + 1 == 20) out.growth *= sideways;
    if (n == 20) out.early_bits = world.Status(0).bits;
    if (sideways == sideways) out.strays_m = std::max(out.strays_m, sideways);
  }
  out.bits = world.Status(0).bits;
  return out;
}

/// `scene(load)`: a scene at that share of the load with w h = 2. All bodies start with 1 um/s
/// sideways. Above the limit, x(n+1) - 2 x(n) + x(n-1) = -(w h)^2 x(n) grows by a + sqrt(a^2 - 1) a
/// step, a = (w h)^2 / 2 - 1, until the deviation changes the joint forces. In step 10 stable modes
/// still contribute up to 1/40 of the deviation.
template <class F>
void AroundTheLimit(Report& report, double margin, int body, const F& scene) {
  const Outcome below = Follow(scene(1 - margin), body), above = Follow(scene(1 + margin), body);
  const std::string percent = std::to_string(static_cast<int>(std::lround(100 * margin))) + " %";
  report.AtMost("largest deviation, " + percent + " below the limit", "m", below.strays_m, 1e-6);
  report.Near("status bits, " + percent + " below", "1", below.bits, kStatusOk, 0);
  const double a = 2 * (1 + margin) - 1, grows = std::pow(a + std::sqrt(a * a - 1), 10);
  report.Near("growth from step 10 to step 20, " + percent + " above", "1", above.growth, grows,
              0.05 * grows);
  report.Near("status bit \"step too long\" after 20 ms, " + percent + " above", "1",
              above.early_bits & kStatusStepTooLong, kStatusStepTooLong, 0);
}

void StrongField(Report& report) {
  // w^2 = m g r / (I + m r^2)
  AroundTheLimit(report, 0.02, 0, [](double load) {
    ModelDef def;
    scenes::AddRod(def, "rod", 1, 0.01, {}, {0, 0, -kLinkLength}, {});
    def.bodies[0].velocity_m_per_s.x = 1e-6;
    const double r = kLinkLength / 2, inertia = def.bodies[0].inertia_kg_m2.yy + r * r;
    def.gravity_m_per_s2 = {0, 0, -load * 4 * inertia / (kStep * kStep * r)};
    def.joints.push_back(Pin(JointKind::kHinge, kWorld, 0, {}, {}));
    return def;
  });
}

void HeavyEnd(Report& report) {
  // Two light rods between a pin and a heavy ball, whose common joint is displaced by x: (2 m / 3)
  // x'' = -2 F x / l, w^2 = 3 F / (m l).
  AroundTheLimit(report, 0.05, 0, [](double load) {
    constexpr double kMass = 0.01;
    ModelDef def;
    scenes::AddRod(def, "upper", kMass, 1e-3, {}, {0, 0, -kLinkLength}, {});
    scenes::AddRod(def, "lower", kMass, 1e-3, {0, 0, -kLinkLength}, {0, 0, -2 * kLinkLength}, {});
    for (CapsuleDef& capsule : def.capsules) capsule.collides = false;
    const double force = load * 4 / (kStep * kStep) * kMass * kLinkLength / 3;
    const Vec3 end{0, 0, -2 * kLinkLength};
    AddMass(def, force / kG, 100, end);
    def.bodies[0].velocity_m_per_s.x = 1e-6;
    def.joints.push_back(Pin(JointKind::kBall, kWorld, 0, {}, {}));
    const Vec3 middle{0, 0, -kLinkLength};
    def.joints.push_back(Pin(JointKind::kBall, 0, 1, middle, middle));
    def.joints.push_back(Pin(JointKind::kBall, 1, 2, end, end));
    return def;
  });
}

void StringOfBeads(Report& report) {
  // Two beads on a string of three distances under the tension F: w^2 = 3 F / (m l).
  AroundTheLimit(report, 0.05, 0, [](double load) {
    constexpr double kMass = 0.01;
    ModelDef def;
    const double force = load * 4 / (kStep * kStep) * kMass * kLinkLength / 3;
    Vec3 last;
    for (int i = 0; i < 3; ++i) {
      const Vec3 at{0, 0, -kLinkLength * (i + 1)};
      AddMass(def, i < 2 ? kMass : force / kG, i < 2 ? 1e-6 : 1, at);
      def.joints.push_back(Pin(JointKind::kDistance, i - 1, i, last, at));
      last = at;
    }
    def.bodies[0].velocity_m_per_s.x = 1e-6, def.bodies[1].velocity_m_per_s.x = -1e-6;
    return def;
  });
}

void OffTheAxis(Report& report) {
  // Rods with pins off their axes rotate about these axes, with little inertia: w^2 = F r / I.
  AroundTheLimit(report, 0.05, 0, [](double load) {
    constexpr double kAside = 5e-3, kAxial = 1e-6;
    ModelDef def;
    AddMass(def, 1, 1e-3, {});
    def.bodies[0].inertia_kg_m2.yy = kAxial;
    def.bodies[0].angular_velocity_rad_per_s = {0, 1e-4, 0};
    def.gravity_m_per_s2 = {0, 0, -load * 4 / (kStep * kStep) * (kAxial / kAside + kAside)};
    def.joints.push_back(Pin(JointKind::kHinge, kWorld, 0, {0, 0, kAside}, {0, 0, kAside}));
    return def;
  });
}

void NoFalseAlarm(Report& report) {
  for (const double inertia : {1e-5, 1e-7, 1e-9}) {
    ModelDef def;
    AddMass(def, 1, inertia, {0.2, 0, 0});
    def.joints.push_back(Pin(JointKind::kHinge, kWorld, 0, {}, {}));
    char name[80];
    std::snprintf(name, sizeof name, "status bits of a point mass with %.0e kg m^2 on a hinge",
                  inertia);
    report.Near(name, "1", Follow(def, 0).bits, kStatusOk, 0);
  }
  // A free body carries the hinge; its motion reduces the effective inertia of the lever, but not
  // to 0.
  ModelDef pair;
  AddMass(pair, 10, 0.1, {});
  AddMass(pair, 1, 1e-9, {0.2, 0, 0});
  pair.bodies[0].angular_velocity_rad_per_s = {0, 5, 0};
  pair.joints.push_back(Pin(JointKind::kHinge, 0, 1, {0.05, 0, 0}, {0.05, 0, 0}));
  report.Near("status bits of a point mass on a hinge of a free body", "1", Follow(pair, 0).bits,
              kStatusOk, 0);
}

void Kapitza(Report& report) {
  // Inverted pendulum, pivot oscillating by a with frequency W: stable if (a W)^2 > 2 g l.
  constexpr double kArm = 0.2, kSwing = 0.02;
  for (const double share : {0.9, 1.1}) {
    ModelDef def;
    AddMass(def, 1, 1e-3, {});
    def.bodies[0].fixed = true;
    AddMass(def, 1, 1e-7, {kArm * std::sin(0.02), 0, kArm * std::cos(0.02)});
    MotionDef motion;
    motion.name = "pivot", motion.body = 0, motion.direction = {0, 0, 1};
    motion.slide.amplitude = kSwing;
    motion.slide.frequency_hz = share * std::sqrt(2 * kG * kArm) / kSwing / (2 * std::numbers::pi);
    def.motions.push_back(motion);
    def.joints.push_back(Pin(JointKind::kHinge, 0, 1, {}, {}));
    WorldBatch world = MakeBatch(def);
    double lowest = 1;
    for (int n = 0; n < 5000; ++n) {
      world.Step(kStep);
      const double height = world.Body(0, 1).position_m.z - world.Body(0, 0).position_m.z;
      lowest = std::min(lowest, height / kArm);
    }
    const std::string name = share > 1 ? ", 1.1 of the limit" : ", 0.9 of the limit";
    report.AtMost("stands (0) or falls (1)" + name, "1",
                  std::abs((lowest > 0.5 ? 0 : 1) - (share > 1 ? 0 : 1)), 0);
    report.Near("status bits" + name, "1", world.Status(0).bits, kStatusOk, 0);
  }
}

const SceneEntry kStrongField("joint steps", "Pinned rod in a strong field",
                              "h w = 2, w^2 = m g r / (I + m r^2)", StrongField);
const SceneEntry kHeavyEnd("joint steps", "Two light rods that carry a heavy ball",
                           "h w = 2, w^2 = 3 F / (m l)", HeavyEnd);
const SceneEntry kStringOfBeads("joint steps", "Beads on a string of distance joints",
                                "h w = 2, w^2 = 3 F / (m l)", StringOfBeads);
const SceneEntry kOffTheAxis("joint steps", "Body with its center of mass close to the hinge axis",
                             "h w = 2, w^2 = m g r / (I + m r^2)", OffTheAxis);
const SceneEntry kNoFalseAlarm("joint steps", "Light bodies on levers",
                               "slow motions set no status bit", NoFalseAlarm);
const SceneEntry kKapitza("joint steps", "Kapitza's pendulum near its threshold", "(a W)^2 = 2 g l",
                          Kapitza);

}  // namespace
}  // namespace taut::mechanics
