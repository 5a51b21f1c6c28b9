/// Actuator and spring sizing: demands of a run on motors and springs, and products of a catalog
/// that meet them (docs/cli.md).
///
/// Threads: any number may call these functions concurrently.
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

/// Demand on the motor and spring of one cable. Means are over time, from the rows of the trace.
/// Peaks and energies include all steps if the run has a summary.
struct CableDemand {
  std::string cable;
  bool actuated = false;
  double peak_force_n = 0, rms_force_n = 0;  ///< Peak and RMS of the tension.
  /// Speed of the rest length, in both directions.
  double peak_speed_m_per_s = 0, rms_speed_m_per_s = 0;
  double peak_power_w = 0;    ///< Largest product of tension and winding-in speed.
  double rms_power_w = 0;     ///< RMS of tension times speed, in both directions.
  double gross_energy_j = 0;  ///< Work of winding in.
  double net_energy_j = 0;    ///< `gross_energy_j` minus the work recovered while unwinding.
  double wound_m = 0;         ///< Longest minus shortest rest length.
  double stiffness_n_per_m = 0;
  double peak_elastic_n = 0;  ///< Largest k (l - L).
  double stretch_m = 0;       ///< Largest l - L, the required travel of a spring.
};

struct RunDemand {
  std::string experiment;
  double from_s = 0, to_s = 0;
  std::size_t rows = 0;
  bool every_step = false;  ///< Whether peaks include all steps or only rows.
  std::vector<CableDemand> cables;
};

/// Returns the demand of a run from a trace of this experiment. If channels are missing, returns
/// nothing and adds errors that name `path`.
std::optional<RunDemand> DemandOf(const Trace& trace, const ExperimentSpec& experiment,
                                  const std::string& path, Diagnostics& out);

/// Returns the demand of the run in a folder, from its trace.h5, inputs.yaml and, if it exists,
/// summary.json. If a file cannot be read or lacks data, returns nothing and adds errors.
std::optional<RunDemand> DemandOfRun(const std::string& folder, Diagnostics& out);

/// Available value of a motor or spring divided by the demand of a cable; infinite without demand.
struct Margin {
  /// Motors: "peak torque", "rated torque", "speed", "peak power", "rated power"; springs: "force",
  /// "travel".
  std::string of;
  double factor = 0;
};
/// Suitability of a motor or spring for a cable.
struct SizingMargins {
  std::string name;  ///< Name of the motor or spring.
  bool fits = false;
  std::vector<Margin> margins;
  Margin least;              ///< Smallest of `margins`.
  double stiffness_off = 0;  ///< Springs: relative deviation from the stiffness of the cable.
  double spool_turns = 0;    ///< Motors: turns of the spool for `wound_m`.
};

/// Evaluates a motor with a spool of this radius [m] for a cable. The motor fits if all margins are
/// at least `factor`.
SizingMargins SizingMarginsOf(const CatalogueMotor& motor, double spool_radius_m, double factor,
                              const CableDemand& cable);
/// Evaluates a spring in series with an inextensible cable. The spring fits if all margins are at
/// least `factor`, and the relative difference between the stiffnesses of spring and cable is at
/// most `stiffness_tolerance`.
SizingMargins SizingMarginsOf(const CatalogueSpring& spring, double factor,
                              double stiffness_tolerance, const CableDemand& cable);

}  // namespace taut
