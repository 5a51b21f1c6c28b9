/// Keys of model files, with the subset that resolved experiments contain.
#pragma once

#include "description/model/cable_keys.h"
#include "description/model/described_rotation.h"
#include "description/model/joint_keys.h"
#include "description/model/member_keys.h"
#include "description/model/model_text.h"
#include "description/model/surface_keys.h"

namespace taut::description {

/// Keys of contact laws. They occur in `contact` of a model and in `model_options` of an
/// experiment.
template <class Io>
void ContactKeys(Io& io, Like<ModelDef> auto& m) {
  io("friction_combine", m.friction_combine, kCombineRules,
     "Combination of the friction coefficients of two touching surfaces.");
  io("restitution_combine", m.restitution_combine, kCombineRules,
     "Combination of the restitutions of two touching surfaces.");
  io("friction_law", m.friction_law, kFrictionLaws,
     "Directions in which friction acts. `cone`: both tangential directions, the exact Coulomb "
     "cone. "
     "`along_slip`: only along the sliding velocity, as in Bullet by default; this law lets a "
     "robot creep "
     "sideways.");
}
template <class Io>
void Keys(Io& io, Like<ModelDef> auto& m) {
  io.Map("contact", "contact", "Contact laws.");
  ContactKeys(io, m);
}
inline constexpr const char* kInertiaMeaning =
    "Inertia of a body. `exact`: sum over the body's parts. `bounding_box`: for bodies of several "
    "parts, "
    "a solid box with the body's mass and the size of its initial bounding box, as Bullet uses for "
    "compounds.";
inline constexpr const char* kDampingMeaning =
    "Damping law of cables. `exact`: b dl/dt, with a tension that is never negative. `clamped`: b "
    "dl/dt limited to the elastic force, as in NTRT.";
template <class Io>
void Keys(Io& io, Like<ModelOptions> auto& o) {
  io.Map("model_options", "model_options",
         "Physical laws of the model that this experiment replaces, such as by the laws of another "
         "simulator. Default: the model's laws.");
  io("inertia", o.inertia, kInertiaLaws, kInertiaMeaning);
  io("damping_law", o.damping_law, kDampingLaws, kDampingMeaning);
  ContactKeys(io, o.def);
}

template <class Io>
void Keys(Io& io, Like<NodeText> auto& n) {
  io.Map("", "node",
         "Node with tags or other keys. `tip: [x, y, z]` is short for `tip: {at_m: [x, y, z]}`.");
  io("at_m", n.at_m, kNeeded,
     "Position, in the part's frame or, outside of parts, in the world frame.");
  io("tags", n.tags, "Tags for builders and controllers, in addition to the node's name.");
  io("fixed_to", n.fixed_to, kName,
     "Another node of the same part; this node belongs to the body of that node. For points of a "
     "body that are not on its rods and boxes.");
}
void Check(const MapReader& map, NodeText& node);
/// Reads the short form `[x, y, z]`. Returns false for a map; reports an error for other types.
bool ReadShort(const Value& value, const std::string& path, const Scope& scope, NodeText& out);

template <class Io>
void Keys(Io& io, Like<RouteText> auto& r) {
  io.Map("", "pair.route",
         "Element of a routed cable: end, eyelet, pulley or drum. A plain node name is an end of "
         "the cable, or "
         "an eyelet without friction.",
         R"({"pulley": "wheel", "axis": [0, 1, 0], "radius_m": 0.05, "side": "left"})");
  io.OneOf({"eyelet", "pulley", "drum"});
  io("eyelet", r.eyelet, "Node at which the cable slides through.");
  io("pulley", r.pulley,
     "Node at the center of a pulley; the pulley belongs to the node's body. The cable wraps "
     "around the pulley or, without contact, passes the pulley in a straight line.");
  io("drum", r.drum, "Node at the center of a drum; the cable ends on the rim of the drum.");
  io("friction", r.friction, Bound::kNonNegative,
     "Coefficient mu of capstan friction: before the cable slips, the ratio of the tensions on "
     "both sides is "
     "at most exp(mu times the wrap angle). Not allowed at an end.");
  io("axis", r.axis, kDirection,
     "Axis of a pulley or drum, in the part's frame, or in the world frame if the pair joins "
     "several parts.");
  io("radius_m", r.radius_m, Bound::kPositive,
     "Radius of a pulley or drum, to the cable's center line.");
  io("side", r.left, kSides,
     "Side of the cable on which the pulley or drum is, when you look along the cable with the "
     "axis pointing up. "
     "The cable runs counter-clockwise around a wheel on the `left`.");
  io("turns", r.turns, Bound::kNonNegative,
     "Pulley: whole turns in addition to the shortest way around. Drum: all wound turns.");
}
void Check(const MapReader& map, RouteText& element);
/// Reads a route element in its short form, the name of a node. Returns false if it is a map.
bool ReadShort(const Value& value, const std::string& path, const Scope& scope, RouteText& out);

template <class Io>
void Keys(Io& io, Like<PairsText> auto& p) {
  io.Map("", "pair",
         "Pair of nodes that an element joins, or several such pairs with the same tags.",
         R"({"nodes": ["right", "left"], "tags": ["rod"]})");
  io("name", p.name, kName,
     "Name of the element, such as a cable; also one of the element's tags. Default: the names of "
     "the nodes, such as right-left.");
  io.OneOf({"nodes", "each", "route"});
  io.Rule(R"("not": {"required": ["name", "each"]})");
  io("nodes", p.nodes,
     "Nodes of the pair. A cable may have more than two nodes; it slides through the inner nodes.");
  io("each", p.each, "List of pairs with the same tags, instead of `nodes`.");
  io("route", p.route,
     "Route of a cable, instead of `nodes`: ends, eyelets with friction, pulleys and drums, in "
     "order.");
  io("tags", p.tags, "Tags for builders and controllers.");
}
void Check(const MapReader& map, PairsText& pairs);

template <class Io>
void Keys(Io& io, Like<PartText> auto& p) {
  io.Map("", "parts", "Group of nodes and pairs.");
  io("nodes", p.nodes_text, kNeeded, kName, "Nodes by name, in the part's frame.");
  io("pairs", p.pairs_text, "Pairs of nodes of the part.");
}
void Check(const MapReader& map, PartText& part);

template <class Io>
void Keys(Io& io, Like<PlacementText> auto& p) {
  io.Map("structure", "structure",
         "Placement of a part, once or repeated. A node of a placed part has the placement's name "
         "as prefix: segment_0.tip.");
  io("part", p.part, kNeeded, "Name of the part.");
  io("name", p.name, kName, "Name of the placement. Default: the part's.");
  io("copies", p.copies, kInherited, Bound{.least = 1, .most = kMaxCopies},
     "Number of copies. The copies are named name_0, name_1 ...; their nodes and pairs also have "
     "the "
     "copy's number and `first`, `middle` or `last` as tags (a single copy is first and last).");
  io("at_m", p.at_m, "Position of the part's origin (copy 0).");
  io("rotate", p.rotate, "Rotation of the part (copy 0) about its origin.");
  io("step_m", p.step_m, "Translation from one copy's origin to the next, in the world frame.");
  io("step_rotate", p.step_rotate,
     "Rotation from one copy's orientation to the next copy's, about axes of the world frame.");
  io("velocity_m_per_s", p.velocity_m_per_s,
     "Initial velocity of each copy's center of mass, in the world frame.");
  io("angular_velocity_rad_per_s", p.angular_velocity_rad_per_s,
     "Initial angular velocity of each whole copy about its center of mass, in the world frame.");
  io("tags", p.tags, "Additional tags of all nodes and pairs of the placement.");
  io("connect", p.connect_text,
     "Pairs from each copy to the next. The first node is on copy i, the second on copy i + 1; for "
     "a cable with three nodes, the third is on copy i + 2. Named pairs become name_1, name_2 ...; "
     "they have their "
     "number "
     "and `first`, `middle` or `last` as tags.");
  io("ring", p.ring, "Whether the last copy is also connected to the first.");
  io.Rule(R"("dependentRequired": {"step_m": ["copies"], "step_rotate": ["copies"], )"
          R"("connect": ["copies"], "ring": ["copies"]})");
}
void Check(const MapReader& map, PlacementText& placement);

/// Whether an element with mass has a length: never, always (along a pair), or in one of its forms.
enum class Along { kNothing, kPair, kEither };
template <class Io>
void MassKeys(Io& io, Like<MassText> auto& m, Along along) {
  if (along != Along::kEither) {
    std::vector<std::string> keys{"mass_kg", "density_kg_per_m3"};
    if (along == Along::kPair) keys.push_back("mass_kg_per_m");
    io.OneOf(keys);
  }
  io("mass_kg", m.mass_kg, Bound::kNonNegative, "Mass of the element.");
  io("density_kg_per_m3", m.density_kg_per_m3, Bound::kNonNegative,
     "Density of the element, instead of `mass_kg`.");
  if (along == Along::kNothing) return;
  io("mass_kg_per_m", m.mass_kg_per_m, Bound::kNonNegative,
     "Mass per length of the element along its pair, instead of `mass_kg`.");
}
inline constexpr const char* kCollidesMeaning = "Whether this element collides with other objects.";

template <class Io, Either<CapsuleDef, RodText> Rod>
void Keys(Io& io, Rod& r) {
  io.Map("rod", "builder.rod",
         "Rod, a solid cylinder along a pair, from node to node. Its contact shape is a capsule: "
         "round ends of the same radius.");
  io("name", r.name, kResolvedOnly);
  io("body", r.body, kResolvedOnly);
  io("from_m", r.from_m, kResolvedOnly);
  io("to_m", r.to_m, kResolvedOnly);
  io("radius_m", r.radius_m, kNeeded, Bound::kPositive, "Radius of the rod.");
  if constexpr (Io::kResolved) {
    io("material", r.material);
  } else {
    io("class_k", r.class_k,
       "Class-k structure: whether rods that share a node are connected by ball joints there, "
       "instead of welded.");
    io("pins", r.pins);
    MassKeys(io, r.mass, Along::kPair);
    SurfaceKeys(io, r.surface);
  }
  MemberKeys(io, r.member, MemberOf::kRod);
  io("collides", r.collides, kCollidesMeaning);
}
void Check(const MapReader& map, RodText& rod);

template <class Io, Either<SphereDef, SphereText> Sphere>
void Keys(Io& io, Sphere& s) {
  io.Map("sphere", "builder.sphere", "Solid sphere at a node.");
  io("name", s.name, kResolvedOnly);
  io("body", s.body, kResolvedOnly);
  io("center_m", s.center_m, kResolvedOnly);
  io("radius_m", s.radius_m, kNeeded, Bound::kPositive, "Radius of the sphere.");
  if constexpr (Io::kResolved) {
    io("material", s.material);
  } else {
    MassKeys(io, s.mass, Along::kNothing);
    SurfaceKeys(io, s.surface);
  }
  io("collides", s.collides, kCollidesMeaning);
}
void Check(const MapReader& map, SphereText& sphere);

template <class Io>
void Keys(Io& io, Like<PointMassText> auto& p) {
  io.Map("point_mass", "builder.point_mass", "Point mass at a node, without contact.");
  io("mass_kg", p.mass_kg, kNeeded, Bound::kPositive, "Mass of the element.");
  io("radius_m", p.radius_m, Bound::kNonNegative,
     "Radius of the solid sphere that defines the inertia.");
  io("inertia_kg_m2", p.inertia_kg_m2,
     "Moments of inertia about the node, instead of `radius_m`: [xx, yy, zz] along the part's "
     "axes, or the matrix entries [xx, yy, zz, xy, xz, yz].",
     Example{"[0.02, 0.02, 0.001]"});
}
void Check(const MapReader& map, PointMassText& mass);

template <class Io, Either<BoxDef, BoxText> Box>
void Keys(Io& io, Box& b) {
  io.Map("box", "builder.box",
         "Solid box. At a node: give `size_m` or `half_extents_m`; its edges are parallel to the "
         "part's axes. Along a pair of nodes: give `width_m` and `height_m`; its length is the "
         "distance of the nodes, and its width is horizontal in the part's frame.");
  io("name", b.name, kResolvedOnly);
  io("body", b.body, kResolvedOnly);
  io("center_m", b.center_m, kResolvedOnly);
  io("orientation", b.orientation, kResolvedOnly);
  if constexpr (!Io::kResolved) {
    io.Rule(R"("oneOf": [{"required": ["size_m"]}, {"required": ["half_extents_m"]}, )"
            R"({"required": ["width_m", "height_m"]}])");
    io.Rule(R"("anyOf": [{"required": ["mass_kg"]}, {"required": ["density_kg_per_m3"]}, )"
            R"({"required": ["mass_kg_per_m"]}])");
    io("size_m", b.size_m, kInherited, Bound::kPositive, "Edge lengths of the box.");
  }
  io("half_extents_m", b.half_extents_m, kInherited, Bound::kPositive,
     "Half the edge lengths of the box.");
  if constexpr (Io::kResolved) {
    io("material", b.material);
  } else {
    io("rotate", b.rotate, "Rotation in the part's frame, at a node.");
    io("width_m", b.width_m, Bound::kPositive, "Width of a box along a pair.");
    io("height_m", b.height_m, Bound::kPositive, "Height of a box along a pair.");
    MassKeys(io, b.mass, Along::kEither);
    SurfaceKeys(io, b.surface);
  }
  io("collides", b.collides, kCollidesMeaning);
}
void Check(const MapReader& map, BoxText& box);

template <class Io, Either<HullDef, ConvexText> Convex>
void Keys(Io& io, Convex& c) {
  io.Map("convex", "builder.convex",
         "Convex solid at a node, along the part's axes: the objects of a file, each of which "
         "collides as its convex hull, or the convex hull of given corners.",
         R"({"file": "foot.obj", "scale_m": 0.001, "density_kg_per_m3": 1200})");
  io("name", c.name, kResolvedOnly);
  io("body", c.body, kResolvedOnly);
  if constexpr (!Io::kResolved) {
    io.OneOf({"file", "corners_m"});
    io("file", c.file,
       "Wavefront OBJ or STL file, text or binary, relative to the model's folder; its origin is "
       "at the node. The mass follows from the volume that each object encloses; contacts use the "
       "hull of "
       "each object, with at most its 64 outermost corners.");
    io("scale_m", c.scale_m, kInherited, Bound::kPositive,
       "Length of one unit of the file: 0.001 for mm. Only with `file`.");
  }
  io("corners_m", c.corners_m, "Corners relative to the node, at least 4 and at most 64.");
  if constexpr (Io::kResolved) {
    io("material", c.material);
  } else {
    MassKeys(io, c.mass, Along::kNothing);
    SurfaceKeys(io, c.surface);
  }
  io("collides", c.collides, kCollidesMeaning);
}
void Check(const MapReader& map, ConvexText& convex);

template <class Io>
void Keys(Io& io, Like<AnchorText> auto&) {
  io.Map(
      "anchor", "builder.anchor",
      "Anchor that fixes a node and its body in the world. An anchor has no keys: `anchor: {}`.");
}

template <class Io>
void Keys(Io& io, Like<BuilderText> auto& b) {
  io.Map("builder", "builders",
         "Builder that makes one of the elements below from nodes or pairs with certain tags. "
         "Solids that share nodes are welded into one rigid body.");
  io("match", b.match, kNeeded,
     "Selector of nodes or pairs. `a`: all with the tag a. `[a, b]`: all with both tags. `[[a, b], "
     "[c]]`: all that have all tags of at least one set, here a and b, or c. A selector that "
     "matches nothing, whatever the number of copies, is an error.");
  io.OneOf({"rod", "sphere", "point_mass", "box", "convex", "cable", "bar", "anchor", "joint",
            "support"});
  io("rod", b.rod);
  io("sphere", b.sphere);
  io("point_mass", b.point_mass);
  io("box", b.box);
  io("convex", b.convex);
  io("cable", b.cable);
  io("bar", b.bar);
  io("anchor", b.anchor);
  io("joint", b.joint);
  io("support", b.support);
}
void Check(const MapReader& map, BuilderText& builder);

template <class Io>
void Keys(Io& io, Like<ModelText> auto& m) {
  io.Map("", "Model file",
         "A model file defines a robot: nodes and pairs of nodes with tags, and builders that make "
         "rods, cables, spheres ... from nodes and pairs with certain tags. Parts can be placed, "
         "repeated and connected.");
  HeadKeys(
      io, m,
      {"Name of the robot. Required unless the `base` file has it.",
       "Description of the robot, in a sentence or two.",
       "Another model file to inherit from, relative to this file's folder. Each key of this file "
       "replaces the whole key of the base, except that `parameters` are merged by name.",
       R"("tetraspine3.yaml")",
       "Named numbers for expressions in this file. Parameters may refer to each other, in any "
       "order; an "
       "experiment's `set` and `--set name=value` on the command line override them.",
       R"({"edge_m": 0.38, "height_m": "sqrt(3) / 2 * edge_m"})"});
  io("parts", m.parts_text, kName,
     "Groups of nodes and pairs by name, for placement in `structure`.");
  io("nodes", m.loose.nodes_text, kName,
     "Nodes by name in the world frame, in addition to the nodes of placed parts.");
  io("pairs", m.loose.pairs_text,
     "Pairs of nodes; placed nodes have full names, such as segment_0.tip.");
  io("structure", m.structure, "Placements of parts.");
  io.Rule(R"("anyOf": [{"required": ["nodes"]}, {"required": ["structure"]}])");
  io("builders", m.builders,
     "Builders of elements from nodes and pairs. Each pair needs exactly one builder; a node may "
     "have none, or several of different kinds.");
  io("apart", m.apart,
     "Lists of names of bodies, one list per group. Bodies in the same list do not collide with "
     "each other. Bodies that a joint connects do not collide either, unless the joint has "
     "`collides: true`.",
     Example{R"([["upper_leg", "foot"]])"});
  io("gravity_m_per_s2", m.def.gravity_m_per_s2, "Gravity in the world frame.");
  io("contact", m.def);
  io("inertia", m.inertia, kInertiaLaws, kInertiaMeaning);
  io("damping_law", m.damping_law, kDampingLaws, kDampingMeaning);
  io("actuator", m.actuator_text,
     "Actuator that replaces the `actuator` in all cable builders that have this key. Use it in "
     "files with a `base`.");
  io("allow_disconnected", m.allow_disconnected,
     "Whether to allow bodies that no cable or joint connects to the other bodies. If `false`, "
     "such bodies are an error.");
}
void Check(const MapReader& map, ModelText& model);

}  // namespace taut::description
