// Construction of cables: attachments, rest lengths, connectivity.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/brief.h"
#include "base/fixed.h"
#include "base/union_find.h"
#include "description/model/build.h"
#include "description/model/cable_shape.h"
#include "description/model/members.h"
#include "description/yaml/once.h"
#include "math/angle.h"
#include "math/vec.h"
#include "taut/statics.h"

namespace taut::description {
namespace {

std::string Number(double value) { return base::Brief(value, 6); }

class CableMaker {
 public:
  CableMaker(const ModelText& model, const Assembly& assembly, const Assignment& assignment,
             const BodyOfNode& body_of_node, RobotSpec& robot, Diagnostics& out)
      : model_(model),
        assembly_(assembly),
        assignment_(assignment),
        body_of_node_(body_of_node),
        robot_(robot),
        out_(out),
        once_(out) {}

  void Run() {
    for (std::size_t pair = 0; pair < assembly_.pairs.size(); ++pair) {
      const int b = assignment_.of_pair[pair];
      if (b < 0) continue;
      const std::optional<CableText>& cable = model_.builders[b].cable;
      if (cable) Make(assembly_.pairs[pair], *cable);
    }
  }

 private:
  void Make(const PlacedPair& pair, const CableText& builder) {
    CableDef cable = builder;
    cable.name = pair.name;
    if (!builder.own_damping_law) cable.damping_law = model_.damping_law;
    ShapeCable({model_, assembly_, assignment_, &body_of_node_}, pair, builder, cable, once_);
    if (cable.touches == CableTouches::kRods || cable.touches == CableTouches::kAll) {
      CheckEnds(pair, cable);
    }
    if (cable.touches != CableTouches::kNone && cable.attachments.size() > 2) {
      once_("cable.touches_and_runs_over_nodes", pair.at,
            "the cable \"" + pair.name + "\" has `touches`, so it must have exactly two nodes",
            "leave out `touches`, or split the cable at the nodes between its ends");
    }
    CheckMotor(pair, cable);
    if (CheckPath(pair, builder, cable)) SetRestLength(pair, builder, cable);
    robot_.def.cables.push_back(std::move(cable));
    robot_.cable_tags.push_back(pair.tags);
    robot_.cable_sources.push_back(pair.at);
  }

  /// Rejects friction in a cable with a DC motor. Friction divides a cable into spans with
  /// different tensions, which the motor model does not support.
  void CheckMotor(const PlacedPair& pair, const CableDef& cable) {
    if (cable.actuator.kind != ActuatorDef::Kind::kDcMotor) return;
    for (const RouteText& element : pair.route) {
      if (element.friction == 0) continue;
      once_("cable.friction_with_motor", element.at,
            "the cable \"" + pair.name +
                "\" has friction at this element, but a direct-current motor cannot wind a cable "
                "with friction",
            "use `ideal: true` or an actuator with limits");
    }
  }

  /// Rejects a cable that wraps around rods and ends inside a rod of another body.
  void CheckEnds(const PlacedPair& pair, const CableDef& cable) {
    for (const CapsuleDef& rod : robot_.def.capsules) {
      const Vec3 along = rod.to_m - rod.from_m;
      for (const AttachmentDef& at : cable.attachments) {
        if (!rod.collides || at.body == rod.body) continue;
        const double share = Dot(at.position_m - rod.from_m, along) / Dot(along, along);
        const Vec3 off = at.position_m - rod.from_m - std::clamp(share, 0.0, 1.0) * along;
        const double inside_m = rod.radius_m - std::sqrt(Dot(off, off));
        if (!(inside_m > 0)) continue;
        once_("cable.end_inside_rod", pair.at,
              "the cable \"" + pair.name + "\" touches rods, but ends " + Number(1000 * inside_m) +
                  " mm inside the rod \"" + rod.name + "\" of another body",
              "move the end of the cable, or the rod");
      }
    }
  }

  /// Returns whether the cable has a valid length. Reports legs of zero length and cables with both
  /// ends on one body.
  bool CheckPath(const PlacedPair& pair, const CableText&, const CableDef& cable) {
    for (std::size_t i = 1; i < pair.nodes.size(); ++i) {
      const PlacedNode &from = assembly_.nodes[pair.nodes[i - 1]],
                       &to = assembly_.nodes[pair.nodes[i]];
      const Vec3 leg = to.position_m - from.position_m;
      const double length = std::sqrt(Dot(leg, leg));
      if (std::isnan(length)) return false;
      if (length >= kShortestLeg_m) continue;
      once_("cable.no_length", pair.at,
            "the cable \"" + pair.name + "\" has no length between \"" + from.name + "\" and \"" +
                to.name + "\"",
            "move one of these nodes: they are at the same position");
      return false;
    }
    if (std::isnan(CableLength(cable))) return false;
    bool one_body = true;
    for (const AttachmentDef& at : cable.attachments) {
      one_body = one_body && at.body == cable.attachments[0].body;
    }
    if (one_body && model_.builders_complete && assembly_.complete) {
      const int body = cable.attachments[0].body;
      if (body == kWorld && !out_.ok()) return true;  // reported: the node belongs to no body
      once_(
          "cable.both_ends_on_one_body", pair.at,
          "both ends of the cable \"" + pair.name + "\" are on " +
              (body == kWorld ? "the world" : "the body \"" + robot_.def.bodies[body].name + "\"") +
              ", so it has no effect",
          "leave it out, or end it on another body");
    }
    return true;
  }

  /// Returns the length of the whole turns around wheels [m], a lower bound of the cable's length
  /// in any pose.
  static double WoundLength(const PlacedPair& pair) {
    double wound = 0.0;
    for (const RouteText& element : pair.route) {
      if (!element.is_pulley() && !element.is_drum()) continue;
      wound += 2 * kPi * element.radius_m * element.turns;
    }
    return wound;
  }

  void SetRestLength(const PlacedPair& pair, const CableText& builder, CableDef& cable) {
    const double length = CableLength(cable);
    const Elastic elastic = ElasticOf(builder, length);
    cable.rest_length_m = elastic.rest_length_m;
    cable.stiffness_n_per_m = elastic.stiffness_n_per_m;
    cable.member.mass_kg = elastic.mass_kg;
    if (builder.prestress_n && cable.rest_length_m <= 0.0) {
      once_("cable.prestress_too_high", builder.rest_at,
            "cable.prestress_n: " + Number(*builder.prestress_n) + " N would stretch the cable \"" +
                pair.name + "\" by its whole length of " + Number(length) + " m or more",
            "with a stiffness of " + Number(builder.stiffness_n_per_m) + " N/m at most " +
                Number(builder.stiffness_n_per_m * length) + " N");
    }
    const double wound = WoundLength(pair);
    if (cable.rest_length_m > 0.0 && cable.rest_length_m < wound) {
      once_("cable.rest_length_below_wound", builder.rest_at,
            "the cable \"" + pair.name + "\" starts with a rest length of " +
                Number(cable.rest_length_m) + " m, below the " + Number(wound) +
                " m wound around its pulleys and drums",
            "increase the rest length: the whole cable path is " + Number(length) + " m long");
    }
    if (cable.rest_length_m > 0.0 && cable.rest_length_m < cable.actuator.min_rest_length_m) {
      once_("cable.rest_length_below_min", builder.rest_at,
            "the cable \"" + pair.name + "\" starts with a rest length of " +
                Number(cable.rest_length_m) + " m, below its min_rest_length_m of " +
                Number(cable.actuator.min_rest_length_m) + " m");
    }
  }

  const ModelText& model_;
  const Assembly& assembly_;
  const Assignment& assignment_;
  const BodyOfNode& body_of_node_;
  RobotSpec& robot_;
  Diagnostics& out_;
  OncePerPlace once_;
};

}  // namespace

void BuildCables(const ModelText& model, const Assembly& assembly, const Assignment& assignment,
                 const BodyOfNode& body_of_node, RobotSpec& robot, Diagnostics& out) {
  CableMaker(model, assembly, assignment, body_of_node, robot, out).Run();
}

void CheckConnected(const RobotSpec& robot, Diagnostics& out) {
  const std::vector<BodyDef>& bodies = robot.def.bodies;
  const int world = static_cast<int>(bodies.size());  // index for all bodies fixed in the world
  base::UnionFind sets(bodies.size() + 1);
  const auto index = [&](int body) { return base::IsFixed(robot.def, body) ? world : body; };
  for (const CableDef& cable : robot.def.cables) {
    for (const AttachmentDef& at : cable.attachments) {
      sets.Join(index(cable.attachments[0].body), index(at.body));
    }
  }
  for (const JointDef& joint : robot.def.joints) {
    sets.Join(index(joint.body_a), index(joint.body_b));
  }
  // The set that contains the first moving body is the robot.
  int robot_set = -1;
  std::set<int> reported;
  for (int body = 0; body < world; ++body) {
    if (bodies[body].fixed) continue;
    const int set = sets.Root(body);
    if (robot_set < 0) robot_set = set;
    if (set == robot_set || !reported.insert(set).second) continue;
    out.Error("body.not_connected", robot.body_sources[body],
              "no cable or joint connects the body \"" + bodies[body].name + "\" to \"" +
                  bodies[robot_set].name + "\"",
              "if this is intended, write `allow_disconnected: true`");
  }
}

}  // namespace taut::description
