// Decomposition of a robot into nodes, pairs and builders.
#include <algorithm>
#include <cmath>

#include "base/union_find.h"
#include "description/model/surface_keys.h"
#include "description/write/model_write.h"
#include "description/yaml/reader.h"
#include "description/yaml/write_keys.h"
#include "math/vec.h"
#include "mechanics/mass_properties.h"

namespace taut::description {
namespace {

std::string MassText(const SolidMass& mass) {
  switch (mass.per) {
    case SolidMass::Per::kVolume:
      return "density_kg_per_m3: " + Shown(mass.value);
    case SolidMass::Per::kLength:
      return "mass_kg_per_m: " + Shown(mass.value);
    case SolidMass::Per::kWhole:
      break;
  }
  return "mass_kg: " + Shown(mass.value);
}

std::string SurfaceText(const Material& m, bool collides) {
  std::string text = m.static_friction == m.kinetic_friction
                         ? ", friction: " + Shown(m.static_friction)
                         : ", static_friction: " + Shown(m.static_friction) +
                               ", kinetic_friction: " + Shown(m.kinetic_friction);
  if (m.restitution != 0) text += ", restitution: " + Shown(m.restitution);
  if (m.stribeck) text += ", stribeck: " + FlowWriter<false>::Text(*m.stribeck);
  if (m.directions) {
    const FrictionDirections& d = *m.directions;
    text += ", friction_directions: {forward: " + Shown(d.forward) +
            ", backward: " + Shown(d.backward) + ", sideways: " + Shown(d.sideways);
    if (Dot(d.axis, d.axis) > 0) text += ", axis: " + FlowWriter<false>::Text(d.axis);
    text += "}";
  }
  return collides ? text : text + ", collides: false";
}

class ModelDecomposer {
 public:
  ModelDecomposer(const RobotSpec& robot, Diagnostics& out)
      : robot_(robot), def_(robot.def), out_(out) {}

  WrittenModel Run() {
    for (std::size_t n = 0; n < def_.nodes.size(); ++n) {
      const NodeDef& node = def_.nodes[n];
      m_.nodes.push_back({node.name, node.body, node.position_m, robot_.node_tags[n], -1});
      if (node.body == kWorld) Build(m_.on_nodes, "anchor: {}", static_cast<int>(n));
    }
    for (const CableDef& cable : def_.cables) {
      for (const AttachmentDef& at : cable.attachments) {
        if (!at.wheel && at.friction == 0) continue;
        Refuse("the cable \"" + cable.name + "\" has friction or runs over wheels",
               "use the original model file");
        break;
      }
    }
    if (!def_.hulls.empty()) Refuse("the robot has convex solids", "use the original model file");
    Rods(), Boxes(), Spheres(), PointMasses(), Anchors();
    m_.solid_pairs = m_.pairs.size();
    Cables();
    TakeJoints(robot_, m_, out_);
    FixNodes();
    return std::move(m_);
  }

 private:
  void Refuse(const std::string& what, const std::string& hint = {}) {
    RefuseModel(out_, what, hint);
  }

  int NodeAt(int body, const Vec3& p) const { return description::NodeAt(m_, body, p); }
  int NodeCalled(const std::string& name) const {
    for (std::size_t n = 0; n < m_.nodes.size(); ++n) {
      if (m_.nodes[n].name == name) return static_cast<int>(n);
    }
    return -1;
  }
  std::string BodyName(int body) const { return def_.bodies[static_cast<std::size_t>(body)].name; }

  /// Returns the mass of a shape as its builder gives it. If this mass is unknown, returns the mass
  /// of the body, if the body has no other shape.
  SolidMass MassOf(const std::vector<SolidMass> SolidsSpec::*list, std::size_t index, int body) {
    if (robot_.solids) return ((*robot_.solids).*list)[index];
    int shapes = 0;
    const auto count = [&](const auto& all) {
      for (const auto& shape : all) shapes += shape.body == body;
    };
    count(def_.spheres), count(def_.capsules), count(def_.boxes);
    if (shapes > 1) {
      Refuse("the masses of the parts of the body \"" + BodyName(body) + "\" are not known",
             "use the original experiment: inputs.yaml has only masses of whole bodies");
    }
    return {SolidMass::Per::kWhole,
            def_.bodies[static_cast<std::size_t>(body)].mass_kg - LumpedOn(def_, body)};
  }

  /// Adds the pair of a solid. It has no tags, because solids do not store them.
  int AddSolidPair(const std::string& name, int a, int b) {
    m_.pairs.push_back({name, {}, {a, b}, {}, {}, false});
    return static_cast<int>(m_.pairs.size()) - 1;
  }

  void Rods() {
    for (const std::size_t i : InOrder()) {
      const CapsuleDef& rod = def_.capsules[i];
      const std::size_t pins = m_.pins.size();
      const int from = RodEnd(rod, rod.from_m), to = RodEnd(rod, rod.to_m);
      if (from < 0 || to < 0) {
        Refuse("the rod \"" + rod.name + "\" does not end at nodes");
        continue;
      }
      const bool turns = m_.pins.size() > pins;
      const int pair = AddSolidPair(rod.name, from, to);
      m_.pairs.back().turns = turns;
      Build(m_.on_pairs,
            "rod: {radius_m: " + Shown(rod.radius_m) + (turns ? ", class_k: true, " : ", ") +
                MassText(MassOf(&SolidsSpec::capsules, i, rod.body)) +
                SurfaceText(rod.material, rod.collides) + MemberText(rod.member) + "}",
            pair);
    }
  }

  /// Returns the order in which to write the rods. Pinned rods are in the order of their joints,
  /// because the reader creates these joints in the order of the rods.
  std::vector<std::size_t> InOrder() const {
    std::vector<std::size_t> order, places;
    std::vector<std::pair<std::size_t, std::size_t>> pinned;  // joint, rod
    for (std::size_t i = 0; i < def_.capsules.size(); ++i) {
      order.push_back(i);
      for (std::size_t j = 0; j < def_.joints.size(); ++j) {
        if (!IsPin(def_.joints[j], def_.capsules[i])) continue;
        places.push_back(i);
        pinned.emplace_back(j, i);
        break;
      }
    }
    std::sort(pinned.begin(), pinned.end());
    for (std::size_t k = 0; k < places.size(); ++k) order[places[k]] = pinned[k].second;
    return order;
  }

  /// Returns whether the joint follows from a `class_k` rod.
  bool IsPin(const JointDef& joint, const CapsuleDef& rod) const {
    if (joint.kind != JointKind::kBall || joint.body_b != rod.body) return false;
    const int node = NodeAt(joint.body_a, joint.from_m);
    return node >= 0 && NodeAt(rod.body, joint.to_m) < 0 &&
           joint.name == rod.name + "." + m_.nodes[static_cast<std::size_t>(node)].name;
  }

  /// Returns the node at an end of a rod: a node of its body, or the node to which the rod is
  /// pinned.
  int RodEnd(const CapsuleDef& rod, const Vec3& p) {
    const int own = NodeAt(rod.body, p);
    if (own >= 0) return own;
    for (std::size_t j = 0; j < def_.joints.size(); ++j) {
      const JointDef& pin = def_.joints[j];
      const Vec3& at = pin.to_m;
      if (at.x != p.x || at.y != p.y || at.z != p.z || !IsPin(pin, rod)) continue;
      m_.pins.insert(static_cast<int>(j));
      return NodeAt(pin.body_a, pin.from_m);
    }
    return -1;
  }

  void Boxes() {
    for (std::size_t i = 0; i < def_.boxes.size(); ++i) {
      const BoxDef& box = def_.boxes[i];
      if (IsTerrain(def_, box.body)) continue;
      const SolidMass mass = MassOf(&SolidsSpec::boxes, i, box.body);
      std::string more = MassText(mass) + SurfaceText(box.material, box.collides) + "}";
      const Vec3 h = box.half_extents_m;
      const Vec3 arm = Rotate(box.orientation, {h.x, 0, 0});
      const int node = NodeCalled(box.name);
      if (node >= 0) {
        const Quat in_part =
            Conjugate(TurnFor(PlacementOf(box.name), box.orientation)) * box.orientation;
        const Vec3 turn{in_part.x, in_part.y, in_part.z};
        if (Dot(turn, turn) > 1e-28) {
          more.insert(0, "rotate: {quaternion: " + FlowWriter<false>::Text(in_part) + "}, ");
        }
        Build(m_.on_nodes,
              "box: {half_extents_m: [" + Shown(h.x) + ", " + Shown(h.y) + ", " + Shown(h.z) +
                  "], " + more,
              node);
        continue;
      }
      const int from = NodeNear(box.body, box.center_m - arm),
                to = NodeNear(box.body, box.center_m + arm);
      if (from < 0 || to < 0) {
        Refuse("the box \"" + box.name + "\" is neither at a node nor along a pair");
        continue;
      }
      const std::string placement = PlacementOf(m_.nodes[static_cast<std::size_t>(from)].name);
      if (!Alike(TurnFor(placement, box.orientation), box.orientation)) {
        Refuse("the boxes along pairs of one part have different orientations, such as \"" +
                   box.name + "\"",
               placement.empty() ? "put its nodes into a part" : "");
      }
      Build(m_.on_pairs,
            "box: {width_m: " + Shown(2 * h.y) + ", height_m: " + Shown(2 * h.z) + ", " + more,
            AddSolidPair(box.name, from, to));
    }
  }

  /// Returns the orientation of a part, which is the orientation of its first box; identity for
  /// nodes outside of parts.
  Quat TurnFor(const std::string& placement, const Quat& box) {
    if (placement.empty()) return {};
    return m_.turns.emplace(placement, box).first->second;
  }

  int NodeNear(int body, const Vec3& p) const {
    for (std::size_t n = 0; n < m_.nodes.size(); ++n) {
      const Vec3 off = m_.nodes[n].position_m - p;
      if (m_.nodes[n].body == body && Dot(off, off) < 1e-18) return static_cast<int>(n);
    }
    return -1;
  }
  static bool Alike(const Quat& a, const Quat& b) {
    return std::fabs(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z) > 1 - 1e-14;
  }

  void Spheres() {
    for (std::size_t i = 0; i < def_.spheres.size(); ++i) {
      const SphereDef& sphere = def_.spheres[i];
      const int node = NodeCalled(sphere.name);
      if (node < 0) {
        Refuse("the sphere \"" + sphere.name + "\" is not at a node");
        continue;
      }
      Build(m_.on_nodes,
            "sphere: {radius_m: " + Shown(sphere.radius_m) + ", " +
                MassText(MassOf(&SolidsSpec::spheres, i, sphere.body)) +
                SurfaceText(sphere.material, sphere.collides) + "}",
            node);
    }
  }

  /// Returns the inertia in the axes of the node's part, as three numbers if the products of
  /// inertia are 0.
  std::string InertiaText(const Inertia& in_world, int node) const {
    const auto turn = m_.turns.find(PlacementOf(m_.nodes[static_cast<std::size_t>(node)].name));
    const Inertia i = turn == m_.turns.end() ? in_world : Turned(Conjugate(turn->second), in_world);
    if (i.xy != 0 || i.xz != 0 || i.yz != 0) return FlowWriter<false>::Text(i);
    return FlowWriter<false>::Text(std::vector{i.xx, i.yy, i.zz});
  }

  void PointMasses() {
    const auto add = [&](int node, double mass_kg, double radius_m, std::optional<Inertia> own) {
      std::string text = "point_mass: {mass_kg: " + Shown(mass_kg);
      if (radius_m > 0) text += ", radius_m: " + Shown(radius_m);
      if (own) text += ", inertia_kg_m2: " + InertiaText(*own, node);
      Build(m_.on_nodes, text + "}", node);
    };
    if (robot_.solids) {
      for (const SolidsSpec::PointMass& p : robot_.solids->point_masses) {
        add(p.node, p.mass_kg, p.radius_m, p.inertia_kg_m2);
      }
      return;
    }
    for (std::size_t b = 0; b < def_.bodies.size(); ++b) {
      const auto of_body = [&](const auto& shape) { return shape.body == static_cast<int>(b); };
      if (std::any_of(def_.spheres.begin(), def_.spheres.end(), of_body) ||
          std::any_of(def_.capsules.begin(), def_.capsules.end(), of_body) ||
          std::any_of(def_.boxes.begin(), def_.boxes.end(), of_body)) {
        continue;
      }
      const BodyDef& body = def_.bodies[b];
      const int node = NodeAt(static_cast<int>(b), body.com_m);
      if (node < 0) {
        Refuse("no node is at the center of the body \"" + body.name + "\", which has no shape");
        continue;
      }
      const double own_kg = body.mass_kg - LumpedOn(def_, static_cast<int>(b));
      if (own_kg < 1e-12 * body.mass_kg) continue;  // only bars and cables have mass
      add(node, own_kg, std::sqrt(2.5 * body.inertia_kg_m2.xx / body.mass_kg), {});
    }
  }

  void Anchors() {
    for (std::size_t b = 0; b < def_.bodies.size(); ++b) {
      if (!IsAnchored(def_, static_cast<int>(b))) continue;
      for (std::size_t n = 0; n < m_.nodes.size(); ++n) {
        if (m_.nodes[n].body != static_cast<int>(b)) continue;
        Build(m_.on_nodes, "anchor: {}", static_cast<int>(n));
        break;
      }
    }
  }

  void Cables() {
    for (std::size_t c = 0; c < def_.cables.size(); ++c) {
      const CableDef& cable = def_.cables[c];
      WrittenPair pair{cable.name, robot_.cable_tags[c], {}, {}, {}, false};
      for (std::size_t i = 0; i < cable.attachments.size(); ++i) {
        pair.nodes.push_back(EndNode(cable, i));
      }
      if (std::find(pair.nodes.begin(), pair.nodes.end(), -1) != pair.nodes.end()) continue;
      m_.pairs.push_back(std::move(pair));
      m_.cables.push_back(static_cast<int>(c));
    }
  }

  /// Returns the node at which a cable is attached. Adds a node if the cable is attached to a
  /// surface, because this attachment point is fixed in the body.
  int EndNode(const CableDef& cable, std::size_t i) {
    const AttachmentDef& at = cable.attachments[i];
    const int there = NodeAt(at.body, at.position_m);
    if (there >= 0) return there;
    const auto host = std::find_if(m_.nodes.begin(), m_.nodes.end(),
                                   [&](const WrittenNode& n) { return n.body == at.body; });
    if (at.body == kWorld || host == m_.nodes.end()) {
      Refuse("the cable \"" + cable.name + "\" ends where there is no node");
      return -1;
    }
    const std::string placement = PlacementOf(host->name);
    std::string name =
        ShortName(cable.name) + (i == 0                              ? "_from"
                                 : i + 1 == cable.attachments.size() ? "_to"
                                                                     : "_" + std::to_string(i));
    if (!placement.empty()) name = placement + "." + name;
    if (NodeCalled(name) >= 0) {
      Refuse("the cable \"" + cable.name + "\" ends on a surface, and the name \"" + name +
             "\" for the node there is already used");
      return -1;
    }
    WrittenNode node{name, at.body, at.position_m, {}, static_cast<int>(host - m_.nodes.begin())};
    m_.nodes.push_back(std::move(node));
    return static_cast<int>(m_.nodes.size()) - 1;
  }

  /// Sets `fixed_to` of nodes that no rod or box connects to the rest of their body.
  void FixNodes() {
    base::UnionFind welds(m_.nodes.size());
    for (std::size_t p = 0; p < m_.solid_pairs; ++p) {
      const WrittenPair& pair = m_.pairs[p];
      if (!pair.turns) welds.Join(pair.nodes[0], pair.nodes[1]);
    }
    std::map<std::pair<int, std::string>, int> first;
    for (int n = 0; n < static_cast<int>(m_.nodes.size()); ++n) {
      WrittenNode& node = m_.nodes[static_cast<std::size_t>(n)];
      if (node.body == kWorld) continue;
      const int host = first.emplace(std::pair(node.body, PlacementOf(node.name)), n).first->second;
      if (welds.Root(n) == welds.Root(host)) continue;
      node.fixed_to = host;
      welds.Join(n, host);
    }
  }

  const RobotSpec& robot_;
  const ModelDef& def_;
  Diagnostics& out_;
  WrittenModel m_;
};

}  // namespace

WrittenModel TakeApart(const RobotSpec& robot, Diagnostics& out) {
  return ModelDecomposer(robot, out).Run();
}

}  // namespace taut::description
