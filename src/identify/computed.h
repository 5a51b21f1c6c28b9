/// Computed channels of an experiment for system identification, by simulation or at static
/// equilibria.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "taut/analysis.h"
#include "taut/fit_spec.h"
#include "taut/plant.h"
#include "taut/trace.h"

namespace taut::identify {

struct Computed {
  std::string failed;      ///< Reason for a missing result; otherwise empty.
  std::string unreadable;  ///< Reason why files cannot be read. Then the parameters are not the
                           ///< cause, and the result is unknown.
  bool stopped = false;
  std::vector<double> time_s;  ///< Times of set points for static equilibria; 1, 2, ... for load
                               ///< cases.
  std::vector<std::vector<double>> values;  ///< Computed values: [requested channel][row].
  /// For simulations: each value of each reference of the experiment [N]. NaN for values
  /// that the simulation did not reach.
  std::vector<std::vector<double>> references;
};

/// Serializes all values bit for bit, for processes of the same build.
std::string Pack(const Computed& computed);
Computed UnpackComputed(const std::string& bytes);

/// Simulates the experiment. `channels`: names in `DynamicChannels`.
Computed Run(const ExperimentSpec& experiment, const std::vector<std::string>& channels,
             const std::atomic<bool>* stop);
/// Returns the channels that a simulation can provide. These are all channels of a trace, and
/// `body/<name>/rotation_{x,y,z}_rad`, the rotation vector from the described orientation.
std::vector<ChannelInfo> DynamicChannels(const ExperimentSpec& experiment);

/// Computes static equilibria, at increasing times or for all load cases. Each search starts from
/// the previous equilibrium. The `time` of a load case is its number, starting at 1. Calls `take`
/// for each equilibrium, until it returns false. Returns an error message if an equilibrium was not
/// found, otherwise an empty text.
using RestTaker = std::function<bool(double time, const LoadCaseSpec&, const Equilibrium&)>;
std::string EachRest(const ExperimentSpec& experiment, FitForward forward,
                     const std::vector<double>& moments_s, const RestTaker& take);
/// Computes the requested channels at these equilibria.
Computed Rest(const ExperimentSpec& experiment, FitForward forward,
              const std::vector<double>& moments_s, const std::vector<std::string>& channels,
              const std::atomic<bool>* stop);
std::vector<ChannelInfo> RestChannels(const ExperimentSpec& experiment);
/// Returns the reason why the experiment does not determine static equilibria. Returns an empty
/// text if it does.
std::string WhyNoRest(const ExperimentSpec& experiment);

/// Returns the ends of all ramps of rest length programs and pushes [s].
std::vector<double> SetPoints(const ExperimentSpec& experiment);

/// Returns the rotation vector of a unit quaternion [rad], with a length of at most pi.
Vec3 TurnOf(const Quat& q);

}  // namespace taut::identify
