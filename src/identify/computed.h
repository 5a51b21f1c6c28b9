/// Computed channels of an experiment for system identification: against time, or at static
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
  std::string failed;      ///< Reason for the missing result; else empty.
  std::string unreadable;  ///< Reason why its files cannot be read; then the trial is undecided.
  bool stopped = false;
  std::vector<double> time_s;  ///< For rests: times of the set points; for load cases 1, 2, ...
  std::vector<std::vector<double>> values;  ///< [requested channel][row].
  /// For runs: value of each number of each reference of the experiment [N]; NaN if the run ended
  /// before it.
  std::vector<std::vector<double>> references;
};

/// Serializes all values bit for bit, for other processes of the same build.
std::string Pack(const Computed& computed);
Computed UnpackComputed(const std::string& bytes);

/// Simulates the experiment. `channels`: names from `DynamicChannels`.
Computed Run(const ExperimentSpec& experiment, const std::vector<std::string>& channels,
             const std::atomic<bool>* stop);
/// Returns the channels that a run can provide: every recordable channel, and
/// `body/<name>/rotation_{x,y,z}_rad`, the rotation vector from the described orientation.
std::vector<ChannelInfo> DynamicChannels(const ExperimentSpec& experiment);

/// Computes static equilibria one after another: at increasing moments, each starting from the one
/// before, or of load cases, whose time is their number from 1. `take` receives each one with its
/// loads and returns false to stop. Returns the reason if one was not found; else an empty string.
using RestTaker = std::function<bool(double time, const LoadCaseSpec&, const Equilibrium&)>;
std::string EachRest(const ExperimentSpec& experiment, FitForward forward,
                     const std::vector<double>& moments_s, const RestTaker& take);
/// Computes the requested channels at these rests.
Computed Rest(const ExperimentSpec& experiment, FitForward forward,
              const std::vector<double>& moments_s, const std::vector<std::string>& channels,
              const std::atomic<bool>* stop);
std::vector<ChannelInfo> RestChannels(const ExperimentSpec& experiment);
/// Returns the reason why the set points of an experiment do not determine static equilibria; empty
/// if they do.
std::string WhyNoRest(const ExperimentSpec& experiment);

/// Returns the times at which programs of rest lengths and pushes have reached a new value: the
/// ends of their ramps [s].
std::vector<double> SetPoints(const ExperimentSpec& experiment);

/// Returns the rotation vector of a unit quaternion, with length <= pi [rad].
Vec3 TurnOf(const Quat& q);

}  // namespace taut::identify
