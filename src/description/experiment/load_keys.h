/// The keys of load cases.
#pragma once

#include "description/experiment/experiment_text.h"
#include "description/yaml/keys.h"

namespace taut::description {

template <class Io, Either<LoadCaseSpec::NodeForce, NodeForceText> Force>
void Keys(Io& io, Force& f) {
  io.Map("force", "load_case.force", "A force on a node, which stands still.",
         R"({"node": "top", "force_n": [0, 0, -100]})");
  if constexpr (Io::kResolved) {
    io("node", f.node);
  } else {
    io("node", f.node_name, kNeeded, "The node that it acts on, such as segment_0.tip.");
  }
  io("force_n", f.force_n, kNeeded, "The force, in the world frame.");
}

template <class Io, Either<LoadCaseSpec::Settlement, SettlementText> Settlement>
void Keys(Io& io, Settlement& s) {
  io.Map("settlement", "load_case.settlement", "How far the ground under a support has moved.",
         R"({"support": "foot", "by_m": [0, 0, -0.01]})");
  if constexpr (Io::kResolved) {
    io("joint", s.joint);
  } else {
    io("support", s.support, kNeeded,
       "The support: the name of its node, or of a joint with a node of the world.");
  }
  io("by_m", s.by_m, kNeeded, "How far its point of the world moves, in the world frame.");
}

template <class Io>
void Keys(Io& io, Like<LoadCaseSpec::Lengthening> auto& l) {
  io("index", l.index);
  io("by_m", l.by_m);
}

inline constexpr const char* kMembersMeaning =
    "Which cables and bars, by their names and tags, as controllers select cables.";

template <class Io>
void Keys(Io& io, Like<RestLengthText> auto& r) {
  io.Map(
      "rest_lengths", "load_case.rest_length",
      "How much longer than the model says cables and bars are without stress: what a turnbuckle "
      "does, or a member of another length than planned.",
      R"({"members": "inner", "by_m": -0.005})");
  io("members", r.members, kNeeded, kMembersMeaning);
  io.OneOf({"by_m", "by_ratio"});
  io("by_m", r.by_m, Bound::kAny, "What the rest length gains; negative shortens.");
  io("by_ratio", r.by_ratio, Bound::kAny,
     "What it gains over what it is: -0.01 shortens by a hundredth.");
}

template <class Io>
void Keys(Io& io, Like<TemperatureText> auto& t) {
  io.Map("temperatures", "load_case.temperature",
         "How much warmer than the model says cables and bars are. Their rest lengths gain "
         "`expansion_per_k` times that times what they are.",
         R"({"members": "strut", "by_k": 30})");
  io("members", t.members, kNeeded, kMembersMeaning);
  io("by_k", t.by_k, kNeeded, Bound::kAny, "By how many kelvins; negative cools.");
}

template <class Io, Either<LoadCaseSpec, LoadCaseText> LoadCase>
void Keys(Io& io, LoadCase& c) {
  io.Map("load_case", "load_case",
         "Loads that stand still, for `taut analyze`; a run does not know of them. Changes of one "
         "member's length add up.",
         R"({"name": "wind", "forces": [{"node": "top", "force_n": [50, 0, 0]}]})");
  io("name", c.name, kNeeded, kName, "Name of the load case.");
  io("weight", c.weight, "Whether gravity acts, too.");
  io("forces", c.forces, "Forces on nodes.");
  io("settlements", c.settlements, "What the ground under supports has done.");
  if constexpr (Io::kResolved) {
    io("cables", c.cables);
    io("bars", c.bars);
  } else {
    io("rest_lengths", c.rest_lengths, "Cables and bars of other lengths.");
    io("temperatures", c.temperatures, "Cables and bars of other temperatures.");
  }
}

}  // namespace taut::description
