/// Which numbers of what is computed are set beside which of what was measured.
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

/// What was measured, on its own clock.
struct Measured {
  Trace trace;                     ///< With the names of taut.
  std::vector<double> setpoint_s;  ///< When each set point was commanded, on that clock,
  std::vector<double> ours_s;      ///< and on the experiment's.
};

/// Nothing and diagnostics if files cannot be read or do not go together. An experiment without
/// data has an empty trace.
std::optional<Measured> ReadMeasured(const FitExperiment& one, Diagnostics& out);

/// Rows of the data in a window. A run is looked at in the same moments, with the same weights, so
/// that gaps and uneven rows are those of both.
struct Samples {
  std::vector<double> time_s;  ///< As `Row::from_s`.
  std::vector<double> weight;  ///< Time for which each stands (`compare::TimeWeights`).
  std::vector<std::array<double, 4>> orientation;  ///< Measured, of its channels; else empty.

  void AddTo(base::Fnv1a& sum) const;
};

/// One residual's part of what is computed.
struct Row {
  enum class How { kRow, kRest, kAt, kMean, kMax, kMin, kReference };
  std::size_t experiment = 0;
  std::string channel;
  How how = How::kRow;
  std::size_t row = 0;          ///< kRow: of `Computed`.
  double from_s = 0, to_s = 0;  ///< A window, or kAt and kRest a moment, on the experiment's clock
                                ///< if the data's is not late.
  std::shared_ptr<const Samples> samples;  ///< kMean, kMax, kMin of data; of a design null.
  /// What was measured of a quaternion's channel, w first: one of kAt, kRest and kRow. The sign of
  /// what is computed is chosen to be nearer to it.
  std::optional<std::array<double, 4>> orientation;
  std::size_t reference = 0;  ///< Of the experiment,
  std::size_t value = 0;      ///< and which of its values.
  std::size_t window = 0;     ///< Which, for groups.
  FitPoint point;

  bool HasQuaternion() const { return orientation || (samples && !samples->orientation.empty()); }
};

/// How late the data's clock is where a search begins.
double StartDelay(const FitSpec& spec, std::size_t experiment);

/// The rows of one residual and one experiment. `measured` null: of a design, for which nothing is
/// measured. `channels`: what can be computed of the experiment.
std::vector<Row> MakeRows(const FitSpec& spec, const FitResidual& residual, std::size_t experiment,
                          const Measured* measured, const std::vector<ChannelInfo>& channels,
                          Diagnostics& out);

/// Places of channels among those that were computed.
struct RowChannels {
  std::size_t own = 0;
  std::optional<std::array<std::size_t, 4>> quaternion;  ///< Of an orientation, w first.
};

/// Asks `need` for the channels that a row reads.
RowChannels ChannelsOf(const Row& row, const std::function<std::size_t(const std::string&)>& need);

/// What a row asks for. Nothing if there is none.
std::optional<double> ValueOf(const Row& row, const Computed& computed, const RowChannels& channels,
                              double delay_s);

}  // namespace taut::identify
