/// Discrete-time linear state-space model of a robot about its equilibrium: effect of small changes
/// of states and inputs within one controller tick (docs/theory/linear.md).
///
///   x' = A x + B u,   y = C x + D u
///
/// x, u, y: deviations from the values at the equilibrium; x' is x one tick later. SI units, world
/// frame W. A, B and C are derivatives of the simulated step, the control laws and the sensors,
/// including contacts, joints and stiff cables.
///
/// Threads: the functions only read their arguments and are thread safe.
#pragma once

#include <complex>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/matrix.h"
#include "taut/spec.h"
#include "taut/start.h"

namespace taut {

/// Method that computed the matrices.
enum class Derivatives {
  kExact,        ///< Automatic differentiation of all operations of the step.
  kDifferences,  ///< Fourth-order finite differences of steps.
};

struct LinearOptions {
  /// Equilibrium pose and rest lengths. Absent: the pose in which the robot of the experiment comes
  /// to rest under its controllers.
  std::optional<Pose> at;
  /// Longest simulated time to come to rest [s].
  double most_s = 120.0;
  bool differences = false;  ///< Use finite differences instead of exact derivatives.
  /// Called repeatedly; return false to cancel.
  std::function<bool()> go_on;
};

/// State, input or output.
struct LinearSignal {
  std::string name, unit;
  double at = 0;  ///< Value at the equilibrium; 0 for small rotations, which are relative to it.
};

struct StateSpace {
  bool found = false;
  std::string why;                   ///< Reason if not found.
  std::string hint;                  ///< Possible remedy.
  std::vector<std::string> remarks;  ///< Omissions, and the reason for finite differences.
  Derivatives derivatives = Derivatives::kExact;
  /// Largest difference between both methods in a matrix entry, relative to the largest entry of
  /// the same kind. Kinds are, for example, derivatives of velocities with respect to rotations.
  double disagreement = 0;
  /// Length of a tick: the period of the controllers, or a step without controllers.
  double period_s = 0;
  double step_s = 0;  ///< Length of the steps within a tick.
  std::vector<LinearSignal> states, inputs, outputs;
  Matrix A, B, C, D;
  Pose pose;                                ///< Pose of the equilibrium.
  std::vector<std::string> bodies, cables;  ///< Names in the order of `pose`.
};

/// Computes the linear system of an experiment. `found` is false if the robot does not come to
/// rest, a cable is about to go slack, a contact is about to slip or open, controllers have
/// different periods, or there are kinematic bodies. Then `why` contains the reason and `hint` a
/// remedy. Pushes, drags, gaits, sensor errors and start noise are omitted, with remarks. If the
/// experiment cannot start, adds the same diagnostics as `RunExperiment`.
StateSpace FindStateSpace(const ExperimentSpec& experiment, const LinearOptions& options,
                          Diagnostics& out);

/// Mode of the linear system: x' = z x.
struct LinearMode {
  std::complex<double> z;
  double frequency_hz = 0;  ///< Natural frequency from the angle of z; 0: no oscillation.
  double damping = 0;       ///< Damping ratio; negative: growing; 0 if |z| = 1.
};

/// Returns all modes sorted by frequency. A conjugate pair appears once, with the positive angle.
std::vector<LinearMode> ModesOf(const StateSpace& system);

/// Frequency response: steady-state effect of a sinusoidal input on an output.
struct FrequencyResponse {
  std::vector<double> frequency_hz, magnitude;  ///< In units of output per unit of input.
  std::vector<double> phase_rad;                ///< Phase lead of the output, -pi..pi.
};

/// Returns the response at frequencies from 0 to half the tick rate; infinite at an undamped
/// resonance. `input`, `output`: indices.
FrequencyResponse ResponseOf(const StateSpace& system, int input, int output,
                             const std::vector<double>& frequencies_hz);

/// Returns the index of a signal with this name, or nothing.
std::optional<int> FindSignal(const std::vector<LinearSignal>& signals, const std::string& name);

/// Writes A, B, C, D, names, units and the equilibrium to a new HDF5 file (docs/formats/linear.md)
/// for MATLAB and Python. On failure, returns false and adds an error.
bool WriteStateSpace(const StateSpace& system, const std::string& path, Diagnostics& out);

}  // namespace taut
