/// What a run asks of motors and springs, and which of a catalogue bear it (docs/cli.md).
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

/// Of one cable. Means are over time, of the rows of the trace; peaks, and energies, over every
/// step where the run has a summary.
struct CableDemand {
  std::string cable;
  bool actuated = false;
  double peak_force_n = 0, rms_force_n = 0;              ///< Its tension.
  double peak_speed_m_per_s = 0, rms_speed_m_per_s = 0;  ///< Of its rest length, either way.
  double peak_power_w = 0;    ///< Tension times speed of winding in, the largest,
  double rms_power_w = 0;     ///< and of both ways.
  double gross_energy_j = 0;  ///< Work of winding in.
  double net_energy_j = 0;    ///< Less what paying out gave back.
  double wound_m = 0;         ///< Between its longest and its shortest rest length.
  double stiffness_n_per_m = 0;
  double peak_elastic_n = 0;  ///< k (l - L),
  double stretch_m = 0;       ///< and l - L then: a spring's travel.
};

struct RunDemand {
  std::string experiment;
  double from_s = 0, to_s = 0;
  std::size_t rows = 0;
  bool every_step = false;  ///< Whether peaks are of every step, and not of rows alone.
  std::vector<CableDemand> cables;
};

/// Of a trace of this experiment's cables. Nothing and complaints, which name `path`, if it lacks
/// something.
std::optional<RunDemand> DemandOf(const Trace& trace, const ExperimentSpec& experiment,
                                  const std::string& path, Diagnostics& out);

/// Of the run in a folder: its trace.h5, inputs.yaml and, if it is there, summary.json. Nothing and
/// complaints if they cannot be read or lack something.
std::optional<RunDemand> DemandOfRun(const std::string& folder, Diagnostics& out);

/// What there is over what a cable needs; infinite where nothing is needed.
struct Margin {
  std::string of;  ///< "peak torque", "rated torque", "speed", "peak power", "rated power"; of a
                   ///< spring "force", "travel".
  double factor = 0;
};
struct Fit {
  std::string name;  ///< Of the motor or the spring.
  bool fits = false;
  std::vector<Margin> margins;
  Margin least;              ///< The smallest of them.
  double stiffness_off = 0;  ///< A spring's, as a share of the cable's.
  double spool_turns = 0;    ///< A motor's, for what is wound.
};

/// Whether a motor bears what a cable asks for on a spool of that radius.
Fit FitOf(const CatalogueMotor& motor, double spool_radius_m, double factor,
          const CableDemand& cable);
/// Whether a spring in line with an unstretchable cable does.
Fit FitOf(const CatalogueSpring& spring, double factor, double stiffness_tolerance,
          const CableDemand& cable);

}  // namespace taut
