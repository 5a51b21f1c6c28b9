/// Comparison of one channel of two traces on a common clock.
#pragma once

#include <optional>
#include <vector>

#include "compare/common_clock.h"
#include "compare/orientation.h"

namespace taut::compare {

/// Returns 100 (a - b) / |b| in percent; NaN if b is 0.
double Percent(double a, double b);

/// Compares two traces channel by channel. Holds references to the constructor's arguments, which
/// must outlive the object.
class ChannelComparer {
 public:
  ChannelComparer(const Trace& a, const Trace& b, const CompareOptions& options,
                  const CommonClock& clock);

  /// Compares channel `in_a` of trace a with channel `in_b` of trace b.
  ChannelComparison Compare(std::size_t in_a, std::size_t in_b);

 private:
  /// Values of a channel in both traces, in the rows of each trace and on the common clock.
  struct Columns {
    std::vector<double> a, b, clock_a, clock_b;
  };
  /// Channels of a quaternion in both traces.
  struct Pair {
    QuaternionChannels in_a{}, in_b{};
  };
  std::vector<double> OnClock(const std::vector<double>& time_s, const std::vector<double>& values,
                              const std::vector<bool>& gaps, bool resample, RowRange rows) const;
  /// Returns the values of a channel. Signs of quaternions and turns of periodic channels are
  /// aligned.
  const Columns& ColumnsOf(std::size_t in_a, std::size_t in_b);
  Columns SingleColumns(std::size_t in_a, std::size_t in_b) const;
  void SetLag(const Columns& columns, ChannelComparison& result) const;

  const Trace& a_;
  const Trace& b_;
  const CompareOptions& options_;
  const CommonClock& clock_;
  std::vector<bool> gaps_a_, gaps_b_, gaps_clock_;
  double usual_s_;  ///< Usual step of the common clock.
  std::vector<double> even_s_;
  bool uneven_ = false;
  double step_s_ = 0.0;
  RowRange rows_a_, rows_b_;
  std::vector<Pair> quaternions_;
  std::optional<std::size_t> turned_;  ///< Index of the quaternion whose values are in `columns_`.
  std::array<Columns, 4> columns_;
  Columns single_;
};

}  // namespace taut::compare
