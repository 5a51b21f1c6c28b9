/// The simulated robot as a linear system in discrete time about its equilibrium: what small
/// changes of its state and its inputs do within one tick of its controllers
/// (docs/theory/linear.md).
///
///   x' = A x + B u,   y = C x + D u
///
/// x, u, y: changes from their values at the equilibrium; a tick later it is x'. SI units, W frame.
/// A, B and C are the derivatives of the very step that simulates, of its controllers' laws and of
/// what they sense, contacts, joints and stiff cables included.
///
/// Threads: the functions only read what they are given; any number may run at once.
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

/// How the matrices came to be.
enum class Derivatives {
  kExact,        ///< By the chain rule through every operation of the step.
  kDifferences,  ///< Differences of steps, of fourth order.
};

struct LinearOptions {
  /// Where the equilibrium is, and with which rest lengths. Nothing: where the experiment's robot
  /// comes to rest, under its controllers.
  std::optional<Pose> at;
  /// How long it may take to come to rest [s], simulated.
  double most_s = 120.0;
  bool differences = false;  ///< Rather than exact derivatives.
  /// Asked now and then; false ends it.
  std::function<bool()> go_on;
};

/// A state, an input or an output.
struct LinearSignal {
  std::string name, unit;
  double at = 0;  ///< At the equilibrium. Of small turns, from there: 0.
};

struct StateSpace {
  bool found = false;
  std::string why;                   ///< If not,
  std::string hint;                  ///< and what may help.
  std::vector<std::string> remarks;  ///< What is left out, and why differences had to do.
  Derivatives derivatives = Derivatives::kExact;
  /// The largest difference of an entry from the other way of finding it, as a share of the largest
  /// entry of its kind (velocities by turns, tensions by positions, ...).
  double disagreement = 0;
  double period_s = 0;  ///< Of a tick: the controllers', or a step.
  double step_s = 0;    ///< Of the steps that a tick is made of.
  std::vector<LinearSignal> states, inputs, outputs;
  Matrix A, B, C, D;
  Pose pose;                                ///< At the equilibrium.
  std::vector<std::string> bodies, cables;  ///< Names in the pose's order.
};

/// Not found, with `why` and `hint`: a robot that does not come to rest, a cable that is at the
/// edge of going slack, a contact at the edge of slipping or opening, controllers with periods of
/// their own each, bodies that programs move. Left out, with remarks: pushes, drags, gaits,
/// sensors' errors, start noise. Diagnostics, as from `RunExperiment`, if the experiment cannot
/// start at all.
StateSpace FindStateSpace(const ExperimentSpec& experiment, const LinearOptions& options,
                          Diagnostics& out);

/// A motion of the linear system by itself: x' = z x.
struct LinearMode {
  std::complex<double> z;
  double frequency_hz = 0;  ///< By the angle of z; 0: it does not swing.
  double damping = 0;       ///< Share of the critical one; negative: it grows. 0 if |z| = 1.
};

/// All, by frequency; of a pair that is conjugate the one with the positive angle.
std::vector<LinearMode> ModesOf(const StateSpace& system);

/// What a sine of one input does to one output, when all else has died away.
struct FrequencyResponse {
  std::vector<double> frequency_hz, magnitude;  ///< [output's unit per input's unit]
  std::vector<double> phase_rad;                ///< The output's before the input's, -pi..pi.
};

/// At frequencies from 0 to half the tick's. `input`, `output`: their numbers. Where the system
/// resonates without damping, infinity.
FrequencyResponse ResponseOf(const StateSpace& system, int input, int output,
                             const std::vector<double>& frequencies_hz);

/// The number of a signal by its name; nothing if there is none.
std::optional<int> FindSignal(const std::vector<LinearSignal>& signals, const std::string& name);

/// Writes A, B, C, D, names, units and the equilibrium into a new HDF5 file
/// (docs/formats/linear.md), for MATLAB and Python. False and a complaint if that fails.
bool WriteStateSpace(const StateSpace& system, const std::string& path, Diagnostics& out);

}  // namespace taut
