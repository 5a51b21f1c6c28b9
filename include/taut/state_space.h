/// Linear state-space model of a robot in discrete time about its equilibrium: effect of small
/// changes of states and inputs within one tick of its controllers (docs/theory/linear.md).
///
///   x' = A x + B u,   y = C x + D u
///
/// x, u, y: changes from their values at the equilibrium; x' is x one tick later. SI units, W
/// frame. A, B and C are derivatives of the simulated step, of the control laws and of the sensors,
/// including contacts, joints and stiff cables.
///
/// Threads: the functions only read their arguments; any number may run at once.
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

/// Method by which the matrices were computed.
enum class Derivatives {
  kExact,        ///< Automatic differentiation: the chain rule through every operation of the step.
  kDifferences,  ///< Finite differences of steps, of fourth order.
};

struct LinearOptions {
  /// Pose and rest lengths of the equilibrium. Nothing: the pose at which the experiment's robot
  /// comes to rest under its controllers.
  std::optional<Pose> at;
  /// Longest time for coming to rest [s], simulated.
  double most_s = 120.0;
  bool differences = false;  ///< Finite differences instead of exact derivatives.
  /// Polled at intervals; return false to abort.
  std::function<bool()> go_on;
};

/// A state, an input or an output.
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
  /// Largest difference of an entry from its value by the other method, relative to the largest
  /// entry of its kind (velocities by rotations, tensions by positions, ...).
  double disagreement = 0;
  double period_s = 0;  ///< Of a tick: period of the controllers, or a step.
  double step_s = 0;    ///< Of the steps within a tick.
  std::vector<LinearSignal> states, inputs, outputs;
  Matrix A, B, C, D;
  Pose pose;                                ///< Of the equilibrium.
  std::vector<std::string> bodies, cables;  ///< Names in the order of `pose`.
};

/// Computes the linear system of an experiment. Not found, with `why` and `hint`: a robot that does
/// not come to rest, a cable at the edge of going slack, a contact at the edge of slipping or
/// opening, controllers with different periods, kinematic bodies. Omitted, with remarks: pushes,
/// drags, gaits, sensor errors, start noise. Reports diagnostics as `RunExperiment` does if the
/// experiment cannot start.
StateSpace FindStateSpace(const ExperimentSpec& experiment, const LinearOptions& options,
                          Diagnostics& out);

/// Mode of the linear system: x' = z x.
struct LinearMode {
  std::complex<double> z;
  double frequency_hz = 0;  ///< Natural frequency by the angle of z; 0: not oscillating.
  double damping = 0;       ///< Damping ratio; negative: growing. 0 if |z| = 1.
};

/// Returns all modes by frequency; of a conjugate pair, the mode with the positive angle.
std::vector<LinearMode> ModesOf(const StateSpace& system);

/// Frequency response: steady-state effect of a sinusoidal input on an output.
struct FrequencyResponse {
  std::vector<double> frequency_hz, magnitude;  ///< [output's unit per input's unit]
  std::vector<double> phase_rad;                ///< Phase lead of the output, -pi..pi.
};

/// Returns the response at frequencies from 0 to half the tick's rate. `input`, `output`: indices.
/// Infinite at an undamped resonance.
FrequencyResponse ResponseOf(const StateSpace& system, int input, int output,
                             const std::vector<double>& frequencies_hz);

/// Returns the index of a signal by its name; nothing if there is none.
std::optional<int> FindSignal(const std::vector<LinearSignal>& signals, const std::string& name);

/// Writes A, B, C, D, names, units and the equilibrium into a new HDF5 file
/// (docs/formats/linear.md), for MATLAB and Python. Returns false, with an error, if that fails.
bool WriteStateSpace(const StateSpace& system, const std::string& path, Diagnostics& out);

}  // namespace taut
