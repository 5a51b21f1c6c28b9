/// What an experiment gives: its channels against time, or at rest.
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
  std::string failed;      ///< Reason why there is no result; else empty.
  std::string unreadable;  ///< Reason why its files cannot be read; then the trial is undecided.
  bool stopped = false;
  std::vector<double> time_s;               ///< Of a rest: of its set points; of load cases 1, 2...
  std::vector<std::vector<double>> values;  ///< [channel as asked][row].
  /// Of a run: its number for each value of each reference of the experiment [N]; NaN if it did not
  /// get that far.
  std::vector<std::vector<double>> references;
};

/// To the bit, for other processes of the same build.
std::string Pack(const Computed& computed);
Computed UnpackComputed(const std::string& bytes);

/// Runs it. `channels` as of `DynamicChannels`.
Computed Run(const ExperimentSpec& experiment, const std::vector<std::string>& channels,
             const std::atomic<bool>* stop);
/// What a run can give: all that it can record, and `body/<name>/rotation_{x,y,z}_rad`, the turn
/// from where it was described as a vector along its axis.
std::vector<ChannelInfo> DynamicChannels(const ExperimentSpec& experiment);

/// Rests one after the other: at moments, which rise, each from the one before; or of load cases,
/// whose time is their number, from 1. `take` gets each with its loads; false ends it. Why one was
/// not found; else empty.
using RestTaker = std::function<bool(double time, const LoadCaseSpec&, const Equilibrium&)>;
std::string EachRest(const ExperimentSpec& experiment, FitForward forward,
                     const std::vector<double>& moments_s, const RestTaker& take);
/// The channels of these rests.
Computed Rest(const ExperimentSpec& experiment, FitForward forward,
              const std::vector<double>& moments_s, const std::vector<std::string>& channels,
              const std::atomic<bool>* stop);
std::vector<ChannelInfo> RestChannels(const ExperimentSpec& experiment);
/// Why an experiment has no rests that its set points alone tell; empty if it has.
std::string WhyNoRest(const ExperimentSpec& experiment);

/// When programs of rest lengths and pushes have come to another value: the ends of their ramps.
std::vector<double> SetPoints(const ExperimentSpec& experiment);

/// The turn of a unit quaternion as a vector along its axis, no longer than pi [rad].
Vec3 TurnOf(const Quat& q);

}  // namespace taut::identify
