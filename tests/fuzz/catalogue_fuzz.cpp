// Fuzz target of catalogs of motors and springs.
#include "taut/catalogue.h"

#include <cmath>

#include "fuzz/refusals.h"
#include "fuzz/text_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using taut::fuzz::Must;
  static const taut::fuzz::Folder folder;
  taut::Diagnostics out;
  const auto catalogue = taut::LoadCatalogue(folder.Write("input.yaml", data, size), out);
  taut::fuzz::CheckReading(catalogue.has_value(), out);
  if (!catalogue) return 0;
  const auto positive = [](double value, const std::string& name) {
    Must(value > 0 && std::isfinite(value), "a positive number of " + name);
  };
  Must(!catalogue->motors.empty() || !catalogue->springs.empty(), "something to choose from");
  for (const taut::CatalogueMotor& motor : catalogue->motors) {
    for (const double value : {motor.gear_ratio, motor.gear_efficiency, motor.rated_torque_n_m,
                               motor.peak_torque_n_m, motor.max_speed_rad_per_s}) {
      positive(value, motor.name);
    }
    for (const auto& value :
         {motor.spool_radius_m, motor.rated_power_w, motor.peak_power_w, motor.mass_kg}) {
      positive(value.value_or(1), motor.name);
    }
    Must(motor.peak_torque_n_m >= motor.rated_torque_n_m, "torques of " + motor.name);
  }
  for (const taut::CatalogueSpring& spring : catalogue->springs) {
    for (const double value :
         {spring.stiffness_n_per_m, spring.largest_travel_m, spring.largest_force_n}) {
      positive(value, spring.name);
    }
  }
  return 0;
}
