/// An experiment that a person plays with: advanced step by step, pushed, dragged and tuned while
/// it runs. Left alone, it goes through the same bits as `RunExperiment`.
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

/// A force on a node from outside, in W.
struct OutsideForce {
  int node = 0;
  Vec3 force_n;
};

/// How a cable's command can be changed by hand.
struct LiveControl {
  int cable = 0;
  std::optional<ImpedanceGains> impedance;  ///< Under impedance control; else by rest length.
  double rest_length_m = 0;                 ///< The present command.
};

/// A hand that holds a node by a spring and a damper.
struct HandSpec {
  int node = 0;
  Vec3 target_m;  ///< In W.
};

/// Threads: any number may call const functions of a run at once; the others need it for
/// themselves. Runs do not know of each other.
class LiveRun {
 public:
  /// Brings the experiment to its start. Diagnostics as from `RunExperiment`; nothing as from it,
  /// or if `go_on`, which is asked again and again, says no before the start is found. `brought`:
  /// controllers and sensors that act beside the experiment's.
  static std::unique_ptr<LiveRun> Start(const ExperimentSpec& experiment, Diagnostics& out,
                                        const std::function<bool()>& go_on = {},
                                        const Brought& brought = {});
  virtual ~LiveRun() = default;

  /// One step of the integrator; the experiment's end is no limit. False, and nothing done, once
  /// the state is not finite.
  virtual bool Step() = 0;

  virtual double time_s() const = 0;
  virtual const ExperimentSpec& experiment() const = 0;
  /// Of one lane, 0. Valid until the next step.
  virtual const Observation& Observe() const = 0;
  virtual const Commands& commands() const = 0;
  /// Null where no simulation is behind it.
  virtual const World* world() const = 0;
  /// Members that have exceeded a limit so far, as in a summary.
  virtual std::vector<Overload> Overloads() const = 0;
  /// What pushed and dragged in the last step: the experiment's events and hands. Zeros left out.
  virtual std::vector<OutsideForce> OutsideForces() const = 0;

  // --- what a person may do ----------------------------------------------------------------
  /// Nothing: lets go. The spring's stiffness is `DragStiffness()`.
  virtual void SetHand(const std::optional<HandSpec>& hand) = 0;
  /// 200 N per metre and kilogram of the model, so that any robot can be lifted [N/m]. Less where
  /// the node's body is too light for that at the experiment's step.
  virtual double DragStiffness() const = 0;
  /// A constant force from now on, for `duration_s`.
  virtual void Push(const OutsideForce& push, double duration_s) = 0;
  virtual void SetParameter(Parameter parameter, int index, double value) = 0;
  virtual double GetParameter(Parameter parameter, int index) const = 0;
  /// Cables with an actuator.
  virtual std::vector<LiveControl> Controls() const = 0;
  /// Takes the control's gains, or its rest length if it has none. False if the cable has no such
  /// control.
  virtual bool SetControl(const LiveControl& control) = 0;

  // --- recording ---------------------------------------------------------------------------
  /// The channels that an experiment records which asks for none, those of contacts if it asks for
  /// them, then hand/drag/... and hand/push/...: which node (-1: none) and the force on it.
  virtual const std::vector<ChannelInfo>& channels() const = 0;
  /// The present row; valid until the next call.
  virtual const std::vector<double>& Row() = 0;
};

}  // namespace taut
