/// Run of an experiment: steps the world, calls controllers at their clocks, applies the timeline
/// and writes traces.
///
/// Threads: any number may call these functions at once, each with separate diagnostics, traces and
/// batches; experiments are only read. `RunOptions::progress` is called by the caller's thread.
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

/// Minimum, mean and maximum of a quantity over a span of time.
struct Range {
  double mean = 0, min = 0, max = 0;
};

/// Summary of a `dc_motor`, for sizing supplies and for checking its temperature.
struct MotorSummary {
  double energy_from_supply_j = 0;
  double energy_to_cable_j = 0;
  double energy_in_winding_j = 0;  ///< Heat.
  double max_current_a = 0;        ///< Largest magnitude.
  double max_winding_temperature_c = 0;
};

/// Summary of one cable. All values are over every step, not only recorded rows.
struct CableSummary {
  std::string name;
  struct Quantity {
    double max_n = 0;              ///< Over the whole run.
    double max_after_start_n = 0;  ///< From t = 5 s on.
    std::vector<Range> phases;     ///< One per phase of the experiment [N].
  };
  Quantity tension;  ///< Spring and damper, as measured by a load cell.
  Quantity elastic;  ///< k (l - L) only, as logged by NTRT.
  /// Values for sizing motors; zero without an actuator.
  double max_force_n = 0;             ///< Largest tension while it had to hold or move.
  double max_speed_m_per_s = 0;       ///< Largest rate of the rest length.
  double max_power_w = 0;             ///< Largest product of tension and winding-in rate.
  double energy_j = 0;                ///< Work done while winding in.
  double net_energy_j = 0;            ///< The same minus the work recovered while paying out.
  std::optional<MotorSummary> motor;  ///< With a `dc_motor` in a simulation.
};

/// Extreme axial forces of a body that is one straight rod (`StrutForces`), over the rows of the
/// trace and along the rod, positive in tension.
struct StrutSummary {
  std::string name;
  double least_n = 0;     ///< If < 0: minus its largest compression.
  double greatest_n = 0;  ///< If > 0: its largest tension.
};

/// Largest reactions of an anchored body over the rows of the trace.
struct AnchorSummary {
  std::string name;
  double max_force_n = 0, max_torque_n_m = 0;  ///< Largest magnitudes; torque about its position.
};

struct DragSummary {
  std::string name;
  Range force_n;  ///< Along the drag's direction, in its second half.
};

/// Contacts for which a recording had no slot (`RecordSpec::contacts`).
struct LeftOutContacts {
  std::int64_t rows = 0;      ///< Rows with more contacts than slots.
  std::int64_t contacts = 0;  ///< Contacts without a slot, over all rows.
  /// Largest number of contacts in a row: as many slots would hold all.
  std::int64_t most_touching = 0;
};

struct RunSummary {
  std::string experiment;
  std::string run;  ///< Id in its folder (taut/run_folder.h); empty without a folder.
  double simulated_s = 0;
  double wall_s = 0;
  bool interrupted = false;
  std::optional<StartChange> start;  ///< Effect of settling, if the experiment begins settled.
  std::vector<PhaseSpec> phases;
  std::vector<CableSummary> cables;
  std::vector<StrutSummary> struts;    ///< In simulations.
  std::vector<AnchorSummary> anchors;  ///< In simulations.
  std::vector<Overload> overloads;     ///< From every step, not only from recorded rows.
  std::vector<DragSummary> drags;
  std::vector<ReferenceSpec> references;  ///< As in the experiment.
  double system_max_tension_n = 0;        ///< Largest `tension` of any cable, whole run.
  std::string system_max_tension_cable;
  double system_max_elastic_n = 0;
  double system_max_elastic_after_start_n = 0;
  WorldStatus status;
  std::string status_text;       ///< Empty if good; names the body or cable.
  std::uint64_t state_hash = 0;  ///< Of the world at the end.
  std::optional<Pose> end;       ///< Final pose of the robot; nothing without a simulation.
  LeftOutContacts left_out;
};

/// Progress of a run.
struct RunProgress {
  double time_s = 0;  ///< Simulated.
  double duration_s = 0;
  double wall_s = 0;  ///< Since the first step.
};

struct RunOptions {
  std::optional<Simd> simd;
  int threads = 1;
  /// Called a few times per second of wall-clock time. Return false to stop the run at once,
  /// cleanly.
  std::function<bool(const RunProgress&)> progress;
  /// Called when the start is prepared, before the first row, so that results exist from then on.
  /// Return false, with an error, to end the run.
  std::function<bool(Diagnostics&)> begin;
  /// Writers that get every recorded row; created by the caller, finished by the run.
  std::vector<TraceWriter*> traces;
  /// Custom controllers and sensors in addition to the experiment's.
  Extensions extensions;
  /// Custom friction law (taut/friction.h) of the simulation, including settling. Null: the law of
  /// the model. Without effect on a `plant`.
  std::shared_ptr<const ContactFriction> friction;
  /// Plant of one lane, at its start, on which the experiment's controllers act. Null: the run
  /// creates a simulation and brings it to the experiment's start. The run ends at the latest when
  /// the plant stops running.
  Plant* plant = nullptr;
};

/// Returns the channels that a run of this experiment records, in order. Groups that are recorded
/// on request only (docs/formats/trace.md) are included if `record.channels` selects them. `plant`:
/// as in `RunOptions`; quantities that it does not provide have no channel.
std::vector<ChannelInfo> RunChannels(const ExperimentSpec& experiment, Plant* plant = nullptr);

/// Returns the longest step of a run [s]: at most `step_s`. A step ends at each tick of a
/// controller, a gait, the sensors and the goal, so it is at most their shortest period, divided
/// into equal steps.
double LongestStep(const ExperimentSpec& experiment);

/// Warns if `step_s` is longer than the shortest of these periods.
void WarnOfStep(const ExperimentSpec& experiment, Diagnostics& out);

/// Returns false, with an error per pattern, if the experiment selects channels that no run of it
/// has.
bool CheckRecord(const ExperimentSpec& experiment, Diagnostics& out);

/// Returns a trace's metadata on its origin: version, machine, seed, step, hash of the inputs.
TraceMetadata RunMetadata(const ExperimentSpec& experiment);

/// Runs an experiment from start to end. Returns nothing, with diagnostics, if it cannot start: a
/// model that does not compile, a start that does not settle, or bodies that overlap deeply. Warns
/// if it settles far from the described pose (`WarnOfStart`). The summary contains later problems.
/// A trace that cannot be written ends the run with a diagnostic.
std::optional<RunSummary> RunExperiment(const ExperimentSpec& experiment, const RunOptions& options,
                                        Diagnostics& out);

}  // namespace taut
