/// Several bodies on joints: kinematic loops, nets, redundant rows, chains.

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/constants.h"
#include "tests/mechanics/energy_range.h"
#include "tests/mechanics/known_scene.h"
#include "tests/physics/world.h"
#include "tests/scenes/rod.h"

namespace taut::mechanics {
namespace {

using test::Distance;
using test::EnergyOf;
using test::MakeBatch;
using test::StepsIn;

/// Rods between nodes: at each node all rods are joined to the first rod.
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
  /// Adds a cable between two nodes, shorter by a hundredth than their distance.
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

/// Returns the same model with bodies and joints in the opposite order, and the two bodies of each
/// joint exchanged.
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

/// Returns the largest distance between a body of one world and the same body of the other.
double WorstDistance(const WorldBatch& one, const WorldBatch& reversed) {
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
  WorldBatch world = MakeBatch(net.def), reversed = MakeBatch(Reversed(net.def));
  const double energy = EnergyOf(world);
  const Vec3 momentum = world.AngularMomentum(0);
  const double time_s = report.IsFull() ? 5 : 2;
  const EnergyRange seen = Run(world, 1e-3, time_s);
  reversed.Step(1e-3, StepsIn(time_s, 1e-3));
  report.AtMost(name + ": error of the energy", "relative", seen.Off() / energy, bound);
  report.AtMost(name + ": error of the angular momentum", "relative",
                Distance(world.AngularMomentum(0), momentum) / test::Norm(momentum), 1e-12);
  report.AtMost(name + ": steps with a warning (status bit)", "1", seen.flagged, 0);
  report.AtMost(name + ": largest gap", "m", seen.gap_m, 1e-10);
  report.AtMost(name + ": largest change of a position if bodies and joints are listed in reverse",
                "m", WorstDistance(world, reversed), 1e-8);
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

/// Bounds for a net: converged, without energy gain, for any order of its lists.
struct NetBounds {
  double gain_j, gap_m, order_m;
  bool may_be_flagged;  ///< Too stiff for the step.
};

void ReportNet(Report& report, const std::string& name, const ModelDef& def, double step_s,
               double time_s, const NetBounds& bounds) {
  WorldBatch world = MakeBatch(def), reversed = MakeBatch(Reversed(def));
  const EnergyRange seen = Run(world, step_s, time_s);
  reversed.Step(step_s, StepsIn(time_s, step_s));
  report.AtMost(name + ": steps without a solution", "1", seen.unsolved, 0);
  if (!bounds.may_be_flagged) {
    report.AtMost(name + ": steps with a warning (status bit)", "1", seen.flagged, 0);
  }
  report.AtMost(name + ": energy gained", "J", seen.gain_j, bounds.gain_j);
  report.AtMost(name + ": largest gap", "m", seen.gap_m, bounds.gap_m);
  report.AtMost(name + ": largest change of a position if bodies and joints are listed in reverse",
                "m", WorstDistance(world, reversed), bounds.order_m);
}

void RedundantRows(Report& report) {
  {
    // Both ends of the second rod are fixed, so its length is constrained twice.
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

/// Returns a net of `n` by `n` squares of class-k nodes, pinned at its corners, with a cable across
/// each.
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
}

/// Returns a cardan joint: two shafts whose axes differ by `angle_rad`, and a cross with two hinges
/// on each arm. 30 rows act on 3 bodies with one degree of freedom: 13 of them are redundant.
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
  WorldBatch world = MakeBatch(CardanJoint(angle_rad, 10));
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
  report.AtMost("error of the ratio of the shafts' speeds, 1 rad, 1 ms", "1", ratio_off, 5e-5);
  report.AtMost("error of the energy", "relative", off / start, 1e-5);
  // The shafts exchange 0.05 J and rotate by 1 rad in 0.1 s: torques of some 0.1 N m on arms of
  // 0.02 m.
  report.AtMost("largest force of a joint", "N", force_n, 10);
  report.AtMost("steps with a warning (status bit)", "1", flagged, 0);
}

/// Returns rods in a straight line between two pins: the rows are dependent, and with the small sag
/// the tension is a thousand times the weight.
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
    WorldBatch coarse = MakeBatch(StraightChain(rods));
    report.AtMost(name + ", 1 ms: steps without a solution", "1", Run(coarse, 1e-3, 1).unsolved, 0);
    ReportNet(report, name + ", 0.25 ms", StraightChain(rods), 2.5e-4, 1,
              {1e-6, 1e-8, 1e-6, false});
  }
}

/// Returns rods in a zigzag with a cable over each joint, between two pins or free and tumbling.
ModelDef TiedChain(int rods, double stiffness_n_per_m, bool is_free) {
  std::vector<Vec3> nodes;
  for (int i = 0; i <= rods; ++i) {
    nodes.push_back({0.15 * i, 0.05 * (i % 2), 1 + 0.06 * ((2 * i) % 3)});
  }
  RodNet net(nodes);
  for (int i = 0; i < rods; ++i) net.AddRod(i, i + 1);
  net.JoinAll();
  if (!is_free) net.Pin(0), net.Pin(rods);
  for (int i = 0; i + 2 <= rods; ++i) net.Tie(i, i + 2, stiffness_n_per_m);
  if (is_free) Tumble(net.def);
  return net.def;
}

/// Stiff tight cables between jointed rods, at a step that does not resolve their vibrations.
void StiffCablesOnJoints(Report& report) {
  const struct {
    const char* name;
    ModelDef def;
    bool is_free;
  } scenes[] = {{"2 by 2 squares", Net(2, 1e6), false},
                {"chain of 5 rods between two pins", TiedChain(5, 1e6, false), false},
                {"free chain of 5 rods", TiedChain(5, 1e6, true), true}};
  for (const auto& scene : scenes) {
    for (const double damping_n_s_per_m : {2.0, 0.0}) {
      for (const double step_s : {1e-3, 4e-3}) {
        if (!report.IsFull() && step_s > 1e-3) continue;
        ModelDef def = scene.def;
        for (CableDef& cable : def.cables) cable.damping_n_s_per_m = damping_n_s_per_m;
        WorldBatch world = MakeBatch(def);
        const double start = EnergyOf(world);
        const Vec3 momentum = world.AngularMomentum(0);
        const EnergyRange seen = Run(world, step_s, report.IsFull() ? 3 : 0.3);
        const std::string what = std::string(scene.name) + ", 1e6 N/m, " +
                                 std::to_string(static_cast<int>(damping_n_s_per_m)) + " N s/m, " +
                                 std::to_string(static_cast<int>(1e3 * step_s)) + " ms: ";
        report.AtMost(what + "energy gained", "relative", seen.gain_j / start, 1e-6);
        report.AtMost(what + "steps with a warning (status bit)", "1", seen.flagged, 0);
        report.AtMost(what + "largest gap", "m", seen.gap_m, 1e-6);
        if (!scene.is_free) continue;
        report.AtMost(what + "error of the angular momentum", "relative",
                      Distance(world.AngularMomentum(0), momentum) / test::Norm(momentum), 1e-9);
      }
    }
  }
}

const SceneEntry kStiffCables("joints", "Stiff cables between jointed rods",
                              "energy does not increase, angular momentum is conserved",
                              StiffCablesOnJoints);
const SceneEntry kTumblingFrames("joints", "Frames of rods that tumble",
                                 "energy and angular momentum", TumblingFrames);
const SceneEntry kRedundantRows("joints", "Rods with redundant rows",
                                "energy; independence of the order of bodies and joints",
                                RedundantRows);
const SceneEntry kNets("joints", "Nets of rods, pinned at their corners",
                       "energy; independence of the order of bodies and joints", Nets);
const SceneEntry kCardanJoints("joints", "Cardan joint with redundant hinges",
                               "ratio of the speeds by the closed form; energy", CardanJoints);
const SceneEntry kStraightChains("joints", "Straight chains pinned at both ends",
                                 "energy; independence of the order of bodies and joints",
                                 StraightChains);

}  // namespace
}  // namespace taut::mechanics
