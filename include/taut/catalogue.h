/// Catalogs of commercial motors and springs for the sizing of a robot (docs/formats/catalogue.md).
///
/// Threads: any number may call these functions concurrently.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut {

/// Motor with gear and spool.
struct CatalogueMotor {
  std::string name;
  double gear_ratio = 1.0;               ///< Turns of the motor per turn of the spool, > 0.
  double gear_efficiency = 1.0;          ///< Efficiency while winding in, 0..1.
  std::optional<double> spool_radius_m;  ///< Radius to the center line of the cable, > 0.
  // Values at the motor shaft, before the gear.
  double rated_torque_n_m = 0.0;                      ///< Continuous torque, > 0.
  double peak_torque_n_m = 0.0;                       ///< Short-time torque, > 0.
  double max_speed_rad_per_s = 0.0;                   ///< At the rated torque, > 0.
  std::optional<double> rated_power_w, peak_power_w;  ///< Continuous and peak shaft power, > 0.
  std::optional<double> mass_kg;
};

struct CatalogueSpring {
  std::string name;
  double stiffness_n_per_m = 0.0;  ///< Stiffness, > 0.
  double largest_travel_m = 0.0;   ///< Largest extension, > 0.
  double largest_force_n = 0.0;    ///< Largest tension, > 0.
};

struct Catalogue {
  std::string name, description;
  double factor = 1.0;  ///< Safety factor: smallest allowed ratio of available to required value.
  /// Allowed relative difference between the stiffnesses of a spring and the cable.
  double stiffness_tolerance = 0.1;
  std::vector<CatalogueMotor> motors;
  std::vector<CatalogueSpring> springs;
  std::vector<std::string> files{};  ///< All files read; the catalog file is first.
};

/// Reads a catalog. On an error, returns nothing and adds diagnostics.
std::optional<Catalogue> LoadCatalogue(const std::string& path, Diagnostics& out);

}  // namespace taut
