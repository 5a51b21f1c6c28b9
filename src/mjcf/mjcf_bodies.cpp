// Bodies, nodes and shapes of a robot imported from MJCF.
#include <algorithm>
#include <cmath>
#include <set>

#include "math/principal_axes.h"
#include "math/vec.h"
#include "mjcf/mjcf_build.h"

namespace taut::mjcf {
namespace {

bool IsRod(const Shape& s) {
  return s.kind == Shape::Kind::kCapsule || s.kind == Shape::Kind::kCylinder;
}
bool IsTerrain(const Scene& scene, const Shape& s) {
  return !scene.Moves(s.body) && (s.kind == Shape::Kind::kPlane || s.kind == Shape::Kind::kBox);
}

/// Returns the common prefix of the body's site names, as in taut's export: "segment_0" if all
/// names begin with "segment_0.".
std::string CommonPrefix(const Scene& scene, const Rigid& rigid) {
  std::string prefix;
  for (const int site : rigid.sites) {
    const std::string& name = scene.sites[Scene::Index(site)].name;
    if (name.empty()) continue;
    const std::size_t dot = name.rfind('.');
    if (dot == name.npos || !IsName(name.substr(0, dot)) || !IsName(name.substr(dot + 1))) {
      return {};
    }
    if (!prefix.empty() && prefix != name.substr(0, dot)) return {};
    prefix = name.substr(0, dot);
  }
  return prefix;
}

class BodyBuilder {
 public:
  BodyBuilder(Building& b, Rigid& rigid)
      : b_(b), scene_(b.scene), rigid_(rigid), def_(b.def()), robot_(b.made.robot) {}

  void Run() {
    first_node_ = def_.nodes.size();
    const bool is_body = rigid_.moves || !rigid_.shapes.empty();
    if (is_body) {
      rigid_.body = static_cast<int>(def_.bodies.size());
      def_.bodies.emplace_back();
      robot_.body_sources.push_back(scene_.bodies[Scene::Index(rigid_.root)].at);
    }
    for (const int site : rigid_.sites) {
      const Site& its = scene_.sites[Scene::Index(site)];
      if (its.name.empty()) continue;
      b_.node_of_site[Scene::Index(site)] = AddNode(its.name, its.p, its.at);
    }
    if (!is_body) return;
    for (const int shape : rigid_.shapes) AddShape(shape);
    Weigh();
  }

 private:
  std::string InPlacement(const std::string& raw, const std::string& if_empty) const {
    const std::string& p = rigid_.placement;
    if (p.empty()) return ToName(raw, if_empty);
    const bool has_it = raw.starts_with(p + ".") && IsName(raw.substr(p.size() + 1));
    return has_it ? raw : p + "." + ToName(raw, if_empty);
  }
  std::string BodyName() const { return scene_.bodies[Scene::Index(rigid_.root)].name; }

  int AddNode(const std::string& raw, const Vec3& p, const SourceRef& at) {
    const std::string name = b_.nodes.Take(InPlacement(raw, "node"));
    def_.nodes.push_back({name, rigid_.body, p});
    robot_.node_tags.push_back({name});
    const std::size_t dot = name.rfind('.');
    if (dot != name.npos) robot_.node_tags.back().push_back(name.substr(dot + 1));
    robot_.node_sources.push_back(at);
    return static_cast<int>(def_.nodes.size()) - 1;
  }
  /// Returns the body's node at this point, up to rounding; -1 if there is none.
  int NodeNear(const Vec3& p) const {
    for (std::size_t n = first_node_; n < def_.nodes.size(); ++n) {
      const Vec3 off = def_.nodes[n].position_m - p;
      if (Dot(off, off) <= 1e-24 * (1 + Dot(p, p))) return static_cast<int>(n);
    }
    return -1;
  }
  /// Returns the node at this point; adds it if missing.
  const NodeDef& NodeFor(const Vec3& p, const std::string& raw, const SourceRef& at) {
    int node = NodeNear(p);
    if (node < 0) node = AddNode(raw, p, at);
    return def_.nodes[Scene::Index(node)];
  }
  /// Like `NodeFor`, but returns no node in `taken`: these nodes already have a shape of this kind.
  const NodeDef& FreeNodeFor(std::set<int>& taken, const Shape& s, const std::string& raw) {
    int node = NodeNear(s.pose.p);
    if (node < 0 || taken.contains(node)) node = AddNode(raw, s.pose.p, s.at);
    taken.insert(node);
    return def_.nodes[Scene::Index(node)];
  }

  void AddShape(int index) {
    const Shape& s = scene_.shapes[Scene::Index(index)];
    const double mass = own_masses_ ? s.mass : 0;
    const SolidMass solid{SolidMass::Per::kWhole, rigid_.moves ? mass : 0};
    const bool by_shape = rigid_.placement.empty() && !rigid_.called_as_robot;
    const std::string plain = by_shape ? ToName(BodyName(), "body") : "";
    Material material;
    material.static_friction = material.kinetic_friction = s.friction;
    Building::Made& made = b_.made_of_shape[Scene::Index(index)];
    if (IsRod(s)) {
      const std::string given = plain.empty() || rods_++ > 0 ? s.name : plain;
      const std::string name = b_.pairs.Take(InPlacement(given, "rod"));
      const std::string own = name.substr(name.rfind('.') + 1);
      const Vec3 from = NodeFor(s.from, own + "_from", s.at).position_m,
                 to = NodeFor(s.to, own + "_to", s.at).position_m;
      made = {"rod", def_.capsules.size()};
      def_.capsules.push_back({.name = name,
                               .body = rigid_.body,
                               .from_m = from,
                               .to_m = to,
                               .radius_m = s.radius,
                               .material = material,
                               .collides = s.collides});
      robot_.solids->capsules.push_back(solid);
      cylinders_ += s.kind == Shape::Kind::kCylinder;
    } else if (s.kind == Shape::Kind::kSphere) {
      const NodeDef& node = FreeNodeFor(spheres_, s, NameFor(s, plain, "sphere"));
      made = {"sphere", def_.spheres.size()};
      def_.spheres.push_back(
          {node.name, rigid_.body, node.position_m, s.radius, material, s.collides});
      robot_.solids->spheres.push_back(solid);
    } else {
      const NodeDef& node = FreeNodeFor(boxes_, s, NameFor(s, plain, "box"));
      made = {"box", def_.boxes.size()};
      def_.boxes.push_back(
          {node.name, rigid_.body, node.position_m, s.pose.q, s.half, material, s.collides});
      robot_.solids->boxes.push_back(solid);
    }
  }
  static std::string NameFor(const Shape& s, const std::string& plain, const char* usual) {
    return !plain.empty() ? plain : s.name.empty() ? usual : s.name;
  }

 public:
  /// Determines whether the masses that taut computes for the solids are equal to MuJoCo's masses.
  void FindOwnMasses() {
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const Body& body = scene_.bodies[i];
      if (body.root != rigid_.root) continue;
      own_masses_ = own_masses_ && body.own_masses;
      parts_.push_back(body.mass);
    }
    own_masses_ = own_masses_ && !(scene_.settings.settotalmass > 0);
  }
  int cylinders() const { return cylinders_; }

 private:
  void Weigh() {
    BodyDef& body = def_.bodies.back();
    if (!rigid_.moves) {
      body.fixed = true;
      body.com_m = def_.nodes[first_node_].position_m;
      return;
    }
    const MassProperties whole = Combine(parts_);
    body.mass_kg = whole.mass_kg, body.com_m = whole.com_m;
    body.inertia_kg_m2 = whole.inertia_kg_m2;
    const SourceRef& at = scene_.bodies[Scene::Index(rigid_.root)].at;
    if (!(whole.mass_kg > 0)) {
      b_.out.Error("body.no_mass", at, "the body \"" + BodyName() + "\" has no mass");
      return;
    }
    double r[9], moments[3];
    PrincipalAxes(body.inertia_kg_m2, r, moments);
    std::sort(moments, moments + 3);
    if (!(moments[0] > 1e-12 * moments[2])) {
      b_.out.Error("body.no_inertia", at,
                   "the body \"" + BodyName() + "\" has no inertia about a principal axis");
    } else if (moments[0] + moments[1] < (1 - 1e-9) * moments[2]) {
      b_.out.Error("body.impossible_inertia", at,
                   "the moments of inertia of the body \"" + BodyName() +
                       "\" are impossible: two of them add up to less than the third");
    }
    if (own_masses_) return;
    const std::string raw =
        rigid_.placement.empty() && !rigid_.shapes.empty() ? BodyName() + "_com" : "com";
    const bool is_alone = rigid_.placement.empty() && rigid_.shapes.empty();
    const NodeDef& node = NodeFor(whole.com_m, is_alone ? BodyName() : raw, at);
    body.com_m = node.position_m;
    robot_.solids->point_masses.push_back(
        {static_cast<int>(&node - def_.nodes.data()), whole.mass_kg, 0.0, whole.inertia_kg_m2});
  }

  Building& b_;
  Scene& scene_;
  Rigid& rigid_;
  ModelDef& def_;
  RobotSpec& robot_;
  std::size_t first_node_ = 0;
  std::vector<MassProperties> parts_;
  std::set<int> spheres_, boxes_;
  int rods_ = 0, cylinders_ = 0;
  bool own_masses_ = true;
};

}  // namespace

const Rigid& Building::RigidOf(int body) const { return rigids[rigid_of_body[Scene::Index(body)]]; }

void FindRigids(Building& b) {
  Scene& scene = b.scene;
  std::map<int, Rigid> by_root;
  for (const Body& body : scene.bodies) {
    Rigid& rigid = by_root[body.root];
    rigid.root = body.root;
    rigid.moves = scene.bodies[Scene::Index(body.root)].is_free;
  }
  const auto of = [&](int body) -> Rigid& {
    return by_root[scene.bodies[Scene::Index(body)].root];
  };
  for (std::size_t i = 0; i < scene.sites.size(); ++i) {
    of(scene.sites[i].body).sites.push_back(static_cast<int>(i));
  }
  for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
    if (IsTerrain(scene, scene.shapes[i])) continue;
    of(scene.shapes[i].body).shapes.push_back(static_cast<int>(i));
  }
  base::UniqueNames placements;
  std::set<std::string> prefixes;
  for (auto& [root, rigid] : by_root) {
    rigid.placement = CommonPrefix(scene, rigid);
    if (!rigid.placement.empty() && prefixes.insert(rigid.placement).second) {
      placements.Take(rigid.placement);
    }
  }
  const auto bodies = std::count_if(by_root.begin(), by_root.end(), [](const auto& entry) {
    return entry.second.moves || !entry.second.shapes.empty();
  });
  for (auto& [root, rigid] : by_root) {
    if (!rigid.placement.empty() || (!rigid.moves && rigid.shapes.empty())) continue;
    // If the robot has only one body, this body may have the robot's name.
    rigid.called_as_robot = bodies == 1 && scene.bodies[Scene::Index(root)].name == b.def().name;
    if (rigid.called_as_robot) continue;
    const auto rods = std::count_if(rigid.shapes.begin(), rigid.shapes.end(), [&](int shape) {
      return IsRod(scene.shapes[Scene::Index(shape)]);
    });
    // taut names a body after its placement, or else after its rod or first node.
    const std::string& name = scene.bodies[Scene::Index(root)].name;
    const bool by_node =
        rods == 0 && rigid.shapes.size() <= 1 &&
        (rigid.sites.empty() ||
         (rigid.sites.size() == 1 && scene.sites[Scene::Index(rigid.sites[0])].name == name));
    if (rods != 1 && !by_node) rigid.placement = placements.Take(ToName(name, "body"));
  }
  // The order in a model file: first bodies outside of parts, then bodies of each part.
  std::vector<std::vector<const Rigid*>> parts(1);
  std::map<std::string, std::size_t> part_of{{"", 0}};
  for (const auto& [root, rigid] : by_root) {
    if (!rigid.moves && rigid.shapes.empty()) continue;
    const auto [part, fresh] = part_of.try_emplace(rigid.placement, parts.size());
    if (fresh) parts.emplace_back();
    parts[part->second].push_back(&rigid);
  }
  for (const auto& part : parts) {
    for (const Rigid* const rigid : part) b.rigids.push_back(*rigid);
  }
  for (auto& [root, rigid] : by_root) {  // static bodies without shapes: they have only nodes
    if (rigid.moves || !rigid.shapes.empty()) continue;
    rigid.placement.clear();
    b.rigids.push_back(rigid);
  }
  std::vector<std::size_t> of_root(scene.bodies.size());
  for (std::size_t i = 0; i < b.rigids.size(); ++i) of_root[Scene::Index(b.rigids[i].root)] = i;
  for (const Body& body : scene.bodies) b.rigid_of_body.push_back(of_root[Scene::Index(body.root)]);
}

void BuildBodies(Building& b) {
  b.made.robot.solids.emplace();
  b.node_of_site.assign(b.scene.sites.size(), -1);
  b.made_of_shape.resize(b.scene.shapes.size());
  int cylinders = 0;
  for (Rigid& rigid : b.rigids) {
    BodyBuilder builder(b, rigid);
    builder.FindOwnMasses();
    builder.Run();
    cylinders += builder.cylinders();
  }
  if (cylinders > 0) {
    b.Note(Count(static_cast<std::size_t>(cylinders), "cylinder") +
           " imported as rods, which collide as capsules, longer by the radius at each end");
  }
  for (std::size_t i = 0; i < b.scene.shapes.size(); ++i) {
    const Shape& s = b.scene.shapes[i];
    if (!IsTerrain(b.scene, s)) continue;
    if (!s.collides) {
      ++b.scene.left_out["visual geom of the world"];
      continue;
    }
    Material material;
    material.static_friction = material.kinetic_friction = s.friction;
    const bool is_plane = s.kind == Shape::Kind::kPlane;
    const std::string name = b.terrain.Take(ToName(s.name, is_plane ? "ground" : "box"));
    if (is_plane) {
      b.made_of_shape[i] = {"plane", b.def().planes.size()};
      b.def().planes.push_back({name, Rotate(s.pose.q, {0, 0, 1}), s.pose.p, material});
      b.made.robot.plane_sources.push_back(s.at);
    } else {
      b.made_of_shape[i] = {"terrain box", b.def().terrain_boxes.size()};
      b.def().terrain_boxes.push_back({name, s.pose.p, s.pose.q, s.half, material});
      b.made.robot.terrain_box_sources.push_back(s.at);
    }
  }
}

void NameBodies(Building& b) {
  std::map<std::string, int> in_placement;
  bool any_placement = false;
  for (const Rigid& rigid : b.rigids) {
    if (rigid.body == kWorld) continue;
    ++in_placement[rigid.placement];
    any_placement = any_placement || !rigid.placement.empty();
  }
  ModelDef& def = b.def();
  for (const Rigid& rigid : b.rigids) {
    if (rigid.body == kWorld) continue;
    BodyDef& body = def.bodies[Scene::Index(rigid.body)];
    const bool alone = in_placement[rigid.placement] == 1;
    const auto of_body = [&](const auto& part) { return part.body == rigid.body; };
    const auto rod = std::find_if(def.capsules.begin(), def.capsules.end(), of_body);
    if (alone && !rigid.placement.empty()) {
      body.name = rigid.placement;
    } else if (alone && !any_placement) {
      body.name = def.name;
    } else if (rod != def.capsules.end()) {
      body.name = rod->name;
    } else {
      body.name = std::find_if(def.nodes.begin(), def.nodes.end(), of_body)->name;
    }
  }
}

std::string ToName(const std::string& text, const std::string& if_empty) {
  constexpr std::size_t kLongest = 64;
  std::string name = text.substr(0, kLongest);
  for (char& c : name) {
    if (!IsName(std::string(1, c))) c = '_';
  }
  return name.empty() ? if_empty : name;
}

std::string Count(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

}  // namespace taut::mjcf
