/// The keys of a catalogue.
#pragma once

#include <string>

#include "description/yaml/head_keys.h"
#include "description/yaml/keys.h"
#include "taut/catalogue.h"

namespace taut::description {

struct CatalogueMotorText {
  SourceRef at;
  bool good = true;
  CatalogueMotor values;
};
template <class Io>
void Keys(Io& io, Like<CatalogueMotorText> auto& m) {
  io.Map("motor", "motors",
         "A motor with its gear and a spool. Torques, speeds and powers are those of the motor, "
         "before the gear.");
  io("gear_ratio", m.values.gear_ratio, Bound::kPositive,
     "Turns of the motor per turn of the spool.");
  io("gear_efficiency", m.values.gear_efficiency, Bound{.least = 0.01, .most = 1},
     "What of the motor's torque arrives while it winds in.");
  io("spool_radius_m", m.values.spool_radius_m, Bound::kPositive,
     "Of the spool, to the middle of the cable. `taut size --spool_radius_m` says it for all.");
  io("rated_torque_n_m", m.values.rated_torque_n_m, kNeeded, Bound::kPositive,
     "Torque that it bears for ever.");
  io("peak_torque_n_m", m.values.peak_torque_n_m, kNeeded, Bound::kPositive,
     "Torque that it gives for a moment.");
  io("max_speed_rad_per_s", m.values.max_speed_rad_per_s, kNeeded, Bound::kPositive,
     "Speed that it reaches under the rated torque.");
  io("rated_power_w", m.values.rated_power_w, Bound::kPositive,
     "Power of its shaft that it bears for ever. Absent: not looked at.");
  io("peak_power_w", m.values.peak_power_w, Bound::kPositive,
     "Power of its shaft for a moment. Absent: not looked at.");
  io("mass_kg", m.values.mass_kg, Bound::kPositive,
     "Of motor, gear and spool: of motors that fit, the lightest is named first.");
}
void Check(const MapReader& map, CatalogueMotorText& motor);

struct CatalogueSpringText {
  CatalogueSpring values;
};
template <class Io>
void Keys(Io& io, Like<CatalogueSpringText> auto& s) {
  io.Map("spring", "springs", "A spring in line with a cable.");
  io("stiffness_n_per_m", s.values.stiffness_n_per_m, kNeeded, Bound::kPositive, "Of the spring.");
  io("largest_travel_m", s.values.largest_travel_m, kNeeded, Bound::kPositive,
     "How far it may be stretched.");
  io("largest_force_n", s.values.largest_force_n, kNeeded, Bound::kPositive,
     "What it may be pulled with.");
}

struct CatalogueForm {
  static constexpr const char* kSchema = R"("const": "catalogue")";
};
struct CatalogueFileText {
  Head<CatalogueForm> head;
  std::string name, description;
  double factor = Catalogue{}.factor, stiffness_tolerance = Catalogue{}.stiffness_tolerance;
  Named<CatalogueMotorText> motors;
  Named<CatalogueSpringText> springs;
};
template <class Io>
void Keys(Io& io, Like<CatalogueFileText> auto& s) {
  io.Map("", "Catalogue", "Motors and springs that a robot may be built with.");
  HeadKeys(
      io, s,
      {"Name of the catalogue. Needed unless `base` has it.", "Where the figures come from.",
       "Another catalogue, seen from this file's folder. This file then holds only what differs: "
       "each of its keys replaces the base's as a whole, except that `parameters` are merged by "
       "name.",
       R"("first_catalogue.yaml")",
       "Named numbers for expressions in this file. They may refer to each other, in any order.",
       R"({"rpm": "2 * pi / 60"})"});
  io("factor", s.factor, Bound::kPositive,
     "What there is over what is needed must be at least this.");
  io("stiffness_tolerance", s.stiffness_tolerance, Bound{.least = 0, .most = 10},
     "How far a spring's stiffness may be from the cable's, as a share of that.");
  io("motors", s.motors, kName, "Motors by name.");
  io("springs", s.springs, kName, "Springs by name.");
}
void Check(const MapReader& map, CatalogueFileText& catalogue);

}  // namespace taut::description
