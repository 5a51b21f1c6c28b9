/// Run of an experiment: steps the world, runs controllers at their clocks, applies the timeline
/// and writes traces.
///
/// Threads: any number may call these functions concurrently, each with separate diagnostics,
/// traces and batches. Experiments are read-only. `RunOptions::progress` is called on the thread of
/// the caller.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "taut/plant.h"
#include "taut/safety.h"
#include "taut/start.h"
#include "taut/trace.h"

namespace taut {

/// Minimum, mean and maximum of a quantity over a time span.
struct Range {
  double mean = 0, min = 0, max = 0;
};

/// Summary of a `dc_motor`, to size supplies and to check temperatures.
struct MotorSummary {
  double energy_from_supply_j = 0;
  double energy_to_cable_j = 0;
  double energy_in_winding_j = 0;  ///< Heat in the winding.
  double max_current_a = 0;        ///< Largest magnitude of the winding current.
  double max_winding_temperature_c = 0;
};

/// Summary of one cable over all steps, not only recorded rows.
struct CableSummary {
  std::string name;
  struct Quantity {
    double max_n = 0;              ///< Maximum over the whole run.
    double max_after_start_n = 0;  ///< From t = 5 s to the end.
    std::vector<Range> phases;     ///< One per phase of the experiment [N].
  };
  Quantity tension;  ///< Spring and damper, as measured by a load cell.
  Quantity elastic;  ///< k (l - L) only, as logged by NTRT.
  /// Values for the sizing of motors; zero without an actuator.
  double max_force_n = 0;             ///< Largest tension that the actuator had to hold or move.
  double max_speed_m_per_s = 0;       ///< Largest rate of the rest length, in either direction.
  double max_power_w = 0;             ///< Largest product of tension and winding-in rate.
  double energy_j = 0;                ///< Work of winding in.
  double net_energy_j = 0;            ///< `energy_j` minus the work recovered while unwinding.
  std::optional<MotorSummary> motor;  ///< Only with a `dc_motor` in a simulation.
};

/// Extreme axial forces of a body that is one straight rod (`StrutForces`): over the rows of the
/// trace and along the rod; tension > 0.
struct StrutSummary {
  std::string name;
  double least_n = 0;     ///< Minimum; if negative, the largest compression.
  double greatest_n = 0;  ///< Maximum; if positive, the largest tension.
};

/// Largest reactions of an anchored body over the rows of the trace.
struct AnchorSummary {
  std::string name;
  /// Largest magnitudes; torque about `com_m` of the body.
  double max_force_n = 0, max_torque_n_m = 0;
};

struct DragSummary {
  std::string name;
  Range force_n;  ///< Force along the direction of the drag, during its second half.
};

/// Contacts that were not recorded because of too few slots (`RecordSpec::contacts`).
struct LeftOutContacts {
  std::int64_t rows = 0;      ///< Rows with more contacts than slots.
  std::int64_t contacts = 0;  ///< Unrecorded contacts, summed over all rows.
  /// Largest number of contacts in a row, the number of slots for all contacts.
  std::int64_t most_touching = 0;
};

struct RunSummary {
  std::string experiment;
  std::string run;  ///< Id of the run in its folder (taut/run_folder.h); empty without a folder.
  double simulated_s = 0;
  double wall_s = 0;
  bool interrupted = false;
  /// Effect of settling; absent if the experiment does not start settled.
  std::optional<StartChange> start;
  std::vector<PhaseSpec> phases;
  std::vector<CableSummary> cables;
  std::vector<StrutSummary> struts;    ///< Only in simulations.
  std::vector<AnchorSummary> anchors;  ///< Only in simulations.
  std::vector<Overload> overloads;     ///< From all steps, not only recorded rows.
  std::vector<DragSummary> drags;
  std::vector<ReferenceSpec> references;  ///< Reference values of the experiment.
  double system_max_tension_n = 0;        ///< Largest `tension` of any cable over the whole run.
  std::string system_max_tension_cable;
  double system_max_elastic_n = 0;
  double system_max_elastic_after_start_n = 0;
  WorldStatus status;
  std::string status_text;       ///< Names the affected body or cable; empty without problems.
  std::uint64_t state_hash = 0;  ///< Hash of the state of the world at the end.
  std::optional<Pose> end;       ///< Final pose of the robot; only in simulations.
  LeftOutContacts left_out;
};

/// Progress of a run.
struct RunProgress {
  double time_s = 0;  ///< Simulated time.
  double duration_s = 0;
  double wall_s = 0;  ///< Wall-clock time since the first step.
};

struct RunOptions {
  std::optional<Simd> simd;
  int threads = 1;
  /// Called a few times per second of wall-clock time. Return false to end the run early.
  std::function<bool(const RunProgress&)> progress;
  /// Called after the start is prepared and before the first row; results exist from then on. To
  /// end the run, add an error and return false.
  std::function<bool(Diagnostics&)> begin;
  /// Writers for the recorded rows. The caller creates them, the run finishes them.
  std::vector<TraceWriter*> traces;
  /// Custom controllers and sensors in addition to the experiment's.
  Extensions extensions;
  /// Custom friction law (taut/friction.h) for the simulation, including settling. Null: the law of
  /// the model. No effect with a `plant`.
  std::shared_ptr<const ContactFriction> friction;
  /// Plant with one lane, at its start, for the controllers of the experiment. Null: the run
  /// creates a simulation at the start of the experiment. The run also ends if the plant stops
  /// running.
  Plant* plant = nullptr;
};

/// Returns the channels that a run of this experiment records, in order. Some groups are included
/// only if `record.channels` selects them (docs/formats/trace.md). `plant`: see `RunOptions`;
/// quantities that it does not provide have no channel.
std::vector<ChannelInfo> RunChannels(const ExperimentSpec& experiment, Plant* plant = nullptr);

/// Returns the longest step of a run [s], at most `step_s`. Steps end at the ticks of controllers,
/// gaits, sensors and the goal. The time between ticks is divided into equal steps of at most
/// `step_s`.
double LongestStep(const ExperimentSpec& experiment);

/// Adds a warning if `step_s` is longer than the shortest period of these ticks.
void WarnOfStep(const ExperimentSpec& experiment, Diagnostics& out);

/// Returns false and adds an error for each pattern of the experiment that selects no existing
/// channel.
bool CheckRecord(const ExperimentSpec& experiment, Diagnostics& out);

/// Returns trace metadata on the origin: version, machine, seed, step, hash of the inputs.
TraceMetadata RunMetadata(const ExperimentSpec& experiment);

/// Runs an experiment from start to end. If it cannot start, returns nothing and adds diagnostics:
/// the model does not compile, the robot does not settle, or bodies overlap deeply. Adds a warning
/// if the settled pose is far from the described pose (`WarnOfStart`). The summary contains later
/// problems. A trace that cannot be written ends the run and adds an error.
std::optional<RunSummary> RunExperiment(const ExperimentSpec& experiment, const RunOptions& options,
                                        Diagnostics& out);

}  // namespace taut
