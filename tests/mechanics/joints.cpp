/// Bodies on joints: spin, loops, redundant rows.

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenes/rod.h"
#include "tests/mechanics/runge_kutta.h"
#include "tests/mechanics/scene.h"
#include "tests/physics/world.h"

namespace taut::mechanics {
namespace {

using test::Distance;
using test::EnergyOf;
using test::MakeBatch;
using test::StepsIn;

constexpr double kG = 9.81;

// --- A body that turns about a point ----------------------------------------------------------

/// A body of 1 kg on a ball joint at the origin. Moments about the center of mass along its axes,
/// of which z goes through the joint; it starts turned by `tilt_rad` about the y axis of W.
struct BodyOnBall {
  Vec3 moments_kg_m2;
  double arm_m;  ///< Of the center of mass, along the body's z axis.
  double tilt_rad;
  Vec3 spin_rad_per_s;  ///< Along the body's axes.
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

/// The center of mass after `time_s` by Euler's equations about the joint.
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

/// Largest and smallest energy relative to the start, and status bits.
struct EnergyRange {
  double gain_j = 0, loss_j = 0;
  double flagged = 0, unsolved = 0;  ///< Steps with any status bit, and unsolved steps.
  double gap_m = 0;

  double Off() const { return std::max(gain_j, loss_j); }
};

EnergyRange Run(Batch& world, double step_s, double time_s) {
  EnergyRange seen;
  const double start = EnergyOf(world);
  const int joints = static_cast<int>(world.model().def().joints.size());
  for (int n = StepsIn(time_s, step_s); n > 0; --n) {
    world.Step(step_s);
    const double change = EnergyOf(world) - start;
    // Not a number counts as a gain.
    if (!(change <= seen.gain_j)) seen.gain_j = change;
    seen.loss_j = std::max(seen.loss_j, -change);
    for (int i = 0; i < joints; ++i) seen.gap_m = std::max(seen.gap_m, world.Joint(0, i).gap_m);
    if (world.Status(0).bits == kStatusOk) continue;
    ++seen.flagged;
    if ((world.Status(0).bits & kStatusNotConverged) != 0) ++seen.unsolved;
    world.ClearStatus(0);
  }
  return seen;
}

double PlaceError(const BodyOnBall& top, double step_s, double time_s) {
  Batch world = MakeBatch(ModelOf(top));
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
    Batch world = MakeBatch(ModelOf(Top(spin)));
    const EnergyRange seen = Run(world, 1e-3, time_s);
    report.AtMost("energy off, " + name, "J", seen.Off(), 4e-3);
    report.AtMost("steps with a status bit, " + name, "1", seen.flagged, 0);
  }
  const BodyOnBall top = Top(200);
  const double at_1ms = PlaceError(top, 1e-3, 1), at_half = PlaceError(top, 5e-4, 1);
  report.AtMost("place after 1 s, 200 rad/s, 1 ms", "m", at_1ms, 1e-4);
  report.Order("place, 200 rad/s, 1 and 0.5 ms", at_1ms, at_half, 2, 1.9);
}

void SphericalPendulum(Report& report) {
  const BodyOnBall pendulum{{0.02, 0.02, 0.001}, -0.5, 0, {3, 1, 5}};
  Batch world = MakeBatch(ModelOf(pendulum));
  const EnergyRange seen = Run(world, 1e-3, report.IsFull() ? 600 : 120);
  report.AtMost("energy off, 1 ms", "J", seen.Off(), 3e-5);
  report.AtMost("gap of the joint", "m", seen.gap_m, 1e-11);
  // Three different moments, and a spin about no axis of symmetry.
  const BodyOnBall uneven{{0.02, 0.05, 0.03}, -0.5, 0.3, {3, 1, 5}};
  const double at_1ms = PlaceError(uneven, 1e-3, 2), at_half = PlaceError(uneven, 5e-4, 2);
  report.AtMost("place after 2 s, three different moments, 1 ms", "m", at_1ms, 1e-4);
  report.Order("place, 1 and 0.5 ms", at_1ms, at_half, 2, 1.9);
}

// --- Frames and nets of rods on ball joints ----------------------------------------------------

/// Rods between nodes: all rods of a node are joined to the first of them there.
struct RodNet {
  ModelDef def;
  std::map<int, std::vector<int>> at;  ///< The rods of a node.
  std::vector<Vec3> nodes_m;

  explicit RodNet(std::vector<Vec3> nodes) : nodes_m(std::move(nodes)) {}

  void AddRod(int from, int to) {
    const int rod = static_cast<int>(def.bodies.size());
    scenes::AddRod(def, "rod" + std::to_string(rod), 0.05, 0.004, Node(from), Node(to), {});
    def.capsules.back().collides = false;
    at[from].push_back(rod), at[to].push_back(rod);
  }
  void Pin(int node) { Join(kWorld, at[node].front(), node); }
  void JoinAll() {
    for (const auto& [node, rods] : at) {
      for (std::size_t k = 1; k < rods.size(); ++k) Join(rods[0], rods[k], node);
    }
  }
  void Join(int body_a, int body_b, int node) {
    JointDef joint;
    joint.name = "joint" + std::to_string(def.joints.size());
    joint.body_a = body_a, joint.body_b = body_b;
    joint.from_m = joint.to_m = Node(node);
    def.joints.push_back(joint);
  }
  /// A cable between two nodes, shorter by a hundredth than their distance.
  void Tie(int from, int to, double stiffness_n_per_m) {
    CableDef cable;
    cable.name = "cable" + std::to_string(def.cables.size());
    cable.attachments = {{at[from].front(), Node(from)}, {at[to].front(), Node(to)}};
    cable.stiffness_n_per_m = stiffness_n_per_m, cable.damping_n_s_per_m = 2;
    cable.rest_length_m = 0.99 * Distance(Node(from), Node(to));
    def.cables.push_back(cable);
  }
  const Vec3& Node(int i) const { return nodes_m[static_cast<std::size_t>(i)]; }
};

/// The same with bodies and joints in the opposite order, each joint described from its other body.
ModelDef Reversed(ModelDef def) {
  const int count = static_cast<int>(def.bodies.size());
  const auto renumber = [&](int& body) { body = body == kWorld ? kWorld : count - 1 - body; };
  std::reverse(def.bodies.begin(), def.bodies.end());
  std::reverse(def.joints.begin(), def.joints.end());
  for (CapsuleDef& capsule : def.capsules) renumber(capsule.body);
  for (CableDef& cable : def.cables) {
    for (AttachmentDef& attachment : cable.attachments) renumber(attachment.body);
  }
  for (JointDef& joint : def.joints) {
    renumber(joint.body_a), renumber(joint.body_b);
    if (joint.body_a == kWorld) continue;
    std::swap(joint.body_a, joint.body_b), std::swap(joint.from_m, joint.to_m);
  }
  return def;
}

/// The largest distance between a body of one world and the same body of the other.
double WorstDistance(const Batch& one, const Batch& reversed) {
  const int count = static_cast<int>(one.model().def().bodies.size());
  double worst = 0;
  for (int b = 0; b < count; ++b) {
    worst = std::max(
        worst, Distance(one.Body(0, b).position_m, reversed.Body(0, count - 1 - b).position_m));
  }
  return worst;
}

void Tumble(ModelDef& def) {
  const Vec3 spin{1, 2, 3};
  def.gravity_m_per_s2 = {};
  for (BodyDef& body : def.bodies) {
    body.angular_velocity_rad_per_s = spin;
    body.velocity_m_per_s = Cross(spin, body.com_m);
  }
}

void ReportFrame(Report& report, const std::string& name, RodNet net, double bound) {
  net.JoinAll();
  Tumble(net.def);
  Batch world = MakeBatch(net.def), reversed = MakeBatch(Reversed(net.def));
  const double energy = EnergyOf(world);
  const Vec3 momentum = world.AngularMomentum(0);
  const double time_s = report.IsFull() ? 5 : 2;
  const EnergyRange seen = Run(world, 1e-3, time_s);
  reversed.Step(1e-3, StepsIn(time_s, 1e-3));
  report.AtMost(name + ": energy off", "of it", seen.Off() / energy, bound);
  report.AtMost(name + ": angular momentum off", "of it",
                Distance(world.AngularMomentum(0), momentum) / test::Norm(momentum), 1e-12);
  report.AtMost(name + ": steps with a status bit", "1", seen.flagged, 0);
  report.AtMost(name + ": largest gap", "m", seen.gap_m, 1e-10);
  report.AtMost(name + ": effect of the listing order", "m", WorstDistance(world, reversed), 1e-8);
}

void TumblingFrames(Report& report) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back(
        {(i & 1) != 0 ? 0.1 : -0.1, (i & 2) != 0 ? 0.1 : -0.1, (i & 4) != 0 ? 0.1 : -0.1});
  }
  RodNet cube(corners);
  for (int i = 0; i < 8; ++i) {
    for (const int bit : {1, 2, 4}) {
      if ((i & bit) == 0) cube.AddRod(i, i | bit);
    }
  }
  ReportFrame(report, "cube of 12 rods, 6 mechanisms", cube, 1e-6);
  RodNet octahedron({{.2, 0, 0}, {-.2, 0, 0}, {0, .2, 0}, {0, -.2, 0}, {0, 0, .2}, {0, 0, -.2}});
  for (int i = 0; i < 6; ++i) {
    for (int k = i + 1; k < 6; ++k) {
      if (k != (i ^ 1)) octahedron.AddRod(i, k);
    }
  }
  octahedron.AddRod(0, 1);
  ReportFrame(report, "octahedron with a diagonal, 1 redundant row", octahedron, 1e-6);
}

/// Bounds for a net: solved, without energy gain, in any order of its lists.
struct NetBounds {
  double gain_j, gap_m, order_m;
  bool may_be_flagged;  ///< Too stiff for the step.
};

void ReportNet(Report& report, const std::string& name, const ModelDef& def, double step_s,
               double time_s, const NetBounds& bounds) {
  Batch world = MakeBatch(def), reversed = MakeBatch(Reversed(def));
  const EnergyRange seen = Run(world, step_s, time_s);
  reversed.Step(step_s, StepsIn(time_s, step_s));
  report.AtMost(name + ": steps without a solution", "1", seen.unsolved, 0);
  if (!bounds.may_be_flagged) {
    report.AtMost(name + ": steps with a status bit", "1", seen.flagged, 0);
  }
  report.AtMost(name + ": energy gained", "J", seen.gain_j, bounds.gain_j);
  report.AtMost(name + ": largest gap", "m", seen.gap_m, bounds.gap_m);
  report.AtMost(name + ": effect of the listing order", "m", WorstDistance(world, reversed),
                bounds.order_m);
}

void RedundantRows(Report& report) {
  {
    // Both ends of the second rod are held, so its length is held twice.
    RodNet net({{0, 0, 1}, {0, 0.2, 1.15}, {0.2, 0, 1.35}});
    net.AddRod(0, 2), net.AddRod(0, 1);
    net.JoinAll(), net.Pin(0), net.Join(kWorld, 1, 1);
    ReportNet(report, "rod between a pin and another rod's pinned end", net.def, 1e-3, 1,
              {1e-6, 1e-11, 1e-10, false});
  }
  {
    RodNet net({{0, 0, 1}, {0, 0.2, 1.03}, {0.2, 0.2, 1.06}, {0.2, 0, 1.015}});
    for (int i = 0; i < 4; ++i) net.AddRod(i, (i + 1) % 4);
    net.JoinAll(), net.Join(kWorld, 3, 0), net.Join(kWorld, 1, 1);
    ReportNet(report, "square of rods that hangs from both ends of one", net.def, 1e-3, 1,
              {1e-5, 1e-11, 1e-8, false});
  }
}

/// A net of `n` by `n` squares of class-k nodes, pinned at its corners, with a cable across each.
ModelDef Net(int n, double stiffness_n_per_m) {
  const auto node = [n](int i, int j) { return i * (n + 1) + j; };
  std::vector<Vec3> nodes;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      nodes.push_back({0.2 * i, 0.2 * j, 1 + 0.01 * ((7 * i + 3 * j) % 5)});
    }
  }
  RodNet net(nodes);
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      if (i < n) net.AddRod(node(i, j), node(i + 1, j));
      if (j < n) net.AddRod(node(i, j), node(i, j + 1));
    }
  }
  net.JoinAll();
  for (const int corner : {node(0, 0), node(0, n), node(n, 0), node(n, n)}) net.Pin(corner);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) net.Tie(node(i, j), node(i + 1, j + 1), stiffness_n_per_m);
  }
  return net.def;
}

void Nets(Report& report) {
  ReportNet(report, "2 by 2 squares, cables of 500 N/m", Net(2, 500), 1e-3,
            report.IsFull() ? 3 : 0.5, {1e-5, 1e-8, 1e-5, true});
  ReportNet(report, "4 by 4 squares, cables of 500 N/m", Net(4, 500), 1e-3, 0.3,
            {1e-5, 1e-8, 1e-5, false});
  // Rods straightened by tight stiff cables exceed the limit of a step of 1 ms; the status reports
  // it.
  Batch tight = MakeBatch(Net(2, 1e6));
  const EnergyRange seen = Run(tight, 1e-3, 0.3);
  report.AtMost("2 by 2 squares, cables of 1e6 N/m: steps without a solution", "1", seen.unsolved,
                0);
  report.AtMost("2 by 2 squares, cables of 1e6 N/m: largest gap", "m", seen.gap_m, 1e-5);
}

/// A cardan joint: two shafts whose axes are apart by `angle_rad` and a cross, each of its arms on
/// two hinges. 30 rows act on 3 bodies with one degree of freedom: 13 of them are redundant.
ModelDef CardanJoint(double angle_rad, double spin_rad_per_s) {
  ModelDef def;
  def.gravity_m_per_s2 = {};
  const Vec3 axis[] = {{1, 0, 0}, {std::cos(angle_rad), std::sin(angle_rad), 0}};
  const Vec3 center[] = {-0.1 * axis[0], 0.1 * axis[1], {}};
  for (int i = 0; i < 3; ++i) {
    BodyDef body;
    body.name = i == 2 ? "cross" : "shaft" + std::to_string(i), body.com_m = center[i];
    body.mass_kg = i == 2 ? 0.1 : 1;
    body.inertia_kg_m2 = {1e-3, 1e-3, 1e-3, 0, 0, 0};
    if (i == 2) body.inertia_kg_m2 = {1e-4, 1e-4, 1e-4, 0, 0, 0};
    def.bodies.push_back(body);
  }
  def.bodies[0].angular_velocity_rad_per_s = spin_rad_per_s * axis[0];
  const auto add = [&](int body_a, int body_b, const Vec3& at, const Vec3& along) {
    JointDef hinge;
    hinge.name = "hinge" + std::to_string(def.joints.size()), hinge.kind = JointKind::kHinge;
    hinge.body_a = body_a, hinge.body_b = body_b, hinge.axis = along;
    hinge.from_m = hinge.to_m = at;
    def.joints.push_back(hinge);
  };
  const Vec3 arm[] = {{0, 0, 1}, Cross(axis[1], Vec3{0, 0, 1})};
  for (int i = 0; i < 2; ++i) add(kWorld, i, center[i], axis[i]);
  for (int i = 0; i < 2; ++i) {
    for (const double side : {-0.02, 0.02}) add(i, 2, side * arm[i], arm[i]);
  }
  return def;
}

void CardanJoints(Report& report) {
  const double angle_rad = 1;
  Batch world = MakeBatch(CardanJoint(angle_rad, 10));
  world.Step(1e-3);  // projects the velocities onto the joints
  const double start = EnergyOf(world);
  double gain = 0, off = 0, ratio_off = 0, force_n = 0, flagged = 0;
  for (int n = 0; n < 3000; ++n) {
    world.Step(1e-3);
    const double change = EnergyOf(world) - start;
    gain = std::max(gain, change), off = std::max(off, std::abs(change));
    const JointState in = world.Joint(0, 0), out = world.Joint(0, 1);
    const double sines = std::sin(angle_rad) * std::sin(in.coordinate);
    const double ratio = std::cos(angle_rad) / (1 - sines * sines);
    ratio_off = std::max(ratio_off, std::abs(out.rate / in.rate - ratio));
    for (int i = 0; i < 6; ++i) force_n = std::max(force_n, test::Norm(world.Joint(0, i).force_n));
    if (world.Status(0).bits != kStatusOk) ++flagged, world.ClearStatus(0);
  }
  report.AtMost("ratio of the shafts' speeds off, 1 rad, 1 ms", "1", ratio_off, 5e-5);
  report.AtMost("energy off", "of it", off / start, 1e-5);
  // The shafts exchange 0.05 J and turn by 1 rad in 0.1 s: torques of some 0.1 N m on arms of
  // 0.02 m.
  report.AtMost("largest force of a joint", "N", force_n, 10);
  report.AtMost("steps with a status bit", "1", flagged, 0);
}

/// Rods in a straight line between two pins: the rows are dependent, and with the small sag the
/// tension is a thousand times the weight.
ModelDef StraightChain(int rods) {
  std::vector<Vec3> nodes;
  for (int i = 0; i <= rods; ++i) nodes.push_back({0.2 * i, 0, 1});
  RodNet net(nodes);
  for (int i = 0; i < rods; ++i) net.AddRod(i, i + 1);
  net.JoinAll(), net.Pin(0), net.Pin(rods);
  return net.def;
}

void StraightChains(Report& report) {
  for (const int rods : {2, 3, 5}) {
    const std::string name = std::to_string(rods) + " rods";
    Batch coarse = MakeBatch(StraightChain(rods));
    report.AtMost(name + ", 1 ms: steps without a solution", "1", Run(coarse, 1e-3, 1).unsolved, 0);
    ReportNet(report, name + ", 0.25 ms", StraightChain(rods), 2.5e-4, 1,
              {1e-6, 1e-8, 1e-6, false});
  }
}

const SceneEntry kSpinningTop("joints", "Spinning top on a ball joint",
                              "energy; Euler's equations by Runge-Kutta", SpinningTop);
const SceneEntry kSphericalPendulum("joints", "Spherical pendulum with spin",
                                    "energy; Euler's equations by Runge-Kutta", SphericalPendulum);
const SceneEntry kTumblingFrames("joints", "Frames of rods that tumble",
                                 "energy and angular momentum", TumblingFrames);
const SceneEntry kRedundantRows("joints", "Rods with redundant rows",
                                "energy; symmetry of the lists", RedundantRows);
const SceneEntry kNets("joints", "Nets of rods, pinned at their corners",
                       "energy; symmetry of the lists", Nets);
const SceneEntry kCardanJoints("joints", "Cardan joint with redundant hinges",
                               "ratio of the speeds by the closed form; energy", CardanJoints);
const SceneEntry kStraightChains("joints", "Straight chains pinned at both ends",
                                 "energy; symmetry of the lists", StraightChains);

}  // namespace
}  // namespace taut::mechanics
