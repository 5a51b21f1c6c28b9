/// Keys of load cases.
#pragma once

#include "description/experiment/experiment_text.h"
#include "description/yaml/keys.h"

namespace taut::description {

template <class Io, Either<LoadCaseSpec::NodeForce, NodeForceText> Force>
void Keys(Io& io, Force& f) {
  io.Map("force", "load_case.force", "Constant force on a node.",
         R"({"node": "top", "force_n": [0, 0, -100]})");
  if constexpr (Io::kResolved) {
    io("node", f.node);
  } else {
    io.OneOf({"node", "nodes"});
    io("node", f.node_name, "Node on which the force acts, such as segment_0.tip.");
    io("nodes", f.nodes,
       "Selector of nodes by names and tags; the force acts on each of these nodes.");
  }
  io("force_n", f.force_n, kNeeded, "Force in the world frame.");
}

template <class Io>
void Keys(Io& io, Like<LineLoadText> auto& l) {
  io.Map(
      "line_load", "load_case.line_load",
      "Load per length of members, such as wind or snow. Half of each member's load acts on each "
      "of its end nodes.",
      R"({"members": "deck", "force_n_per_m": [0, 0, -200]})");
  io("members", l.members, kNeeded,
     "Selector of cables and bars by names and tags, as for controllers, or of rods by name.");
  io("force_n_per_m", l.force_n_per_m, kNeeded,
     "Force per length of the member in the described pose, in the world frame.");
}

template <class Io>
void Keys(Io& io, Like<AreaLoadText> auto& a) {
  io.Map("area_load", "load_case.area_load",
         "Pressure on a surface, such as wind or snow. The surface consists of the triangles and "
         "the flat quadrilaterals that members form, except those that other selected members "
         "divide. Faces that are parallel to the direction, and faces whose middle is behind "
         "another face, have no load. Forces on the corners have the same resultant and moment as "
         "the pressure.",
         R"({"nodes": "roof", "pressure_pa": 800, "direction": [0, 0, -1], "projected": true})");
  io.OneOf({"members", "nodes"});
  io("members", a.members,
     "Selector of cables and bars, as for controllers, and of rods, by their names: the edges of "
     "the surface.");
  io("nodes", a.nodes,
     "Selector of nodes by names and tags; the edges are all members between these nodes.");
  io("pressure_pa", a.pressure_pa, kNeeded, Bound::kAny, "Pressure; negative: suction.");
  io("direction", a.direction, kNeeded, kDirection,
     "Direction of the wind or of the falling snow, in the world frame.");
  io("projected", a.projected,
     "Snow: the pressure acts on the area projected along the direction, and the force has this "
     "direction. Otherwise, as for wind, the pressure acts on the area itself, normal to the "
     "surface, on the side that the direction hits.");
}

template <class Io, Either<LoadCaseSpec::Settlement, SettlementText> Settlement>
void Keys(Io& io, Settlement& s) {
  io.Map("settlement", "load_case.settlement", "Displacement of the ground under a support.",
         R"({"support": "foot", "by_m": [0, 0, -0.01]})");
  if constexpr (Io::kResolved) {
    io("joint", s.joint);
  } else {
    io("support", s.support, kNeeded,
       "Name of the support's node, or of a joint with a node of the world.");
  }
  io("by_m", s.by_m, kNeeded,
     "Displacement of the point of the world to which the support is attached, in the world "
     "frame.");
}

template <class Io>
void Keys(Io& io, Like<LoadCaseSpec::Lengthening> auto& l) {
  io("index", l.index);
  io("by_m", l.by_m);
}

inline constexpr const char* kMembersMeaning =
    "Selector of cables and bars by names and tags, as for controllers.";

template <class Io>
void Keys(Io& io, Like<RestLengthText> auto& r) {
  io.Map("rest_lengths", "load_case.rest_length",
         "Change of the unstressed length of cables and bars, by a turnbuckle or a manufacturing "
         "error.",
         R"({"members": "inner", "by_m": -0.005})");
  io("members", r.members, kNeeded, kMembersMeaning);
  io.OneOf({"by_m", "by_ratio"});
  io("by_m", r.by_m, Bound::kAny, "Change of the rest length; negative shortens.");
  io("by_ratio", r.by_ratio, Bound::kAny,
     "Relative change of the rest length: -0.01 shortens by a hundredth.");
}

template <class Io>
void Keys(Io& io, Like<TemperatureText> auto& t) {
  io.Map("temperatures", "load_case.temperature",
         "Change of temperature of cables and bars. The rest length of each member increases by "
         "the product of rest length, `expansion_per_k` and temperature change.",
         R"({"members": "strut", "by_k": 30})");
  io("members", t.members, kNeeded, kMembersMeaning);
  io("by_k", t.by_k, kNeeded, Bound::kAny, "Change of temperature [K]; negative cools.");
}

/// A factor on a weight that does not act is a mistake.
inline void Check(const MapReader& map, LoadCaseText& c) {
  if (c.weight || !map.Has("weight_factor")) return;
  map.Error("load_case.factor_without_weight", "weight_factor",
            "load_case.weight_factor has no effect with `weight: false`",
            "remove one of the two keys");
}

template <class Io, Either<LoadCaseSpec, LoadCaseText> LoadCase>
void Keys(Io& io, LoadCase& c) {
  io.Map("load_case", "load_case",
         "Static loads for `taut analyze`; `taut run` ignores them. If several entries change the "
         "length "
         "of the same member, the changes add up.",
         R"({"name": "wind", "forces": [{"node": "top", "force_n": [50, 0, 0]}]})");
  io("name", c.name, kNeeded, kName, "Name of the load case.");
  io("weight", c.weight, "Whether gravity acts.");
  io("weight_factor", c.weight_factor, LaterThan{1.0}, "Factor on gravity if `weight` is `true`.");
  io("forces", c.forces, "Forces on nodes.");
  io("settlements", c.settlements, "Settlements of the ground under supports.");
  if constexpr (Io::kResolved) {
    io("cables", c.cables);
    io("bars", c.bars);
  } else {
    io("rest_lengths", c.rest_lengths, "Changes of length of cables and bars.");
    io("temperatures", c.temperatures, "Changes of temperature of cables and bars.");
    io("line_loads", c.lines, "Loads per length of members.");
    io("area_loads", c.areas, "Pressures on surfaces between members.");
  }
  io("max_displacement_m", c.max_displacement_m, kLater, Bound::kPositive,
     "Largest allowed displacement of any node from its position in the described pose.");
}

template <class Io>
void Keys(Io& io, Like<LoadCombinationText> auto& c) {
  io.Map("load_combination", "load_combination",
         "Sum of load cases, each multiplied by a factor: its forces, weight, settlements, and "
         "changes of length and temperature.",
         R"({"name": "uls", "factors": {"own_weight": 1.35, "wind": 1.5}})");
  io("name", c.name, kNeeded, kName, "Name, different from those of all load cases.");
  io("factors", c.factors, kNeeded, "Factors of load cases, by name of the load case.");
  io("max_displacement_m", c.max_displacement_m, Bound::kPositive,
     "Largest allowed displacement of any node from its position in the described pose.");
}

}  // namespace taut::description
