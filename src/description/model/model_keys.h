/// The keys of a model file, and what of them is in a resolved experiment.
#pragma once

#include "description/model/cable_keys.h"
#include "description/model/joint_keys.h"
#include "description/model/member_keys.h"
#include "description/model/model_text.h"
#include "description/model/rotation.h"
#include "description/model/surface_keys.h"

namespace taut::description {

/// Of contacts: at `contact`, and at `model_options` of an experiment.
template <class Io>
void ContactKeys(Io& io, Like<ModelDef> auto& m) {
  io("friction_combine", m.friction_combine, kCombineRules,
     "How the friction coefficients of two touching surfaces become one.");
  io("restitution_combine", m.restitution_combine, kCombineRules,
     "How the restitutions of two touching surfaces become one.");
  io("friction_law", m.friction_law, kFrictionLaws,
     "In which directions friction acts. `cone`: both tangential directions, the exact Coulomb "
     "cone. `along_slip`: only along the velocity of sliding, as Bullet does by default; lets a "
     "robot creep sideways.");
}
template <class Io>
void Keys(Io& io, Like<ModelDef> auto& m) {
  io.Map("contact", "contact", "Laws of contact.");
  ContactKeys(io, m);
}
inline constexpr const char* kInertiaMeaning =
    "How a body's inertia follows from its parts. `exact`: the sum of the parts' own. "
    "`bounding_box`: of bodies of several parts, that of a solid box of the body's mass and of the "
    "size of its bounding box at the start, as Bullet takes it for compounds.";
inline constexpr const char* kDampingMeaning =
    "How the cables' dampers act. `exact`: b dl/dt, with a tension that is never negative. "
    "`clamped`: b dl/dt limited to the elastic force, as NTRT does.";
template <class Io>
void Keys(Io& io, Like<ModelOptions> auto& o) {
  io.Map("model_options", "model_options",
         "Laws of the model that this experiment replaces, so that one model can be run under the "
         "laws of another simulator. What is absent stays as the model says.");
  io("inertia", o.inertia, kInertiaLaws, kInertiaMeaning);
  io("damping_law", o.damping_law, kDampingLaws, kDampingMeaning);
  ContactKeys(io, o.def);
}

template <class Io>
void Keys(Io& io, Like<NodeText> auto& n) {
  io.Map("", "node", "A node in full. `tip: [x, y, z]` is short for `tip: {at_m: [x, y, z]}`.");
  io("at_m", n.at_m, kNeeded,
     "Its place, in the part's frame or, outside of parts, in the world frame.");
  io("tags", n.tags, "Tags for builders and controllers to match, besides the node's name.");
  io("fixed_to", n.fixed_to, kName,
     "Another node of the same part, whose body this node belongs to. For points of a body that "
     "no rod or box reaches.");
}
void Check(const MapReader& map, NodeText& node);
/// `[x, y, z]` alone. False if it is a map; a complaint, too, if it is neither.
bool ReadShort(const Value& value, const std::string& path, const Scope& scope, NodeText& out);

template <class Io>
void Keys(Io& io, Like<RouteText> auto& r) {
  io.Map("", "pair.route",
         "What a cable runs through or round: its two ends, eyelets, pulleys and drums. A node's "
         "name alone is an end or an eyelet without friction.",
         R"({"pulley": "wheel", "axis": [0, 1, 0], "radius_m": 0.05, "side": "left"})");
  io.OneOf({"eyelet", "pulley", "drum"});
  io("eyelet", r.eyelet, "The node where the cable slides through.");
  io("pulley", r.pulley,
     "The node in the middle of a wheel that the cable runs over, and that belongs to the node's "
     "body. Where the cable does not touch it, it passes by.");
  io("drum", r.drum, "The node in the middle of a wheel on whose rim the cable ends.");
  io("friction", r.friction, Bound::kNonNegative,
     "mu: before it slips here, the tensions on both sides may differ by the factor exp(mu times "
     "the angle by which the cable turns). Not at an end.");
  io("axis", r.axis, kDirection,
     "Of a pulley or drum, in the part's frame; in the world's if the pair joins several parts.");
  io("radius_m", r.radius_m, Bound::kPositive, "Of a pulley or drum, to the cable's middle.");
  io("side", r.left, kSides,
     "Of a pulley or drum: on which side of it the wheel is to who goes along the cable, with the "
     "axis upwards. Round a wheel on the `left` it goes counter-clockwise.");
  io("turns", r.turns, Bound::kNonNegative,
     "Of a pulley: whole turns more than it takes to get by. Of a drum: all that is wound up.");
}
void Check(const MapReader& map, RouteText& element);
/// A node's name alone. False if it is a map.
bool ReadShort(const Value& value, const std::string& path, const Scope& scope, RouteText& out);

template <class Io>
void Keys(Io& io, Like<PairsText> auto& p) {
  io.Map("", "pair", "Two nodes that something joins; or several such pairs with the same tags.",
         R"({"nodes": ["right", "left"], "tags": ["rod"]})");
  io("name", p.name, kName,
     "Name of what becomes of it, such as the cable; also a tag of it. If absent, the nodes' "
     "names: right-left.");
  io.OneOf({"nodes", "each", "route"});
  io.Rule(R"("not": {"required": ["name", "each"]})");
  io("nodes", p.nodes,
     "The nodes. A cable may have more than two: it slides through those in between.");
  io("each", p.each, "Instead of `nodes`: a list of pairs with the same tags.");
  io("route", p.route,
     "Instead of `nodes`, of a cable: its ends, eyelets with friction, pulleys and drums, in order "
     "along it.");
  io("tags", p.tags, "Tags for builders and controllers to match.");
}
void Check(const MapReader& map, PairsText& pairs);

template <class Io>
void Keys(Io& io, Like<PartText> auto& p) {
  io.Map("", "parts", "A group of nodes and pairs.");
  io("nodes", p.nodes_text, kNeeded, kName, "Its nodes by name, in the part's frame.");
  io("pairs", p.pairs_text, "Its pairs.");
}
void Check(const MapReader& map, PartText& part);

template <class Io>
void Keys(Io& io, Like<PlacementText> auto& p) {
  io.Map("structure", "structure",
         "A part in its place, once or repeated. A node of a placed part is called by the "
         "placement's name and its own: segment_0.tip.");
  io("part", p.part, kNeeded, "Which part.");
  io("name", p.name, kName, "Name of the placement; the part's if absent.");
  io("copies", p.copies, kInherited, Bound{.least = 1, .most = kMaxCopies},
     "How many copies. With it they are called name_0, name_1 ..., and their nodes and pairs also "
     "carry the copy's number as a tag and `first`, `middle` or `last` (a single copy is first and "
     "last).");
  io("at_m", p.at_m, "Where the part's origin (that of copy 0) goes.");
  io("rotate", p.rotate, "How the part (copy 0) is turned about its origin.");
  io("step_m", p.step_m, "From one copy's origin to the next, in the world frame.");
  io("step_rotate", p.step_rotate,
     "From one copy's orientation to the next, about axes of the world.");
  io("velocity_m_per_s", p.velocity_m_per_s,
     "Velocity of each copy's centre of mass at the start, in the world frame.");
  io("angular_velocity_rad_per_s", p.angular_velocity_rad_per_s,
     "Angular velocity of each copy as a whole, about its centre of mass, at the start, in the "
     "world frame.");
  io("tags", p.tags, "Tags that all its nodes and pairs carry besides their own.");
  io("connect", p.connect_text,
     "Pairs from each copy to the next: the first node on copy i, the second on copy i + 1 (of a "
     "longer cable, the third on copy i + 2). Named ones are called name_1, name_2 ...; they carry "
     "their number and `first`, `middle` or `last` as tags.");
  io("ring", p.ring, "Whether the last copy is connected to the first, too.");
  io.Rule(R"("dependentRequired": {"step_m": ["copies"], "step_rotate": ["copies"], )"
          R"("connect": ["copies"], "ring": ["copies"]})");
}
void Check(const MapReader& map, PlacementText& placement);

/// Whether what has the mass has a length.
enum class Along { kNothing, kPair, kEither };
template <class Io>
void MassKeys(Io& io, Like<MassText> auto& m, Along along) {
  if (along != Along::kEither) {
    std::vector<std::string> keys{"mass_kg", "density_kg_per_m3"};
    if (along == Along::kPair) keys.push_back("mass_kg_per_m");
    io.OneOf(keys);
  }
  io("mass_kg", m.mass_kg, Bound::kNonNegative, "Its mass.");
  io("density_kg_per_m3", m.density_kg_per_m3, Bound::kNonNegative,
     "Instead of `mass_kg`: its density.");
  if (along == Along::kNothing) return;
  io("mass_kg_per_m", m.mass_kg_per_m, Bound::kNonNegative,
     "Along a pair, instead of `mass_kg`: its mass per length.");
}
inline constexpr const char* kCollidesMeaning = "Whether it touches other things.";

template <class Io, Either<CapsuleDef, RodText> Rod>
void Keys(Io& io, Rod& r) {
  io.Map("rod", "builder.rod",
         "A solid cylinder along a pair, from node to node. What it touches feels a capsule: round "
         "ends of the same radius.");
  io("name", r.name, kResolvedOnly);
  io("body", r.body, kResolvedOnly);
  io("from_m", r.from_m, kResolvedOnly);
  io("to_m", r.to_m, kResolvedOnly);
  io("radius_m", r.radius_m, kNeeded, Bound::kPositive, "Its radius.");
  if constexpr (Io::kResolved) {
    io("material", r.material);
  } else {
    io("class_k", r.class_k,
       "Whether rods that share a node are joined there by ball joints, instead of being welded.");
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
  io.Map("sphere", "builder.sphere", "A solid sphere at a node.");
  io("name", s.name, kResolvedOnly);
  io("body", s.body, kResolvedOnly);
  io("center_m", s.center_m, kResolvedOnly);
  io("radius_m", s.radius_m, kNeeded, Bound::kPositive, "Its radius.");
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
  io.Map("point_mass", "builder.point_mass", "A mass at a node that touches nothing.");
  io("mass_kg", p.mass_kg, kNeeded, Bound::kPositive, "Its mass.");
  io("radius_m", p.radius_m, Bound::kNonNegative,
     "Radius of the solid sphere that gives it an inertia.");
  io("inertia_kg_m2", p.inertia_kg_m2,
     "Instead of `radius_m`: its moments of inertia about the node, [xx, yy, zz] along the part's "
     "axes, or [xx, yy, zz, xy, xz, yz], entries of the matrix.",
     Example{"[0.02, 0.02, 0.001]"});
}
void Check(const MapReader& map, PointMassText& mass);

template <class Io, Either<BoxDef, BoxText> Box>
void Keys(Io& io, Box& b) {
  io.Map("box", "builder.box",
         "A solid box. With `size_m` or `half_extents_m` at a node, its axes those of the part. "
         "With `width_m` and `height_m` along a pair: its length from node to node, its width "
         "level in the part's frame.");
  io("name", b.name, kResolvedOnly);
  io("body", b.body, kResolvedOnly);
  io("center_m", b.center_m, kResolvedOnly);
  io("orientation", b.orientation, kResolvedOnly);
  if constexpr (!Io::kResolved) {
    io.Rule(R"("oneOf": [{"required": ["size_m"]}, {"required": ["half_extents_m"]}, )"
            R"({"required": ["width_m", "height_m"]}])");
    io.Rule(R"("anyOf": [{"required": ["mass_kg"]}, {"required": ["density_kg_per_m3"]}, )"
            R"({"required": ["mass_kg_per_m"]}])");
    io("size_m", b.size_m, kInherited, Bound::kPositive, "Its edge lengths.");
  }
  io("half_extents_m", b.half_extents_m, kInherited, Bound::kPositive, "Half its edge lengths.");
  if constexpr (Io::kResolved) {
    io("material", b.material);
  } else {
    io("rotate", b.rotate, "At a node: how it is turned in the part's frame.");
    io("width_m", b.width_m, Bound::kPositive, "Its width along a pair.");
    io("height_m", b.height_m, Bound::kPositive, "Its height along a pair.");
    MassKeys(io, b.mass, Along::kEither);
    SurfaceKeys(io, b.surface);
  }
  io("collides", b.collides, kCollidesMeaning);
}
void Check(const MapReader& map, BoxText& box);

template <class Io, Either<HullDef, ConvexText> Convex>
void Keys(Io& io, Convex& c) {
  io.Map("convex", "builder.convex",
         "A solid with flat faces at a node, its axes those of the part: from a file, of which "
         "every object touches as its convex hull, or what some corners span.",
         R"({"file": "foot.obj", "scale_m": 0.001, "density_kg_per_m3": 1200})");
  io("name", c.name, kResolvedOnly);
  io("body", c.body, kResolvedOnly);
  if constexpr (!Io::kResolved) {
    io.OneOf({"file", "corners_m"});
    io("file", c.file,
       "Wavefront OBJ or STL, text or binary, from the model's folder; its origin is at the node. "
       "What weighs is what each of its objects encloses, what touches the hull of each: with 64 "
       "corners at most, the outermost ones.");
    io("scale_m", c.scale_m, kInherited, Bound::kPositive,
       "What 1 in the file is: 0.001 if it is in mm. Goes with a file.");
  }
  io("corners_m", c.corners_m, "Corners from the node, four at least and 64 at most.");
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
  io.Map("anchor", "builder.anchor",
         "Fixes a node, and the body that it belongs to, in the world. It has no keys: `anchor: "
         "{}`.");
}

template <class Io>
void Keys(Io& io, Like<BuilderText> auto& b) {
  io.Map("builder", "builders",
         "What becomes of the nodes or pairs that carry some tags: one of the kinds below. Solids "
         "that share nodes weld into one rigid body.");
  io("match", b.match, kNeeded,
     "Which nodes or pairs. `a`: all that carry the tag a. `[a, b]`: all that carry both tags. "
     "`[[a, b], [c]]`: all that carry any of these sets. What no number of copies could match is "
     "an error.");
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
         "What a robot is made of: nodes and pairs of nodes with tags, and builders that turn what "
         "carries their tags into rods, cables, spheres ... Parts can be placed, repeated and "
         "connected.");
  HeadKeys(io, m,
           {"Name of the robot. Needed unless `base` has it.",
            "What the robot is, in a sentence or two.",
            "Another model file, seen from this file's folder. This file then holds only what "
            "differs: each of its keys replaces the base's as a whole, except that `parameters` "
            "are merged by name.",
            R"("tetraspine3.yaml")",
            "Named numbers for expressions in this file. They may refer to each other, in any "
            "order; an experiment's `set` and `--set name=value` on the command line replace them.",
            R"({"edge_m": 0.38, "height_m": "sqrt(3) / 2 * edge_m"})"});
  io("parts", m.parts_text, kName, "Groups of nodes and pairs that `structure` places, by name.");
  io("nodes", m.loose.nodes_text, kName,
     "Nodes in the world frame, by name, besides those of the placed parts.");
  io("pairs", m.loose.pairs_text,
     "Pairs of nodes; placed nodes are called by their full name, such as segment_0.tip.");
  io("structure", m.structure, "Where the parts go.");
  io.Rule(R"("anyOf": [{"required": ["nodes"]}, {"required": ["structure"]}])");
  io("builders", m.builders,
     "What becomes of the nodes and pairs. Each pair must be built by exactly one builder; a node "
     "by none or by several of different kinds.");
  io("apart", m.apart,
     "Lists of bodies, by their names, of which none touches another of the same list. Bodies that "
     "a joint joins do not touch each other anyway, unless it says `collides: true`.",
     Example{R"([["upper_leg", "foot"]])"});
  io("gravity_m_per_s2", m.def.gravity_m_per_s2, "Gravity in the world frame.");
  io("contact", m.def);
  io("inertia", m.inertia, kInertiaLaws, kInertiaMeaning);
  io("damping_law", m.damping_law, kDampingLaws, kDampingMeaning);
  io("actuator", m.actuator_text,
     "In place of the `actuator` of every cable whose builder has one: for files with a `base`.");
  io("allow_disconnected", m.allow_disconnected,
     "Whether bodies that no cable or joint joins to the others are meant. An error if false.");
}
void Check(const MapReader& map, ModelText& model);

}  // namespace taut::description
