/// Residual rows: pairs of computed and measured values.
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

/// Measured data, on the data's clock.
struct Measured {
  Trace trace;                     ///< Data with taut's channel names.
  std::vector<double> setpoint_s;  ///< Time of each set point on the data's clock.
  std::vector<double> ours_s;      ///< Time of each set point on the experiment's clock.
};

/// Reads data and set points of an experiment. Returns nothing and adds diagnostics if files are
/// unreadable or do not match. Without data, the trace is empty.
std::optional<Measured> ReadMeasured(const FitExperiment& one, Diagnostics& out);

/// Data rows in a window. The simulation is evaluated at the same times with the same weights, so
/// that gaps and uneven spacing affect both equally.
struct Samples {
  std::vector<double> time_s;  ///< Times on the same clock as `Row::from_s`.
  std::vector<double> weight;  ///< Duration that each sample represents (`compare::TimeWeights`).
  /// Measured quaternions of orientation channels; otherwise empty.
  std::vector<std::array<double, 4>> orientation;
  /// Measured values of channels with a period; otherwise empty.
  std::vector<double> measured;

  void AddTo(base::Fnv1a& sum) const;
};

/// Rule to compute the model's value of one residual.
struct Row {
  enum class How { kRow, kRest, kAt, kMean, kMax, kMin, kReference };
  std::size_t experiment = 0;
  std::string channel;
  How how = How::kRow;
  std::size_t row = 0;          ///< For kRow: row of `Computed`.
  double from_s = 0, to_s = 0;  ///< Window, or time (for kAt and kRest), on the experiment's clock
                                ///< if the data had no delay.
  std::shared_ptr<const Samples> samples;  ///< Samples for kMean, kMax and kMin; null for designs.
  /// Measured quaternion of an orientation channel (w first), for kAt, kRest and kRow. The computed
  /// quaternion is negated if this brings it nearer.
  std::optional<std::array<double, 4>> orientation;
  /// Period of wrapped data; 0: none. Whole periods are added to bring the computed value nearest
  /// to the measured one.
  double period = 0;
  std::size_t reference = 0;  ///< Index of the experiment's reference.
  std::size_t value = 0;      ///< Index of the reference's value.
  std::size_t window = 0;     ///< Index of the window, for groups.
  FitPoint point;

  bool HasQuaternion() const { return orientation || (samples && !samples->orientation.empty()); }
};

/// Returns the initial delay of the data's clock [s].
double StartDelay(const FitSpec& spec, std::size_t experiment);

/// Returns the rows of one residual for one experiment. `measured`: null for a design. `channels`:
/// channels that can be computed for the experiment.
std::vector<Row> MakeRows(const FitSpec& spec, const FitResidual& residual, std::size_t experiment,
                          const Measured* measured, const std::vector<ChannelInfo>& channels,
                          Diagnostics& out);

/// Indices of a row's channels among the computed channels.
struct RowChannels {
  std::size_t own = 0;
  std::optional<std::array<std::size_t, 4>> quaternion;  ///< Components of a quaternion, w first.
};

/// Calls `need` for each channel of a row and returns the indices.
RowChannels ChannelsOf(const Row& row, const std::function<std::size_t(const std::string&)>& need);

/// Returns the computed value of a row. Returns nothing if it is undefined.
std::optional<double> ValueOf(const Row& row, const Computed& computed, const RowChannels& channels,
                              double delay_s);

}  // namespace taut::identify
