/// Keys of catalogue files.
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
  io.Map(
      "motor", "motors",
      "Motor with gear and spool. Torques, speeds and powers are at the motor, before the gear.");
  io("gear_ratio", m.values.gear_ratio, Bound::kPositive,
     "Turns of the motor per turn of the spool.");
  io("gear_efficiency", m.values.gear_efficiency, Bound{.least = 0.01, .most = 1},
     "Share of the motor's torque that reaches the spool while winding in.");
  io("spool_radius_m", m.values.spool_radius_m, Bound::kPositive,
     "Radius of the spool, to the cable's center line. `taut size --spool_radius_m` overrides it "
     "for "
     "all motors.");
  io("rated_torque_n_m", m.values.rated_torque_n_m, kNeeded, Bound::kPositive,
     "Continuous torque.");
  io("peak_torque_n_m", m.values.peak_torque_n_m, kNeeded, Bound::kPositive, "Peak torque.");
  io("max_speed_rad_per_s", m.values.max_speed_rad_per_s, kNeeded, Bound::kPositive,
     "Speed at the rated torque.");
  io("rated_power_w", m.values.rated_power_w, Bound::kPositive,
     "Continuous shaft power. Default: not checked.");
  io("peak_power_w", m.values.peak_power_w, Bound::kPositive,
     "Peak shaft power. Default: not checked.");
  io("mass_kg", m.values.mass_kg, Bound::kPositive,
     "Mass of motor, gear and spool. The lightest suitable motor is listed first.");
}
void Check(const MapReader& map, CatalogueMotorText& motor);

struct CatalogueSpringText {
  CatalogueSpring values;
};
template <class Io>
void Keys(Io& io, Like<CatalogueSpringText> auto& s) {
  io.Map("spring", "springs", "Spring in series with a cable.");
  io("stiffness_n_per_m", s.values.stiffness_n_per_m, kNeeded, Bound::kPositive,
     "Stiffness of the spring.");
  io("largest_travel_m", s.values.largest_travel_m, kNeeded, Bound::kPositive,
     "Largest extension of the spring.");
  io("largest_force_n", s.values.largest_force_n, kNeeded, Bound::kPositive,
     "Largest tension of the spring.");
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
  io.Map("", "Catalogue",
         "A catalogue lists the motors and springs from which a robot can be built.");
  HeadKeys(
      io, s,
      {"Name of the catalogue. Required unless the `base` file has it.", "Source of the figures.",
       "Another catalogue to inherit from, relative to this file's folder. Each key of this file "
       "replaces the whole key of the base, except that `parameters` are merged by name.",
       R"("first_catalogue.yaml")",
       "Named numbers for expressions in this file. Parameters may refer to each other, in any "
       "order.",
       R"({"rpm": "2 * pi / 60"})"});
  io("factor", s.factor, Bound::kPositive,
     "Safety factor: smallest allowed ratio of rating to requirement.");
  io("stiffness_tolerance", s.stiffness_tolerance, Bound{.least = 0, .most = 10},
     "Largest allowed difference between the stiffness of a spring and of the cable, relative to "
     "the cable's stiffness.");
  io("motors", s.motors, kName, "Motors by name.");
  io("springs", s.springs, kName, "Springs by name.");
}
void Check(const MapReader& map, CatalogueFileText& catalogue);

}  // namespace taut::description
