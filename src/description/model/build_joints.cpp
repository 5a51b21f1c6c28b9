// Construction of joints, supports and bars.
#include <algorithm>
#include <cmath>
#include <set>

#include "base/brief.h"
#include "base/fixed.h"
#include "base/union_find.h"
#include "description/model/build.h"
#include "description/model/members.h"
#include "description/yaml/laws.h"
#include "description/yaml/once.h"
#include "math/joint_turn.h"
#include "math/vec.h"

namespace taut::description {
namespace {

/// Tolerance of joint limits in the described pose [rad or m]: a robot at rest against a limit
/// exceeds it slightly.
constexpr double kPassed = 1e-3;

class JointMaker {
 public:
  JointMaker(const ModelText& model, const Assembly& assembly, const Assignment& assignment,
             const BodyOfNode& body_of_node, RobotSpec& robot, Diagnostics& out)
      : model_(model),
        assembly_(assembly),
        assignment_(assignment),
        body_of_node_(body_of_node),
        robot_(robot),
        out_(out),
        once_(out) {}

  void Run() {
    robot_.joint_tags.resize(robot_.def.joints.size());
    for (const JointDef& pin : robot_.def.joints) names_.insert(pin.name);
    for (std::size_t pair = 0; pair < assembly_.pairs.size(); ++pair) {
      const int b = assignment_.of_pair[pair];
      if (b < 0) continue;
      const BuilderText& builder = model_.builders[b];
      if (builder.joint)
        Between(assembly_.pairs[pair], "joint", In(assembly_.pairs[pair].instance, *builder.joint));
      if (builder.bar) Bar(assembly_.pairs[pair], *builder.bar);
    }
    for (std::size_t node = 0; node < assembly_.nodes.size(); ++node) {
      for (const int b : assignment_.of_node[node]) {
        if (model_.builders[b].support)
          Support(static_cast<int>(node), *model_.builders[b].support);
      }
    }
    RefusePassedStops();
    RefuseRedundantWelds();
    Apart();
  }

 private:
  /// Returns the joint of a builder, with directions rotated from the part's frame to W.
  JointDef In(int instance, const JointText& text) const {
    JointDef joint = text;
    if (instance < 0) return joint;
    const Quat& q_WPart = assembly_.instances[instance].q_WPart;
    joint.axis = Rotate(q_WPart, text.axis);
    const bool is_turned = text.turned.x != 0 || text.turned.y != 0 || text.turned.z != 0;
    if (is_turned) joint.turned = q_WPart * text.turned * Conjugate(q_WPart);
    return joint;
  }
  bool IsFixed(int body) const { return base::IsFixed(robot_.def, body); }

  /// Adds a bar: a distance joint with a spring. Unlike other joints, it does not disable
  /// collisions between its bodies.
  void Bar(const PlacedPair& pair, const BarText& text) {
    const auto at = [&](int node) { return assembly_.nodes[node].position_m; };
    const Vec3 along = at(pair.nodes.back()) - at(pair.nodes.front());
    const double length_m = std::sqrt(Dot(along, along));
    const Elastic elastic = ElasticOf(text, length_m);
    const bool has_length = elastic.rest_length_m > 0 && std::isfinite(elastic.rest_length_m);
    if (text.prestress_n && !has_length && length_m > 0 && !std::isnan(elastic.rest_length_m)) {
      once_("bar.prestress_too_high", text.rest_at,
            "bar.prestress_n: " + base::Brief(*text.prestress_n) + " N would " +
                (*text.prestress_n > 0 ? "stretch" : "compress") + " the bar \"" + pair.name +
                (*text.prestress_n > 0
                     ? "\" by its whole length of " + base::Brief(length_m) + " m or more"
                     : "\" to zero length"),
            "check its stiffness");
      return;
    }
    JointDef joint;
    joint.kind = JointKind::kDistance;
    joint.collides = true;
    joint.stiffness = elastic.stiffness_n_per_m, joint.damping = text.damping_n_s_per_m;
    joint.rest = elastic.rest_length_m;
    joint.member = text.member;
    joint.member.mass_kg = elastic.mass_kg;
    if (joint.member.second_moment_m4 > 0 && joint.member.buckling_length_m == 0) {
      joint.member.buckling_length_m = joint.rest;
    }
    Between(pair, "bar", std::move(joint));
  }

  void Between(const PlacedPair& pair, const char* kind, JointDef joint) {
    if (pair.nodes.size() != 2) {
      once_("pair.two_nodes_needed", pair.at,
            std::string("a ") + kind + " needs two nodes, but \"" + pair.name + "\" has " +
                std::to_string(pair.nodes.size()));
      return;
    }
    joint.name = pair.name;
    const auto set = [&](int node, int& body, Vec3& point) {
      body = body_of_node_[node];
      point = assembly_.nodes[node].position_m;
    };
    set(pair.nodes[0], joint.body_a, joint.from_m);
    set(pair.nodes[1], joint.body_b, joint.to_m);
    if (joint.body_b == kWorld) {
      std::swap(joint.body_a, joint.body_b);
      std::swap(joint.from_m, joint.to_m);
    }
    Add(pair.at, kind, pair.tags, std::move(joint));
  }

  void Support(int node, const JointText& text) {
    const PlacedNode& placed = assembly_.nodes[node];
    JointDef joint = In(placed.instance, text);
    joint.name = placed.name;
    joint.body_a = kWorld, joint.body_b = body_of_node_[node];
    joint.from_m = joint.to_m = placed.position_m;
    if (joint.kind == JointKind::kDistance) {
      once_("support.distance_needs_two_points", placed.at,
            "a support cannot be of the kind distance, because it has only one point",
            "use a joint on a pair with a node of the world");
      return;
    }
    Add(placed.at, "joint", placed.tags, std::move(joint));
  }

  void Add(const SourceRef& at, const std::string& kind, const Tags& tags, JointDef joint) {
    const std::string called = "the " + kind + " \"" + joint.name + "\"";
    const bool known = model_.builders_complete && assembly_.complete;
    const auto told = [&](const Diagnostic& other) {
      return other.at.line == at.line && other.at.column == at.column;
    };
    if (joint.body_b == kWorld && std::any_of(out_.items().begin(), out_.items().end(), told)) {
      return;  // already reported: the node belongs to no body
    }
    if (kind == "bar" && joint.body_b == kWorld && !out_.ok()) return;  // reported: no mass
    if (known && joint.body_a == joint.body_b) {
      once_("joint.one_body", at,
            called + " connects the body \"" +
                (joint.body_b == kWorld ? "world" : robot_.def.bodies[joint.body_b].name) +
                "\" to itself",
            "use nodes of two different bodies; solids that share a node are one body");
      return;
    }
    if (known && IsFixed(joint.body_a) && IsFixed(joint.body_b)) {
      once_("joint.both_ends_fixed", at,
            called + " connects two bodies that are fixed in the world, so it has no effect",
            "leave it out, or one of the anchors");
      return;
    }
    const double gap = JointError(joint);
    if (gap > JointDef::kClosed_m) {
      once_("joint.gap", at,
            "the nodes of " + called + " are " + base::Brief(gap, 3) +
                " m apart in a direction that the joint locks",
            joint.kind == JointKind::kBall ? "place them at the same position"
                                           : "move the nodes, or change the joint's kind or axis");
      return;
    }
    const Vec3 apart = joint.to_m - joint.from_m;
    if (joint.kind == JointKind::kDistance && Dot(apart, apart) == 0) {
      once_("joint.no_length", at, "the nodes of " + called + " are at the same position",
            kind == "bar" ? "move one of them: a bar needs a length"
                          : "move one of them, or use a ball joint");
      return;
    }
    if (math::HeldTurn(joint) > math::kClosedTurn_rad) {
      once_("joint.turned_wrongly", at, called + " does not leave the rotation in `turned` free",
            "hinge, cylindrical and planar joints allow rotation about the axis only, weld and "
            "prismatic joints allow none");
      return;
    }
    if (!names_.insert(joint.name).second) {
      once_("joint.duplicate_name", at, "two joints have the name \"" + joint.name + "\"",
            "give one of the pairs another `name:`; a support has the name of its node");
      return;
    }
    sources_.push_back(at);
    robot_.joint_tags.push_back(tags);
    robot_.def.joints.push_back(std::move(joint));
  }

  /// Calls `use` for all joints of builders, but not for the pins of `class_k` rods.
  template <class F>
  void EachJoint(const F& use) const {
    const std::vector<JointDef>& joints = robot_.def.joints;
    const std::size_t first = joints.size() - sources_.size();
    for (std::size_t i = 0; i < sources_.size(); ++i) use(joints[first + i], sources_[i]);
  }

  /// Returns the coordinate of a joint in the described pose [rad or m]; of a hinge, within one
  /// turn.
  static double Coordinate(const JointDef& j) {
    const Vec3 d = j.to_m - j.from_m;
    switch (j.kind) {
      case JointKind::kDistance:
        return std::sqrt(Dot(d, d));
      case JointKind::kHinge:
        return 2 * std::atan2(Dot(j.axis, {j.turned.x, j.turned.y, j.turned.z}), j.turned.w);
      case JointKind::kBall:
        return std::acos(std::clamp(Dot(j.axis, Rotate(j.turned, j.axis)), -1.0, 1.0));
      default:
        return Dot(j.axis, d);
    }
  }

  /// Reports joints beyond a limit in the described pose. The limit would not push them back.
  void RefusePassedStops() {
    if (!out_.ok()) return;  // invalid limits are already reported
    EachJoint([&](const JointDef& j, const SourceRef& at) {
      const double now = Coordinate(j);
      const double beyond = std::max(j.least ? *j.least - now : 0, j.most ? now - *j.most : 0);
      if (!(beyond > kPassed)) return;
      once_("joint.outside_stops", at,
            "the joint \"" + j.name + "\" is " + base::Brief(beyond) +
                (IsAngle(j.kind) ? " rad" : " m") + " beyond its limit in the described pose",
            "change the described pose or the limit");
    });
  }

  /// Reports welds and joints between bodies that other welds already connect.
  void RefuseRedundantWelds() {
    const std::size_t world = robot_.def.bodies.size();
    base::UnionFind welded(world + 1);
    const auto place = [&](int body) { return IsFixed(body) ? static_cast<int>(world) : body; };
    const auto together = [&](const JointDef& j) {
      return welded.Root(place(j.body_a)) == welded.Root(place(j.body_b));
    };
    EachJoint([&](const JointDef& j, const SourceRef& at) {
      if (j.kind != JointKind::kWeld) return;
      if (together(j)) {
        once_("joint.redundant_weld", at,
              "the weld \"" + j.name + "\" is redundant: other welds hold its bodies together",
              "leave it out");
      }
      welded.Join(place(j.body_a), place(j.body_b));
    });
    EachJoint([&](const JointDef& j, const SourceRef& at) {
      if (j.kind == JointKind::kWeld || !together(j)) return;
      once_("joint.without_effect", at,
            "the joint \"" + j.name + "\" has no effect: welds hold its bodies together",
            "leave it out, or one of the welds");
    });
  }

  void Apart() {
    const std::vector<BodyDef>& bodies = robot_.def.bodies;
    std::vector<std::string> names;
    for (const BodyDef& body : bodies) names.push_back(body.name);
    for (const std::vector<std::string>& list : model_.apart) {
      std::vector<int> found;
      if (list.size() < 2) {
        out_.Error("apart.single_body", model_.apart_at,
                   "apart: \"" + list[0] + "\" is the only body in its list",
                   "list two or more bodies: [[a, b]]");
      }
      for (const std::string& name : list) {
        const auto at = std::find(names.begin(), names.end(), name);
        if (at == names.end()) {
          out_.Error("apart.unknown_body", model_.apart_at,
                     "apart: there is no body \"" + name + "\"", NameHint(name, names));
          continue;
        }
        if (std::find(found.begin(), found.end(), at - names.begin()) != found.end()) {
          out_.Error("apart.duplicate_body", model_.apart_at,
                     "apart: \"" + name + "\" is in one list twice");
          continue;
        }
        for (const int other : found) {
          robot_.def.apart.push_back({other, static_cast<int>(at - names.begin())});
        }
        found.push_back(static_cast<int>(at - names.begin()));
      }
    }
  }

  const ModelText& model_;
  const Assembly& assembly_;
  const Assignment& assignment_;
  const BodyOfNode& body_of_node_;
  RobotSpec& robot_;
  Diagnostics& out_;
  OncePerPlace once_;
  std::set<std::string> names_;
  std::vector<SourceRef> sources_;  ///< Source positions of the joints of builders, the last
                                    ///< elements of `joints`.
};

}  // namespace

void BuildJoints(const ModelText& model, const Assembly& assembly, const Assignment& assignment,
                 const BodyOfNode& body_of_node, RobotSpec& robot, Diagnostics& out) {
  JointMaker(model, assembly, assignment, body_of_node, robot, out).Run();
}

}  // namespace taut::description
