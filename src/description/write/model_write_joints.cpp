// Joints and supports as builders of a model file.
#include <algorithm>
#include <cmath>

#include "description/model/member_keys.h"
#include "description/write/model_write.h"
#include "description/yaml/write_keys.h"
#include "math/vec.h"

namespace taut::description {
namespace {

/// Largest distance at which both points of a support count as one node. A larger distance means
/// that the support has moved.
constexpr double kTogether_m = 1e-9;

bool IsOne(const Quat& q) { return q.w == 1 && q.x == 0 && q.y == 0 && q.z == 0; }

class JointTaker {
 public:
  JointTaker(const RobotSpec& robot, WrittenModel& model, Diagnostics& out)
      : robot_(robot), def_(robot.def), m_(model), out_(out) {}

  void Run() {
    for (std::size_t j = 0; j < def_.joints.size(); ++j) {
      if (m_.pins.contains(static_cast<int>(j))) continue;
      Take(def_.joints[j], j < robot_.joint_tags.size() ? robot_.joint_tags[j] : Tags{});
    }
    Apart();
  }

 private:
  const WrittenNode& Node(int n) const { return m_.nodes[static_cast<std::size_t>(n)]; }

  void Take(const JointDef& joint, const Tags& tags) {
    const int on = NodeAt(m_, joint.body_b, joint.to_m);
    const Vec3 slide = joint.to_m - joint.from_m;
    const bool is_support = on >= 0 && joint.body_a == kWorld && Node(on).name == joint.name;
    if (is_support && std::sqrt(Dot(slide, slide)) < kTogether_m) {
      Build(m_.on_nodes, "support: " + Text(joint, PlacementOf(joint.name)), on);
      return;
    }
    const int there = NodeAt(m_, joint.body_a, joint.from_m);
    const int from = there < 0 && is_support ? GroundOf(joint) : there;
    if (from < 0 || on < 0) {
      RefuseModel(out_, "the joint \"" + joint.name + "\" is not between nodes",
                  "give both of its bodies a node at the joint");
      return;
    }
    const bool is_bar = IsBar(joint) && joint.collides && !MemberText(joint.member).empty();
    m_.pairs.push_back({joint.name, is_bar ? tags : Tags{}, {from, on}, {}, {}, false});
    if (is_bar) {
      Build(m_.on_pairs,
            "bar: {stiffness_n_per_m: " + Shown(joint.stiffness) +
                ", damping_n_s_per_m: " + Shown(joint.damping) +
                ", rest_length_m: " + Shown(joint.rest) + MemberText(joint.member) + "}",
            static_cast<int>(m_.pairs.size()) - 1);
      return;
    }
    Build(m_.on_pairs, "joint: " + Text(joint, NameOf(m_, m_.pairs.back()).placement),
          static_cast<int>(m_.pairs.size()) - 1);
  }

  /// Adds a node of the world at the initial position of a support that has moved. Returns -1 after
  /// an error.
  int GroundOf(const JointDef& support) {
    const std::string name = support.name + "_from";
    const auto taken = std::find_if(m_.nodes.begin(), m_.nodes.end(),
                                    [&](const WrittenNode& n) { return n.name == name; });
    if (taken != m_.nodes.end()) {
      RefuseModel(out_, "the support \"" + support.name + "\" has moved, and the name \"" + name +
                            "\" for the node at its initial position is already used");
      return -1;
    }
    m_.nodes.push_back({name, kWorld, support.from_m, {}, -1});
    const int node = static_cast<int>(m_.nodes.size()) - 1;
    Build(m_.on_nodes, "anchor: {}", node);
    return node;
  }

  /// Returns the YAML map of a joint, without keys that have default values. Keys are named as for
  /// the joint's kind (`least_rad` or `least_m`); directions are in the part's frame.
  std::string Text(const JointDef& joint, const std::string& placement) const {
    const auto found = m_.turns.find(placement);
    const Quat turn = found == m_.turns.end() ? Quat{} : found->second;
    const auto kind = std::find_if(kJointKinds.begin(), kJointKinds.end(),
                                   [&](const auto& choice) { return choice.second == joint.kind; });
    std::string text = "{kind: " + kind->first;
    const auto add = [&](const std::string& key, const std::string& value) {
      text += ", " + key + ": " + value;
    };
    const JointDef plain;
    const bool is_angle = IsAngle(joint.kind);
    const auto number = [&](const char* of_angle, const char* of_length, double value,
                            double if_absent) {
      if (value != if_absent) add(is_angle ? of_angle : of_length, Shown(value));
    };
    const Vec3 axis = IsOne(turn) ? joint.axis : Rotate(Conjugate(turn), joint.axis);
    const Vec3& usual = plain.axis;
    if (axis.x != usual.x || axis.y != usual.y || axis.z != usual.z) {
      add("axis", FlowWriter<false>::Text(axis));
    }
    if (!IsOne(joint.turned)) {
      const Quat q = IsOne(turn) ? joint.turned : Conjugate(turn) * joint.turned * turn;
      add("turned", "{quaternion: " + FlowWriter<false>::Text(q) + "}");
    }
    if (joint.least) add(is_angle ? "least_rad" : "least_m", Shown(*joint.least));
    if (joint.most) add(is_angle ? "most_rad" : "most_m", Shown(*joint.most));
    number("restitution", "restitution", joint.restitution, plain.restitution);
    number("friction_n_m", "friction_n", joint.friction, plain.friction);
    number("stiffness_n_m_per_rad", "stiffness_n_per_m", joint.stiffness, plain.stiffness);
    number("damping_n_m_s_per_rad", "damping_n_s_per_m", joint.damping, plain.damping);
    number("rest_rad", "rest_m", joint.rest, plain.rest);
    if (joint.collides) add("collides", "true");
    return text + "}";
  }

  /// Adds `apart`. Rods pinned to the same node are excluded, since they never collide.
  void Apart() {
    std::set<std::pair<int, int>> told;
    for (const int pin : m_.pins) {
      const JointDef& one = def_.joints[static_cast<std::size_t>(pin)];
      for (const int other_pin : m_.pins) {
        const JointDef& other = def_.joints[static_cast<std::size_t>(other_pin)];
        const Vec3 &p = one.from_m, &q = other.from_m;
        if (one.body_a == other.body_a && p.x == q.x && p.y == q.y && p.z == q.z) {
          told.insert(std::minmax(one.body_b, other.body_b));
        }
      }
    }
    for (const ApartDef& pair : def_.apart) {
      if (!told.insert(std::minmax(pair.body_a, pair.body_b)).second) continue;
      m_.apart.push_back({def_.bodies[static_cast<std::size_t>(pair.body_a)].name,
                          def_.bodies[static_cast<std::size_t>(pair.body_b)].name});
    }
  }

  const RobotSpec& robot_;
  const ModelDef& def_;
  WrittenModel& m_;
  Diagnostics& out_;
};

}  // namespace

std::string MemberText(const MemberDef& member) {
  FlowWriter<true> writer;
  MemberKeys(writer, member, MemberOf::kBar);
  return writer.text().empty() ? "" : ", " + writer.text();
}

double LumpedOn(const ModelDef& def, int body) {
  double lumps_kg = 0;
  const auto add = [&](const MemberDef& member, int a, int b) {
    lumps_kg += 0.5 * member.mass_kg * ((a == body) + (b == body));
  };
  for (const JointDef& bar : def.joints) add(bar.member, bar.body_a, bar.body_b);
  for (const CableDef& cable : def.cables) {
    add(cable.member, cable.attachments.front().body, cable.attachments.back().body);
  }
  return lumps_kg;
}

void TakeJoints(const RobotSpec& robot, WrittenModel& model, Diagnostics& out) {
  JointTaker(robot, model, out).Run();
}

}  // namespace taut::description
