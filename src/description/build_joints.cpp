#include <algorithm>
#include <cmath>
#include <set>

#include "base/fixed.h"
#include "description/build.h"
#include "description/laws.h"
#include "description/once.h"
#include "math/vec.h"

namespace taut::description {
namespace {

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
    for (const JointDef& pin : robot_.def.joints) names_.insert(pin.name);
    for (std::size_t pair = 0; pair < assembly_.pairs.size(); ++pair) {
      const int b = assignment_.of_pair[pair];
      if (b >= 0 && model_.builders[b].joint)
        Between(assembly_.pairs[pair], *model_.builders[b].joint);
    }
    for (std::size_t node = 0; node < assembly_.nodes.size(); ++node) {
      for (const int b : assignment_.of_node[node]) {
        if (model_.builders[b].support)
          Support(static_cast<int>(node), *model_.builders[b].support);
      }
    }
    Apart();
  }

 private:
  Vec3 AxisIn(int instance, const Vec3& axis) const {
    return instance < 0 ? axis : Rotate(assembly_.instances[instance].q_WPart, axis);
  }
  bool IsFixed(int body) const { return base::IsFixed(robot_.def, body); }

  void Between(const PlacedPair& pair, const JointText& text) {
    if (pair.nodes.size() != 2) {
      once_(pair.at, "a joint has two nodes, \"" + pair.name + "\" has " +
                         std::to_string(pair.nodes.size()));
      return;
    }
    JointDef joint = text;
    joint.name = pair.name;
    joint.axis = AxisIn(pair.instance, text.axis);
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
    Add(pair.at, std::move(joint));
  }

  void Support(int node, const JointText& text) {
    const PlacedNode& placed = assembly_.nodes[node];
    JointDef joint = text;
    joint.name = placed.name;
    joint.axis = AxisIn(placed.instance, text.axis);
    joint.body_a = kWorld, joint.body_b = body_of_node_[node];
    joint.from_m = joint.to_m = placed.position_m;
    if (joint.kind == JointKind::kDistance) {
      once_(placed.at, "a support of the kind distance has no second point",
            "join the node to one in the world: a pair with a joint");
      return;
    }
    Add(placed.at, std::move(joint));
  }

  void Add(const SourceRef& at, JointDef joint) {
    const bool known = model_.builders_complete && assembly_.complete;
    if (known && joint.body_a == joint.body_b) {
      once_(at,
            "the joint \"" + joint.name + "\" joins the body \"" +
                (joint.body_b == kWorld ? "world" : robot_.def.bodies[joint.body_b].name) +
                "\" to itself",
            "each of its nodes belongs to a body of its own; nodes that solids share weld them");
      return;
    }
    if (known && IsFixed(joint.body_a) && IsFixed(joint.body_b)) {
      once_(at, "the joint \"" + joint.name + "\" joins two things that do not move");
      return;
    }
    const double gap = HeldGap(joint);
    if (gap > JointDef::kClosed_m) {
      char text[32];
      std::snprintf(text, sizeof text, "%.3g m", gap);
      once_(at,
            "the nodes of the joint \"" + joint.name + "\" are " + text +
                " apart where it holds them together",
            joint.kind == JointKind::kBall ? "put them in one place" : "see its kind and axis");
      return;
    }
    if (!names_.insert(joint.name).second) {
      once_(at, "two joints would be called \"" + joint.name + "\"",
            "a pair has the name that its `name:` says, a support that of its node");
      return;
    }
    robot_.def.joints.push_back(std::move(joint));
  }

  void Apart() {
    const std::vector<BodyDef>& bodies = robot_.def.bodies;
    std::vector<std::string> names;
    for (const BodyDef& body : bodies) names.push_back(body.name);
    for (const std::vector<std::string>& list : model_.apart) {
      std::vector<int> found;
      for (const std::string& name : list) {
        const auto at = std::find(names.begin(), names.end(), name);
        if (at == names.end()) {
          out_.Error(model_.apart_at, "apart: there is no body \"" + name + "\"",
                     NameHint(name, names));
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
};

}  // namespace
}  // namespace taut::description

namespace taut {

std::string JointKindName(JointKind kind) {
  for (const auto& [name, value] : description::kJointKinds) {
    if (value == kind) return name;
  }
  return {};
}

}  // namespace taut

namespace taut::description {

void BuildJoints(const ModelText& model, const Assembly& assembly, const Assignment& assignment,
                 const BodyOfNode& body_of_node, RobotSpec& robot, Diagnostics& out) {
  JointMaker(model, assembly, assignment, body_of_node, robot, out).Run();
}

}  // namespace taut::description
