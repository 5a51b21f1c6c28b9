// Reader of the tree of bodies, with poses in W.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/principal_axes.h"
#include "math/vec.h"
#include "mjcf/mjcf_mass.h"
#include "mjcf/mjcf_scene.h"

namespace taut::mjcf {
namespace {

/// Limit of geoms, since contact checks take time proportional to the number of pairs.
constexpr std::size_t kMostGeoms = 5000;

class BodyReader {
 public:
  BodyReader(const Defaults& defaults, Scene& scene, Diagnostics& out)
      : defaults_(defaults), scene_(scene), out_(out) {}

  void World(const Element& world) {
    defaults_.CheckClass(world, "childclass", out_);
    Children(world, 0, {}, ClassOf(world, ""));
  }

 private:
  static std::string ClassOf(const Element& element, const std::string& outer) {
    const Attribute* const own = element.Find("childclass");
    return own ? own->value : outer;
  }
  Layers Over(const Element& element, const std::string& cls) const {
    return defaults_.Over(element, cls, out_);
  }
  /// Converts a pose in `frame` to W.
  Pose InWorld(const Pose& frame, const Pose& given) const {
    return scene_.settings.global ? given : frame * given;
  }

  void Children(const Element& of, int body, const Pose& frame, const std::string& cls) {
    for (const Element& child : of.children) {
      if (child.name == "frame") {
        defaults_.CheckClass(child, "childclass", out_);
        const Layers layers = Over(child, cls);
        Children(child, body, InWorld(frame, layers.ReadPose(scene_.settings)),
                 ClassOf(child, cls));
      } else if (child.name == "body") {
        ReadBody(child, body, frame, cls);
      } else if (child.name == "site") {
        ReadSite(child, body, frame, cls);
      } else if (child.name == "geom") {
        AddGeom({&child, body, frame, cls});
      } else if (child.name == "joint" || child.name == "freejoint") {
        ReadJoint(child, body, cls);
      } else if (child.name == "inertial") {
        inertial_ = {&child, frame};
      }
    }
    if (of.name == "frame") return;
    Mass(body);
    const std::size_t first_shape = scene_.shapes.size();
    // Geoms of child bodies have been removed, so the last ones belong to this body.
    std::size_t own = geoms_.size();
    while (own > 0 && geoms_[own - 1].body == body) --own;
    for (std::size_t i = own; i < geoms_.size(); ++i) ReadGeom(geoms_[i], has_mass_);
    geoms_.resize(own);
    if (!has_mass_) SumMassOfShapes(scene_, body, first_shape);
    BoundMass(scene_, body);
  }

  void ReadBody(const Element& element, int parent, const Pose& frame, const std::string& outer) {
    const int body = static_cast<int>(scene_.bodies.size());
    Body& its = scene_.bodies.emplace_back();
    const Attribute* const name = element.Find("name");
    its.name = name ? name->value : "body_" + std::to_string(body);
    its.at = element.at;
    Register(scene_.body_by_name, element, body, out_);
    defaults_.CheckClass(element, "childclass", out_);
    const Layers layers({&element}, out_);
    its.frame = InWorld(frame, layers.ReadPose(scene_.settings));
    if (layers.Number("gravcomp", 0) != 0)
      layers.Error("mjcf.gravcomp", "gravcomp", "gravcomp is not supported");
    if (layers.Flag("mocap", false)) {
      out_.Warning(
          "mjcf.mocap", element.at,
          element.Called() + " is a mocap body, which a program moves; it is imported as fixed");
    }
    // A body without a joint belongs to its parent's rigid body. If the parent is static, the body
    // is a separate static body.
    its.root = scene_.Moves(parent) ? scene_.bodies[Scene::Index(parent)].root : body;
    const auto inertial_outside = inertial_;
    const bool had_mass = has_mass_;
    inertial_ = {};
    const Pose own = its.frame;
    parents_.push_back(parent);
    FindFreeJoint(element, body, ClassOf(element, outer));
    Children(element, body, own, ClassOf(element, outer));
    parents_.pop_back();
    inertial_ = inertial_outside;
    has_mass_ = had_mass;
  }

  /// Finds the free joint before the children are read: children belong to this body only if it
  /// moves.
  void FindFreeJoint(const Element& element, int body, const std::string& cls) {
    for (const Element& child : element.children) {
      if (child.name == "frame") FindFreeJoint(child, body, ClassOf(child, cls));
      const bool is_free =
          child.name == "freejoint" ||
          (child.name == "joint" && Over(child, cls).Text("type", "hinge") == "free");
      if (!is_free) continue;
      Body& its = scene_.bodies[Scene::Index(body)];
      if (its.is_free)
        out_.Error("mjcf.several_free_joints", child.at, "the body has more than one free joint");
      its.is_free = true;
      its.root = body;
      if (parents_.back() != 0) {
        out_.Error("mjcf.nested_free_joint", child.at,
                   child.Called() + ": a body inside another body cannot have a free joint");
      }
    }
  }

  void ReadJoint(const Element& joint, int body, const std::string& cls) {
    const std::string whose =
        " of " +
        (body == 0 ? "the world" : "body \"" + scene_.bodies[Scene::Index(body)].name + "\"");
    if (body == 0) {
      out_.Error("mjcf.joint_of_world", joint.at,
                 joint.Called() + whose + ": the world cannot have joints");
      return;
    }
    const Layers layers = Over(joint, cls);
    const std::string align = layers.Text("align", "auto");
    scene_.bodies[Scene::Index(body)].aligned =
        align == "auto" ? scene_.settings.alignfree : align == "true";
    if (joint.name == "freejoint") return;
    const std::string type = layers.Text("type", "hinge");
    if (type != "free") {
      out_.Error(
          "mjcf.joint_type", joint.at,
          joint.Called() + whose + " is of type " + type + ": only free joints are supported",
          "add joints to the imported model by hand: docs/theory/joints.md");
      return;
    }
    if (layers.Number("frictionloss", 0) > 0) {
      layers.Error("mjcf.frictionloss", "frictionloss",
                   "frictionloss of a free joint is not supported");
    }
    for (const char* key : {"damping", "stiffness", "armature"}) {
      if (layers.Numbers(key, {0}, 1, 3)[0] == 0) continue;
      out_.Warning("mjcf.free_joint_key", layers.Find(key)->at,
                   joint.Called() + whose + ": " + key + " of a free joint is left out");
    }
  }

  void ReadSite(const Element& element, int body, const Pose& frame, const std::string& cls) {
    const Layers layers = Over(element, cls);
    Vec3 p = layers.ReadPose(scene_.settings).p;
    if (const auto line = layers.FromTo()) p = 0.5 * (line->first + line->second);
    const Attribute* const name = element.Find("name");
    Register(scene_.site_by_name, element, static_cast<int>(scene_.sites.size()), out_);
    scene_.sites.push_back({name ? name->value : "", element.at, body, InWorld(frame, {p, {}}).p});
  }

  struct GeomAt {
    const Element* element;
    int body;
    Pose frame;
    std::string cls;
  };

  void AddGeom(GeomAt geom) {
    if (++geom_count_ == kMostGeoms + 1) {
      out_.Error("mjcf.too_many_geoms", geom.element->at,
                 "there are more than " + std::to_string(kMostGeoms) + " geoms",
                 "use fewer: the import tests all pairs of geoms for contact");
    }
    if (geom_count_ <= kMostGeoms) geoms_.push_back(std::move(geom));
  }

  /// Reads the inertial element if the compiler settings use it.
  void Mass(int body) {
    using FromGeoms = CompilerSettings::FromGeoms;
    const FromGeoms from_geoms = scene_.settings.from_geoms;
    has_mass_ = from_geoms == FromGeoms::kFalse ||
                (inertial_.first != nullptr && from_geoms == FromGeoms::kAuto);
    if (body == 0 || inertial_.first == nullptr || !has_mass_) return;
    const Layers layers({inertial_.first}, out_);
    const Pose pose = InWorld(inertial_.second, layers.ReadPose(scene_.settings));
    if (!layers.Has("mass")) layers.Error("mjcf.no_mass", "mass", "mass is missing");
    if (!layers.Has("pos") && !scene_.settings.global)
      layers.Error("mjcf.no_pos", "pos", "pos is missing");
    Body& its = scene_.bodies[Scene::Index(body)];
    its.own_masses = false;
    its.mass.mass_kg = layers.Number("mass", 0);
    its.mass.com_m = pose.p;
    Inertia own;
    if (layers.Has("fullinertia")) {
      const auto n = layers.Numbers("fullinertia", {1, 1, 1, 0, 0, 0}, 6, 6);
      own = {n[0], n[1], n[2], n[3], n[4], n[5]};
    } else {
      const auto n = layers.Numbers("diaginertia", {0, 0, 0}, 3, 3);
      own = {n[0], n[1], n[2], 0, 0, 0};
    }
    its.mass.inertia_kg_m2 = Turned(pose.q, own);
    if (its.mass.mass_kg < 0)
      layers.Error("mjcf.negative_mass", "mass", "the mass must not be negative");
  }

  void ReadGeom(const GeomAt& from, bool body_has_mass);
  void ReadSize(const Layers& layers, const Pose& frame, const std::string& type, Shape& shape);
  void ReadMass(const Layers& layers, Shape& shape);

  const Defaults& defaults_;
  Scene& scene_;
  Diagnostics& out_;
  std::vector<GeomAt> geoms_;  ///< Geoms of the bodies being read.
  std::size_t geom_count_ = 0;
  std::pair<const Element*, Pose> inertial_{};
  std::vector<int> parents_;
  bool has_mass_ = false;
};

void BodyReader::ReadGeom(const GeomAt& from, bool body_has_mass) {
  static const std::map<std::string, Shape::Kind> kKinds{{"sphere", Shape::Kind::kSphere},
                                                         {"capsule", Shape::Kind::kCapsule},
                                                         {"cylinder", Shape::Kind::kCylinder},
                                                         {"box", Shape::Kind::kBox},
                                                         {"plane", Shape::Kind::kPlane}};
  const Layers layers = Over(*from.element, from.cls);
  const std::string type = layers.Text("type", "sphere");
  const bool touches = scene_.has_contacts &&
                       (layers.Whole("contype", 1) != 0 || layers.Whole("conaffinity", 1) != 0);
  const auto kind = kKinds.find(type);
  if (kind == kKinds.end() || layers.Has("mesh") || layers.Has("hfield")) {
    const bool weighs = !body_has_mass && layers.Number("mass", 1) != 0 && from.body != 0;
    if (!touches && !weighs) {
      ++scene_.left_out["visual geom of type " + type];
      Register(scene_.shape_by_name, *from.element, Scene::kLeftOut, out_);
      return;
    }
    const bool known = type == "mesh" || type == "hfield" || type == "ellipsoid" || type == "sdf";
    layers.Error("mjcf.geom_type", known || kind != kKinds.end() ? "name" : "type",
                 known || kind != kKinds.end()
                     ? "geoms of type " + type + (kind == kKinds.end() ? "" : " from a mesh") +
                           " are not supported"
                     : "there is no geom type \"" + type + "\"",
                 "use sphere, capsule, cylinder, box or plane; visual geoms (contype and "
                 "conaffinity 0, no mass) are left out");
    Register(scene_.shape_by_name, *from.element, Scene::kRefused, out_);
    return;
  }
  const Attribute* const name = from.element->Find("name");
  Shape shape{.kind = kind->second, .name = name ? name->value : "", .at = from.element->at};
  shape.body = from.body;
  shape.pose = InWorld(from.frame, layers.ReadPose(scene_.settings));
  ReadSize(layers, from.frame, type, shape);
  ReadMass(layers, shape);
  shape.contype = scene_.has_contacts ? layers.Whole("contype", 1) : 0;
  shape.conaffinity = scene_.has_contacts ? layers.Whole("conaffinity", 1) : 0;
  shape.condim = layers.Whole("condim", 3);
  shape.priority = layers.Whole("priority", 0);
  const auto friction = layers.Numbers("friction", {1, 0.005, 0.0001}, 1, 3);
  shape.friction = shape.condim == 1 ? 0 : friction[0];
  if (friction[0] < 0)
    layers.Error("mjcf.negative_friction", "friction", "friction must not be negative");
  const bool twists =
      shape.condim > 3 && (friction[1] > 0 || (shape.condim > 4 && friction[2] > 0));
  if (twists && touches) scene_.twisting.push_back(shape.at);
  Register(scene_.shape_by_name, *from.element, static_cast<int>(scene_.shapes.size()), out_);
  scene_.shapes.push_back(shape);
}

void BodyReader::ReadSize(const Layers& layers, const Pose& frame, const std::string& type,
                          Shape& shape) {
  const auto size = layers.Numbers("size", {0, 0, 0}, 1, 3);
  const auto line = layers.FromTo();
  const bool is_long = shape.kind == Shape::Kind::kCapsule || shape.kind == Shape::Kind::kCylinder;
  if (shape.kind == Shape::Kind::kPlane) {
    if (scene_.Moves(shape.body))
      layers.Error("mjcf.plane_in_body", "type", "a plane cannot be part of a moving body");
    return;
  }
  std::vector<double> needed{size[0]};
  if (line) {
    if (shape.kind == Shape::Kind::kSphere)
      layers.Error("mjcf.sphere_fromto", "fromto", "fromto does not apply to a sphere");
    const Vec3 from = InWorld(frame, {line->first, {}}).p,
               to = InWorld(frame, {line->second, {}}).p;
    shape.from = from, shape.to = to;
    const double length = std::sqrt(Dot(to - from, to - from));
    shape.half = {size[0], size[0], 0.5 * length};
    // As in MuJoCo, z is the direction from `to` to `from`; x and y follow by the shortest rotation
    // from the body's z axis.
    shape.pose =
        InWorld(frame, {0.5 * (line->first + line->second), FromZ(line->first - line->second)});
  } else {
    const Vec3 half = size[1] * Rotate(shape.pose.q, {0, 0, 1});
    shape.from = shape.pose.p - half, shape.to = shape.pose.p + half;
    shape.half = {size[0], size[1], size[2]};
    if (is_long) needed.push_back(size[1]);
    if (shape.kind == Shape::Kind::kBox) needed = size;
  }
  shape.radius = size[0];
  if (std::any_of(needed.begin(), needed.end(), [](double n) { return !(n > 0); })) {
    layers.Error("mjcf.geom_size", "size",
                 "a " + type + " needs " + std::to_string(needed.size()) +
                     (needed.size() == 1 ? " positive size" : " positive sizes"));
    shape.radius = 1, shape.half = {1, 1, 1};
  }
}

void BodyReader::ReadMass(const Layers& layers, Shape& shape) {
  const std::vector<double>& groups = scene_.settings.inertia_groups;
  const int group = layers.Whole("group", 0);
  if (layers.Flag("shellinertia", false))
    layers.Error("mjcf.shellinertia", "shellinertia", "shellinertia is not supported");
  if (shape.kind == Shape::Kind::kPlane) return;
  const double density = layers.Number("density", 1000);
  shape.mass = layers.Has("mass") ? layers.Number("mass", 0) : density * VolumeOf(shape);
  if (shape.mass < 0)
    layers.Error("mjcf.negative_mass", layers.Has("mass") ? "mass" : "density",
                 "the mass must not be negative");
  if (group < groups[0] || group > groups[1]) shape.mass = 0;
}

}  // namespace

void ReadBodies(const Element& root, const Defaults& defaults, Scene& scene, Diagnostics& out) {
  scene.bodies.push_back({.name = "world", .at = root.at});
  scene.body_by_name["world"] = 0;
  BodyReader reader(defaults, scene, out);
  for (const Element* const world : Sections(root, "worldbody")) reader.World(*world);
}

}  // namespace taut::mjcf
