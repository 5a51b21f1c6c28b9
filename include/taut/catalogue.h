/// Catalogues: motors and springs that one may buy, to size a robot with
/// (docs/formats/catalogue.md).
///
/// Threads: any number may call these functions at once.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut {

/// A motor with its gear and a spool on it.
struct CatalogueMotor {
  std::string name;
  double gear_ratio = 1.0;               ///< Turns of the motor per turn of the spool, > 0.
  double gear_efficiency = 1.0;          ///< Of winding in, 0..1.
  std::optional<double> spool_radius_m;  ///< To the cable's middle, > 0.
  // Of the motor, before the gear:
  double rated_torque_n_m = 0.0;                      ///< That it bears for ever, > 0.
  double peak_torque_n_m = 0.0;                       ///< > 0.
  double max_speed_rad_per_s = 0.0;                   ///< Under rated torque, > 0.
  std::optional<double> rated_power_w, peak_power_w;  ///< Of its shaft, > 0.
  std::optional<double> mass_kg;
};

struct CatalogueSpring {
  std::string name;
  double stiffness_n_per_m = 0.0;  ///< > 0.
  double largest_travel_m = 0.0;   ///< > 0.
  double largest_force_n = 0.0;    ///< > 0.
};

struct Catalogue {
  std::string name, description;
  double factor = 1.0;               ///< What there is over what is needed: at least so much.
  double stiffness_tolerance = 0.1;  ///< How far a spring's stiffness may be off, as a share.
  std::vector<CatalogueMotor> motors;
  std::vector<CatalogueSpring> springs;
  std::vector<std::string> files{};  ///< That were read, the file itself first.
};

/// Nothing if there was any error.
std::optional<Catalogue> LoadCatalogue(const std::string& path, Diagnostics& out);

}  // namespace taut
