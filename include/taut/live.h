/// Interactive run: steps an experiment while a user adds forces and drags and changes parameters.
/// Without interaction, its results are bit-identical to `RunExperiment`.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "taut/plant.h"
#include "taut/safety.h"
#include "taut/trace.h"

namespace taut {

/// Adjustable command of a cable.
struct LiveControl {
  int cable = 0;
  /// Present for impedance control; absent for rest length commands.
  std::optional<ImpedanceGains> impedance;
  double rest_length_m = 0;  ///< Present rest length command.
};

/// Interactive drag: a spring and damper pull a node toward a target point.
struct HandSpec {
  int node = 0;
  Vec3 target_m;  ///< Target point, in W.
};

/// Interactive run of an experiment.
///
/// Threads: const functions of a run may be called concurrently; other functions need exclusive
/// access. Runs are independent of each other.
class LiveRun {
 public:
  /// Prepares the start of the experiment, with the same diagnostics as `RunExperiment`. Returns
  /// null if the start fails, or if `go_on` returns false. `go_on` is polled until the start is
  /// found. `extensions`: custom controllers and sensors in addition to the experiment's.
  static std::unique_ptr<LiveRun> Start(const ExperimentSpec& experiment, Diagnostics& out,
                                        const std::function<bool()>& go_on = {},
                                        const Extensions& extensions = {});
  virtual ~LiveRun() = default;

  /// Advances by one integrator step, also past the end of the experiment. Returns false without a
  /// step if the state is not finite.
  virtual bool Step() = 0;

  virtual double time_s() const = 0;
  virtual const ExperimentSpec& experiment() const = 0;
  /// Returns the observation of the run's only robot (lane 0); valid until the next step.
  virtual const Observation& Observe() const = 0;
  virtual const Commands& commands() const = 0;
  /// Returns the simulated world, or null if the plant is not a simulation.
  virtual const World* world() const = 0;
  /// Returns the members that exceeded a limit so far, as in a summary.
  virtual std::vector<Overload> Overloads() const = 0;
  /// Returns the nonzero forces in the last step, by pushes and drags of the experiment and by
  /// interaction.
  virtual std::vector<ExternalForce> ExternalForces() const = 0;

  // --- interaction -------------------------------------------------------------------------------
  /// Sets the interactive drag, or releases it if `hand` is empty. The stiffness of the drag is
  /// `DragStiffness()`.
  virtual void SetHand(const std::optional<HandSpec>& hand) = 0;
  /// Returns the stiffness of the interactive drag [N/m]: 200 N/m per kilogram of the model, enough
  /// to lift any robot. The stiffness is less if the body of the node is too light for this
  /// stiffness at the step of the experiment.
  virtual double DragStiffness() const = 0;
  /// Applies a constant force for `duration_s`, starting now.
  virtual void Push(const ExternalForce& push, double duration_s) = 0;
  virtual void SetParameter(Parameter parameter, int index, double value) = 0;
  virtual double GetParameter(Parameter parameter, int index) const = 0;
  /// Returns the commands of all cables with an actuator.
  virtual std::vector<LiveControl> Controls() const = 0;
  /// Sets the gains of a cable, or its rest length if `control` has no gains. Returns false if the
  /// cable has no such command.
  virtual bool SetControl(const LiveControl& control) = 0;

  // --- recording ---------------------------------------------------------------------------
  /// Returns the default channels of the experiment and, if it records contacts, contact channels.
  /// The last channels are hand/drag/... and hand/push/...: node (-1: none) and force on it.
  virtual const std::vector<ChannelInfo>& channels() const = 0;
  /// Returns the present row; valid until the next call.
  virtual const std::vector<double>& Row() = 0;
};

}  // namespace taut
