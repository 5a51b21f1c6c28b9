/// Actuator and spring sizing: demands of a run on motors and springs, and which of a catalog meet
/// them (docs/cli.md).
///
/// Threads: any number may call these functions at once.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "taut/catalogue.h"
#include "taut/diagnostics.h"
#include "taut/spec.h"
#include "taut/trace.h"

namespace taut {

/// Demand on one cable's motor and spring. Means are over time, from the rows of the trace; peaks
/// and energies are over every step if the run has a summary.
struct CableDemand {
  std::string cable;
  bool actuated = false;
  double peak_force_n = 0, rms_force_n = 0;  ///< Tension.
  /// Of the rest length, in both directions.
  double peak_speed_m_per_s = 0, rms_speed_m_per_s = 0;
  double peak_power_w = 0;    ///< Largest product of tension and winding-in speed.
  double rms_power_w = 0;     ///< Of tension times speed in both directions.
  double gross_energy_j = 0;  ///< Work of winding in.
  double net_energy_j = 0;    ///< The same minus the work recovered while paying out.
  double wound_m = 0;         ///< Longest minus shortest rest length.
  double stiffness_n_per_m = 0;
  double peak_elastic_n = 0;  ///< Largest k (l - L).
  double stretch_m = 0;       ///< Largest l - L: travel of a spring.
};

struct RunDemand {
  std::string experiment;
  double from_s = 0, to_s = 0;
  std::size_t rows = 0;
  bool every_step = false;  ///< Whether peaks are over every step instead of rows only.
  std::vector<CableDemand> cables;
};

/// Returns the demand of a run from a trace of this experiment's cables. Returns nothing, with
/// errors that name `path`, if channels are missing.
std::optional<RunDemand> DemandOf(const Trace& trace, const ExperimentSpec& experiment,
                                  const std::string& path, Diagnostics& out);

/// Returns the demand of the run in a folder, from its trace.h5, inputs.yaml and, if it exists,
/// summary.json. Returns nothing, with errors, if they cannot be read or lack data.
std::optional<RunDemand> DemandOfRun(const std::string& folder, Diagnostics& out);

/// Capacity of a motor or spring divided by the demand of a cable; infinite without demand.
struct Margin {
  std::string of;  ///< "peak torque", "rated torque", "speed", "peak power", "rated power"; of a
                   ///< spring "force", "travel".
  double factor = 0;
};
/// Suitability of a motor or spring for a cable.
struct SizingMargins {
  std::string name;  ///< Of the motor or the spring.
  bool fits = false;
  std::vector<Margin> margins;
  Margin least;              ///< Smallest of `margins`.
  double stiffness_off = 0;  ///< Of a spring: relative deviation from the cable's stiffness.
  double spool_turns = 0;    ///< Of a motor: spool turns for `wound_m`.
};

/// Evaluates a motor with a spool of this radius [m]. It fits if all margins over the cable's
/// demand are at least `factor`.
SizingMargins SizingMarginsOf(const CatalogueMotor& motor, double spool_radius_m, double factor,
                              const CableDemand& cable);
/// Evaluates a spring in series with an inextensible cable. It fits if all margins are at least
/// `factor` and its stiffness is within `stiffness_tolerance` (relative) of the cable's.
SizingMargins SizingMarginsOf(const CatalogueSpring& spring, double factor,
                              double stiffness_tolerance, const CableDemand& cable);

}  // namespace taut
