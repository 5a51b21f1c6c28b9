/// Interactive run: steps an experiment while forces, drags and parameter changes act on it.
/// Without interaction it is bit-identical to `RunExperiment`.
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
  std::optional<ImpedanceGains> impedance;  ///< Under impedance control; else by rest length.
  double rest_length_m = 0;                 ///< Present command.
};

/// Interactive drag: a spring and damper pulls a node toward a target point.
struct HandSpec {
  int node = 0;
  Vec3 target_m;  ///< In W.
};

/// A running interactive experiment.
///
/// Threads: any number may call const functions of a run at once; other functions need exclusive
/// access to it. Runs are independent of each other.
class LiveRun {
 public:
  /// Brings the experiment to its start. Reports diagnostics as `RunExperiment` does. Returns null
  /// in the same cases, or if `go_on`, which is polled repeatedly, returns false before the start
  /// is found. `extensions`: custom controllers and sensors in addition to the experiment's.
  static std::unique_ptr<LiveRun> Start(const ExperimentSpec& experiment, Diagnostics& out,
                                        const std::function<bool()>& go_on = {},
                                        const Extensions& extensions = {});
  virtual ~LiveRun() = default;

  /// Advances by one step of the integrator; it may pass the experiment's end. Returns false,
  /// without a step, once the state is not finite.
  virtual bool Step() = 0;

  virtual double time_s() const = 0;
  virtual const ExperimentSpec& experiment() const = 0;
  /// Returns the observation of the only lane, 0. Valid until the next step.
  virtual const Observation& Observe() const = 0;
  virtual const Commands& commands() const = 0;
  /// Returns null if the plant is not a simulation.
  virtual const World* world() const = 0;
  /// Returns members that have exceeded a limit so far, as in a summary.
  virtual std::vector<Overload> Overloads() const = 0;
  /// Returns forces of the last step by the experiment's pushes and drags and by interaction,
  /// without zeros.
  virtual std::vector<ExternalForce> ExternalForces() const = 0;

  // --- interaction -------------------------------------------------------------------------------
  /// Sets or, with nothing, releases the interactive drag. Its spring has the stiffness
  /// `DragStiffness()`.
  virtual void SetHand(const std::optional<HandSpec>& hand) = 0;
  /// Returns the stiffness of the interactive drag [N/m]: 200 N/m per kilogram of the model, so
  /// that any robot can be lifted; less if the node's body is too light for it at the experiment's
  /// step.
  virtual double DragStiffness() const = 0;
  /// Applies a constant force for `duration_s` from the present time on.
  virtual void Push(const ExternalForce& push, double duration_s) = 0;
  virtual void SetParameter(Parameter parameter, int index, double value) = 0;
  virtual double GetParameter(Parameter parameter, int index) const = 0;
  /// Returns the commands of all cables with an actuator.
  virtual std::vector<LiveControl> Controls() const = 0;
  /// Sets a cable's gains, or its rest length if `control` has no gains. Returns false if the cable
  /// has no such control.
  virtual bool SetControl(const LiveControl& control) = 0;

  // --- recording ---------------------------------------------------------------------------
  /// Returns the default channels of an experiment, channels of contacts if it records contacts,
  /// then hand/drag/... and hand/push/...: node (-1: none) and force on it.
  virtual const std::vector<ChannelInfo>& channels() const = 0;
  /// Returns the present row; valid until the next call.
  virtual const std::vector<double>& Row() = 0;
};

}  // namespace taut
