/// What studies and learners are to get more of, and by how much their worlds differ.
#pragma once

#include "description/yaml/keys.h"
#include "taut/objective.h"
#include "taut/variation.h"

namespace taut::description {

inline const Choices<Measure> kMeasures{{"distance", Measure::kDistance},
                                        {"heading", Measure::kHeading},
                                        {"distance_per_energy", Measure::kDistancePerEnergy},
                                        {"nearer", Measure::kNearer},
                                        {"tracking", Measure::kTracking}};

template <class Io>
void Keys(Io& io, Like<TensionLimit> auto& t) {
  io.Map("", "tension_limit", "A penalty for pulling too hard.");
  io("limit_n", t.limit_n, kNeeded, Bound::kPositive, "What any cable may pull at most.");
  io("penalty_per_n", t.penalty_per_n, kNeeded, Bound::kNonNegative,
     "What the score loses for each newton by which the largest tension exceeds it, in the score's "
     "unit.");
}
template <class Io>
void Keys(Io& io, Like<FallSpec> auto& f) {
  io.Map("", "fall",
         "A penalty for falling over. Looked at every 0.1 s; in an environment after every period, "
         "and "
         "there the episode ends.");
  io("max_tilt_rad", f.max_tilt_rad,
     Bound{.least = 0.0,
           .most = FallSpec{}.max_tilt_rad + 1e-12,
           .above_least = true,
           .most_text = "pi"},
     "How far any body may tilt from its start.");
  io("min_height_m", f.min_height_m, "How low the centre of mass may get.");
  io("max_height_m", f.max_height_m, "How high the centre of mass may get.");
  io("penalty", f.penalty, kNeeded, Bound::kNonNegative,
     "What the score of a world loses once it has fallen.");
}
void Check(const MapReader& map, FallSpec& fall);
/// All of an objective but its measure.
template <class Io>
void ObjectiveKeys(Io& io, auto& o) {
  io("direction", o.direction, kDirection, kInherited, "For `heading`, in the world frame.",
     Example{"[0, 1, 0]"});
  io("from_s", o.from_s, Bound::kNonNegative, "From when on the way counts.");
  io("tension_limit", o.tension_limit);
  io("fall", o.fall);
  io("max_speed_m_per_s", o.max_speed_m_per_s, Bound::kPositive,
     "A world with a body faster than this counts as blown up and fails.");
}
/// What more an objective needs that a file says in `map`.
void CheckObjective(const MapReader& map, const ObjectiveSpec& objective);

inline constexpr Bound kShare{
    .least = 0.0, .most = 1.0, .below_most = true, .hint = "0.2 means factors from 0.8 to 1.2"};
template <class Io>
void VariationKeys(Io& io, auto& w) {
  io("friction", w.friction, kShare,
     "Friction differs by up to this share: 0.2 means factors from 0.8 to 1.2.");
  io("mass", w.mass, kShare, "So do all masses together.");
  io("stiffness", w.stiffness, kShare, "So do the stiffnesses of all cables together.");
  io("damping", w.damping, kShare, "So do their dampings.");
  io("start", w.start);
}

}  // namespace taut::description
