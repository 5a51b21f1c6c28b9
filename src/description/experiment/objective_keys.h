/// Keys of objectives and perturbations.
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
  io.Map("", "tension_limit", "Penalty for a large cable tension.");
  io("limit_n", t.limit_n, kNeeded, Bound::kPositive, "Largest allowed tension of any cable.");
  io("penalty_per_n", t.penalty_per_n, kNeeded, Bound::kNonNegative,
     "Score lost per newton by which the largest tension exceeds the limit, in the score's unit.");
}
template <class Io>
void Keys(Io& io, Like<FallSpec> auto& f) {
  io.Map("", "fall",
         "Penalty for falling over. A study checks for a fall every 0.1 s. An environment checks "
         "after every period, and a fall terminates "
         "the episode.");
  io("max_tilt_rad", f.max_tilt_rad,
     Bound{.least = 0.0,
           .most = FallSpec{}.max_tilt_rad + 1e-12,
           .above_least = true,
           .most_text = "pi"},
     "Largest allowed tilt of any body from its initial orientation.");
  io("min_height_m", f.min_height_m, "Smallest allowed height of the center of mass.");
  io("max_height_m", f.max_height_m, "Largest allowed height of the center of mass.");
  io("penalty", f.penalty, kNeeded, Bound::kNonNegative, "Score lost after a fall.");
}
void Check(const MapReader& map, FallSpec& fall);
/// All keys of an objective except its measure.
template <class Io>
void ObjectiveKeys(Io& io, auto& o) {
  io("direction", o.direction, kDirection, kInherited,
     "Direction for `heading`, in the world frame.", Example{"[0, 1, 0]"});
  io("from_s", o.from_s, Bound::kNonNegative, "Start of the scored time.");
  io("tension_limit", o.tension_limit);
  io("fall", o.fall);
  io("max_speed_m_per_s", o.max_speed_m_per_s, Bound::kPositive,
     "Speed of a body above which a world counts as diverged and fails.");
}
/// Reports a missing key in `map` that the objective's measure needs.
void CheckObjective(const MapReader& map, const ObjectiveSpec& objective);

inline constexpr Bound kShare{
    .least = 0.0, .most = 1.0, .below_most = true, .hint = "0.2 means factors from 0.8 to 1.2"};
template <class Io>
void VariationKeys(Io& io, auto& w) {
  io("friction", w.friction, kShare,
     "Largest relative change of friction: 0.2 means factors from 0.8 to 1.2.");
  io("mass", w.mass, kShare,
     "Largest relative change of the masses; one common factor applies to all.");
  io("stiffness", w.stiffness, kShare,
     "Largest relative change of the cable stiffnesses; one common factor applies to all.");
  io("damping", w.damping, kShare,
     "Largest relative change of the cable dampings; one common factor applies to all.");
  io("start", w.start);
}

}  // namespace taut::description
