/// Running one experiment: the world, its controllers on their clocks, the timeline, the trace.
///
/// Threads: any number may call these functions at once, each with diagnostics, traces and batches
/// of its own; they only read an experiment. `RunOptions::progress` is called by the caller's
/// thread.
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

/// Least, mean and greatest of a quantity over a span of time.
struct Range {
  double mean = 0, min = 0, max = 0;
};

/// What a run has to say about one cable. All values over every step, not only recorded rows.
/// What a `dc_motor` took and gave, for sizing supplies and for its heat.
struct MotorSummary {
  double energy_from_supply_j = 0;
  double energy_to_cable_j = 0;
  double energy_in_winding_j = 0;  ///< Heat.
  double max_current_a = 0;        ///< Largest either way.
  double max_winding_temperature_c = 0;
};

struct CableSummary {
  std::string name;
  struct Quantity {
    double max_n = 0;              ///< Over the whole run.
    double max_after_start_n = 0;  ///< From t = 5 s on.
    std::vector<Range> phases;     ///< One per phase of the experiment [N].
  };
  Quantity tension;  ///< Spring and damper: what a load cell feels.
  Quantity elastic;  ///< k (l - L) alone: what NTRT logs.
  /// Of the cable's actuator, for sizing motors (zero without one).
  double max_force_n = 0;             ///< Largest tension while it had to hold or move.
  double max_speed_m_per_s = 0;       ///< Largest rate of the rest length.
  double max_power_w = 0;             ///< Largest tension times winding-in rate.
  double energy_j = 0;                ///< Work done while winding in.
  double net_energy_j = 0;            ///< The same less what paying out gave back.
  std::optional<MotorSummary> motor;  ///< If it is a `dc_motor` of a simulation.
};

/// Of a body that is one straight rod (`StrutForces`), over the rows of the trace and all along it:
/// positive in tension.
struct StrutSummary {
  std::string name;
  double least_n = 0;     ///< Its largest compression, if < 0.
  double greatest_n = 0;  ///< Its largest tension, if > 0.
};

/// What an anchored body is held with, over the rows of the trace.
struct AnchorSummary {
  std::string name;
  double max_force_n = 0, max_torque_n_m = 0;  ///< Largest lengths; the torque about its place.
};

struct DragSummary {
  std::string name;
  Range force_n;  ///< Along the drag's direction, over its second half.
};

/// What a recording with slots for contacts (`RecordSpec::contacts`) does not hold.
struct LeftOutContacts {
  std::int64_t rows = 0;           ///< In which more touched than there are slots.
  std::int64_t contacts = 0;       ///< Without a slot, over all rows.
  std::int64_t most_touching = 0;  ///< In a row: so many slots would hold all.
};

struct RunSummary {
  std::string experiment;
  std::string run;  ///< Its id in its folder (taut/run_folder.h); empty outside of one.
  double simulated_s = 0;
  double wall_s = 0;
  bool interrupted = false;
  std::optional<StartChange> start;  ///< What settling did, if the experiment begins with it.
  std::vector<PhaseSpec> phases;
  std::vector<CableSummary> cables;
  std::vector<StrutSummary> struts;    ///< Of simulations.
  std::vector<AnchorSummary> anchors;  ///< The same.
  std::vector<Overload> overloads;     ///< From every step, not only from recorded rows.
  std::vector<DragSummary> drags;
  std::vector<ReferenceSpec> references;  ///< The experiment's.
  double system_max_tension_n = 0;        ///< Largest `tension` of any cable, whole run.
  std::string system_max_tension_cable;
  double system_max_elastic_n = 0;
  double system_max_elastic_after_start_n = 0;
  WorldStatus status;
  std::string status_text;       ///< Empty when good; names the body or cable.
  std::uint64_t state_hash = 0;  ///< Of the world at the end.
  std::optional<Pose> end;       ///< Of the robot then; nothing where no simulation is behind it.
  LeftOutContacts left_out;
};

/// Where a run stands, for progress lines.
struct RunProgress {
  double time_s = 0;  ///< Simulated.
  double duration_s = 0;
  double wall_s = 0;  ///< Since the first step.
};

struct RunOptions {
  std::optional<Simd> simd;
  int threads = 1;
  /// Called a few times a second of wall-clock time. False stops the run at once, cleanly.
  std::function<bool(const RunProgress&)> progress;
  /// Called when the start is prepared, before the first row: from here on there are results.
  /// False, with a complaint, ends the run.
  std::function<bool(Diagnostics&)> begin;
  /// Get every recorded row; made by the caller, finished by the run.
  std::vector<TraceWriter*> traces;
  /// Controllers and sensors that act beside the experiment's.
  Brought brought;
  /// A friction law of one's own (taut/friction.h) in the simulation, settling included. Null: what
  /// the model says. Without effect on a `plant`.
  std::shared_ptr<const ContactFriction> friction;
  /// At its start, of one lane: the experiment's controllers act on it. Null: a simulation is made
  /// and brought to the experiment's start. The run ends at the latest when the plant goes no more.
  Plant* plant = nullptr;
};

/// The channels that a run of this experiment records, in order. Those of the groups that are
/// recorded on request only (docs/formats/trace.md) if `record.channels` asks for them. `plant`: as
/// in `RunOptions`; what is not known of it has no channel.
std::vector<ChannelInfo> RunChannels(const ExperimentSpec& experiment, Plant* plant = nullptr);

/// The longest step of a run [s]: at most `step_s`. A step ends at each tick of a controller, a
/// gait, the sensors and the goal, so it is at most their shortest period, divided into equal
/// steps.
double LongestStep(const ExperimentSpec& experiment);

/// Warns if `step_s` is longer than the shortest of these periods.
void WarnOfStep(const ExperimentSpec& experiment, Diagnostics& out);

/// False, and a complaint each, if the experiment asks for channels that no run of it has.
bool CheckRecord(const ExperimentSpec& experiment, Diagnostics& out);

/// What a trace says about how it came to be: version, machine, seed, step, hash of the inputs.
TraceMetadata RunMetadata(const ExperimentSpec& experiment);

/// Runs an experiment from start to end. Nothing and diagnostics if it cannot start (a model that
/// does not compile, a start that does not settle or has bodies deep in each other); a start that
/// settles far from what is described gets warnings (`WarnOfStart`); what happens later is in the
/// summary. A trace that cannot be written ends the run with a diagnostic.
std::optional<RunSummary> RunExperiment(const ExperimentSpec& experiment, const RunOptions& options,
                                        Diagnostics& out);

}  // namespace taut
