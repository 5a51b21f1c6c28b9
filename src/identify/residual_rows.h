/// Residual rows: pairs of computed and measured numbers.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/hash.h"
#include "identify/computed.h"
#include "taut/fit_spec.h"
#include "taut/identify.h"

namespace taut::identify {

/// Measured data, on their clock.
struct Measured {
  Trace trace;                     ///< With taut's channel names.
  std::vector<double> setpoint_s;  ///< Time of each set point's command on the data's clock.
  std::vector<double> ours_s;      ///< Time of each set point on the experiment's clock.
};

/// Reads data and set points. Nothing with diagnostics if files cannot be read or do not match. An
/// experiment without data has an empty trace.
std::optional<Measured> ReadMeasured(const FitExperiment& one, Diagnostics& out);

/// Data rows in a window. Runs are evaluated at the same times with the same weights, so that gaps
/// and uneven spacing affect both sides equally.
struct Samples {
  std::vector<double> time_s;  ///< On the clock of `Row::from_s`.
  std::vector<double> weight;  ///< Duration that each sample represents (`compare::TimeWeights`).
  /// Measured quaternions of orientation channels; else empty.
  std::vector<std::array<double, 4>> orientation;
  /// Measured values of channels with a period; else empty.
  std::vector<double> measured;

  void AddTo(base::Fnv1a& sum) const;
};

/// Computed part of one residual.
struct Row {
  enum class How { kRow, kRest, kAt, kMean, kMax, kMin, kReference };
  std::size_t experiment = 0;
  std::string channel;
  How how = How::kRow;
  std::size_t row = 0;          ///< kRow: row of `Computed`.
  double from_s = 0, to_s = 0;  ///< Window, or for kAt and kRest a moment, on the experiment's
                                ///< clock for data without delay.
  std::shared_ptr<const Samples> samples;  ///< kMean, kMax, kMin of data; null for designs.
  /// Measured quaternion of an orientation channel, w first, for kAt, kRest and kRow. The sign of
  /// the computed one is chosen to be nearer to it.
  std::optional<std::array<double, 4>> orientation;
  /// Period of wrapped data; 0: none. The computed value gets the turn nearest to the measured one.
  double period = 0;
  std::size_t reference = 0;  ///< Index among the experiment's references.
  std::size_t value = 0;      ///< Index among the reference's values.
  std::size_t window = 0;     ///< Index of the window, for groups.
  FitPoint point;

  bool HasQuaternion() const { return orientation || (samples && !samples->orientation.empty()); }
};

/// Returns the delay of the data's clock at the start of a search [s].
double StartDelay(const FitSpec& spec, std::size_t experiment);

/// Returns the rows of one residual and one experiment. `measured` null: a design, without
/// measurements. `channels`: channels that can be computed for the experiment.
std::vector<Row> MakeRows(const FitSpec& spec, const FitResidual& residual, std::size_t experiment,
                          const Measured* measured, const std::vector<ChannelInfo>& channels,
                          Diagnostics& out);

/// Indices of channels among the computed ones.
struct RowChannels {
  std::size_t own = 0;
  std::optional<std::array<std::size_t, 4>> quaternion;  ///< Of an orientation, w first.
};

/// Requests the channels that a row reads by calls of `need`.
RowChannels ChannelsOf(const Row& row, const std::function<std::size_t(const std::string&)>& need);

/// Returns the computed value of a row; nothing if there is none.
std::optional<double> ValueOf(const Row& row, const Computed& computed, const RowChannels& channels,
                              double delay_s);

}  // namespace taut::identify
