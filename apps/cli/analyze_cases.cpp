// Load cases of `taut analyze`: equilibrium and member forces under each.
#include <algorithm>
#include <cmath>

#include "analyze_names.h"
#include "analyze_report.h"

namespace taut::cli {
namespace {

constexpr double kBears_m =
    1e-6;  ///< Distance from the ground within which a point can carry load.

bool IsFixed(const ModelDef& def, int body) {
  return body == kWorld || def.bodies[static_cast<std::size_t>(body)].fixed;
}

Vec3 Scaled(const Vec3& a, double factor) { return {factor * a.x, factor * a.y, factor * a.z}; }

MemberForces Forces(const ModelDef& def, const LoadCaseSpec& loads, const Equilibrium& at,
                    std::vector<Reaction>& anchors) {
  std::vector<BodyForce> forces = ForcesUnder(def, at.cable_tension_n, at.joint_loads);
  for (const ContactState& contact : at.contacts) {
    forces.push_back({contact.body_a, contact.point_m, contact.force_n, {}});
  }
  for (const LoadCaseSpec::NodeForce& load : loads.forces) {
    const NodeDef& node = def.nodes[static_cast<std::size_t>(load.node)];
    if (node.body != kWorld) forces.push_back({node.body, node.position_m, load.force_n, {}});
  }
  ModelDef weighed = def;
  weighed.gravity_m_per_s2 = Scaled(weighed.gravity_m_per_s2, loads.GravityFactor());
  anchors = AnchorReactions(weighed, forces);
  return {at.cable_tension_n, at.bar_force_n, StrutForces(weighed, forces)};
}

/// Returns the forces of the world on cables that end at points of the world, one force per point.
std::vector<CaseResult::End> Ends(const ModelDef& def, const Equilibrium& at) {
  const auto same = [](const Vec3& a, const Vec3& b) {
    return std::fabs(a.x - b.x) + std::fabs(a.y - b.y) + std::fabs(a.z - b.z) < 1e-9;
  };
  std::vector<CaseResult::End> ends;
  for (const BodyForce& force : ForcesUnder(def, at.cable_tension_n, {})) {
    if (force.body != kWorld) continue;
    auto end = std::find_if(ends.begin(), ends.end(), [&](const CaseResult::End& e) {
      return same(e.point_m, force.point_m);
    });
    if (end == ends.end()) {
      const auto node = std::find_if(def.nodes.begin(), def.nodes.end(), [&](const NodeDef& n) {
        return n.body == kWorld && same(n.position_m, force.point_m);
      });
      ends.push_back({node == def.nodes.end() ? "world" : node->name, force.point_m, {}});
      end = ends.end() - 1;
    }
    end->force_n.x -= force.force_n.x;
    end->force_n.y -= force.force_n.y;
    end->force_n.z -= force.force_n.z;
  }
  return ends;
}

/// Returns the intervals of forces that friction and redundant supports leave undetermined; nothing
/// if all forces are determined.
std::optional<CaseResult::Open> OpenForces(ModelDef def, const LoadCaseSpec& loads) {
  LoadCaseSpec there = loads;
  there.cables.clear();  // the pose already contains the changes of cables
  MoveSupports(def, loads);
  there.settlements.clear();
  CaseResult::Open open;
  IntervalOptions options;
  options.touches = open.touches = FindTouches(def, kBears_m);
  Diagnostics out;
  open.forces = FindForceIntervals(def, there, options, out);
  if (!out.ok() || open.forces.undetermined == 0) return std::nullopt;
  return open;
}

/// Returns the member with the smallest `factor`; null if no member has one.
template <class Factor>
const MemberLoad* Least(const std::vector<MemberLoad>& members, const Factor& factor) {
  const MemberLoad* least = nullptr;
  for (const MemberLoad& load : members) {
    if (factor(load) && (least == nullptr || *factor(load) < *factor(*least))) least = &load;
  }
  return least;
}

}  // namespace

void MoveSupports(ModelDef& def, const LoadCaseSpec& loads) {
  for (const LoadCaseSpec::Settlement& settled : loads.settlements) {
    JointDef& joint = def.joints[static_cast<std::size_t>(settled.joint)];
    Vec3& in_world = IsFixed(def, joint.body_a) ? joint.from_m : joint.to_m;
    in_world = {in_world.x + settled.by_m.x, in_world.y + settled.by_m.y,
                in_world.z + settled.by_m.z};
  }
}

const MemberLoad* CaseResult::LeastSafe() const {
  return Least(members, [](const MemberLoad& load) { return load.Least(); });
}

const MemberLoad* CaseResult::FirstSlack() const {
  return Least(members, [](const MemberLoad& load) { return load.slackening; });
}

std::vector<CaseResult> SolveCases(const ModelDef& def, const std::vector<LoadCaseSpec>& cases,
                                   bool with_modes) {
  LoadCaseSpec nothing;
  nothing.weight = false;
  std::optional<MemberForces> unloaded;
  const Equilibrium at = FindEquilibrium(def, nothing);
  std::vector<Reaction> ignored;
  if (at.found) unloaded = Forces(ModelAt(def, at.pose), nothing, at, ignored);
  std::vector<CaseResult> results;
  for (const LoadCaseSpec& loads : cases) {
    CaseResult& result = results.emplace_back();
    result.loads = loads;
    result.at = FindEquilibrium(def, loads);
    result.def = ModelAt(def, result.at.pose);
    if (!result.at.found) continue;
    const MemberForces forces = Forces(result.def, loads, result.at, result.anchors);
    result.ends = Ends(result.def, result.at);
    result.members = MemberLoads(result.def, forces, unloaded ? &*unloaded : nullptr);
    result.open = OpenForces(result.def, loads);
    result.move = LargestMove(def, result.at.pose);
    LoadCaseSpec there = loads;
    there.cables.clear();  // the pose already contains the changes of cables
    result.least_stiffness_n_per_m = LeastStiffness(result.def, there);
    if (with_modes) result.modes = FindModes(result.def, there);
  }
  return results;
}

std::vector<ReactionForce> ReactionsOf(const CaseResult& result) {
  const ModelDef& def = result.def;
  std::vector<ReactionForce> list;
  for (std::size_t j = 0; j < def.joints.size(); ++j) {
    const JointDef& joint = def.joints[j];
    if (!IsFixed(def, joint.body_a)) continue;
    const JointLoad& load = result.at.joint_loads[j];
    list.push_back({"support", joint.name, joint.to_m, load.force_n, load.torque_n_m});
  }
  for (const Reaction& anchor : result.anchors) {
    const BodyDef& body = def.bodies[static_cast<std::size_t>(anchor.body)];
    list.push_back({"anchor", body.name, body.com_m, anchor.force_n, anchor.torque_n_m});
  }
  for (const CaseResult::End& end : result.ends) {
    list.push_back({"node", end.name, end.point_m, end.force_n, {}});
  }
  for (const ContactState& contact : result.at.contacts) {
    list.push_back({"ground", BodyName(def, contact.body_a), contact.point_m, contact.force_n, {}});
  }
  return list;
}

}  // namespace taut::cli
