// Computed values of residuals, at times or as statistics of windows.
#include <algorithm>
#include <cmath>

#include "compare/orientation.h"
#include "compare/wrapped_angle.h"
#include "identify/residual_rows.h"

namespace taut::identify {
namespace {

/// Channel of a simulation, interpolated linearly between rows. So values depend continuously on
/// the delay of the window.
class Course {
 public:
  Course(const Row& row, const Computed& computed, const RowChannels& channels)
      : times_(computed.time_s), values_(computed.values[channels.own]), period_(row.period) {
    if (!row.HasQuaternion() || !channels.quaternion) return;
    for (std::size_t i = 0; i < 4; ++i) {
      quaternion_[i] = &computed.values[(*channels.quaternion)[i]];
    }
  }

  double Clamped(double time_s) const { return std::clamp(time_s, times_.front(), times_.back()); }
  double At(double time_s) const { return At(time_s, values_, period_); }
  /// Returns the value, negated if -q is nearer to `measured` than the computed quaternion q.
  double At(double time_s, const std::array<double, 4>& measured) const {
    if (quaternion_[0] == nullptr) return At(time_s);
    std::array<double, 4> q{};
    for (std::size_t i = 0; i < 4; ++i) q[i] = At(time_s, *quaternion_[i], 0);
    return compare::NearerSign(q, measured) * At(time_s);
  }
  const std::vector<double>& times() const { return times_; }
  const std::vector<double>& values() const { return values_; }

  /// Returns the value of computed row `i`.
  double OfRow(std::size_t i, const std::optional<std::array<double, 4>>& measured) const {
    if (!measured || quaternion_[0] == nullptr) return values_[i];
    std::array<double, 4> q{};
    for (std::size_t k = 0; k < 4; ++k) q[k] = (*quaternion_[k])[i];
    return compare::NearerSign(q, *measured) * values_[i];
  }

 private:
  double At(double time_s, const std::vector<double>& values, double period) const {
    const auto after = std::upper_bound(times_.begin(), times_.end(), time_s);
    if (after == times_.begin()) return values.front();
    if (after == times_.end()) return values.back();
    const auto i = static_cast<std::size_t>(after - times_.begin());
    const double share = (time_s - times_[i - 1]) / (times_[i] - times_[i - 1]);
    // Rotation vectors of the simulation also wrap.
    const double next = compare::NearestTurn(values[i], values[i - 1], period);
    return values[i - 1] + share * (next - values[i - 1]);
  }

  const std::vector<double>& times_;
  const std::vector<double>& values_;
  double period_;
  std::array<const std::vector<double>*, 4> quaternion_{};
};

/// Accumulator of a window's mean, minimum and maximum.
struct Total {
  double area = 0, time = 0, least = INFINITY, most = -INFINITY;

  void Take(double value) { least = std::min(least, value), most = std::max(most, value); }
  double Of(Row::How how) const {
    if (how == Row::How::kMax) return most;
    return how == Row::How::kMin ? least : area / time;
  }
};

/// Returns the statistic of the simulation at the sample times of the data.
double OfSamples(const Row& row, const Course& course, double delay_s) {
  const Samples& samples = *row.samples;
  Total total;
  for (std::size_t i = 0; i < samples.time_s.size(); ++i) {
    const double time_s = course.Clamped(samples.time_s[i] - delay_s);
    double value =
        samples.orientation.empty() ? course.At(time_s) : course.At(time_s, samples.orientation[i]);
    if (row.period > 0) value = compare::NearestTurn(value, samples.measured[i], row.period);
    total.area += samples.weight[i] * value;
    total.time += samples.weight[i];
    total.Take(value);
  }
  return total.Of(row.how);
}

/// Returns the statistic of the simulation over the whole window.
double OfWhole(const Row& row, const Course& course, double delay_s) {
  const double from_s = course.Clamped(row.from_s - delay_s);
  const double to_s = course.Clamped(row.to_s - delay_s);
  double before_s = from_s, before = course.At(from_s);
  if (!(to_s > from_s)) return before;
  Total total;
  total.Take(before);
  const auto add = [&](double time_s, double value) {
    total.area += 0.5 * (time_s - before_s) * (before + value);
    total.Take(value);
    before_s = time_s, before = value;
  };
  const std::vector<double>& times = course.times();
  const auto first = std::upper_bound(times.begin(), times.end(), from_s);
  for (auto t = first; t != times.end() && *t < to_s; ++t) {
    add(*t, course.values()[static_cast<std::size_t>(t - times.begin())]);
  }
  add(to_s, course.At(to_s));
  total.time = to_s - from_s;
  return total.Of(row.how);
}

}  // namespace

void Samples::AddTo(base::Fnv1a& sum) const {
  for (const double each_s : time_s) sum.AddNumber(each_s);
  for (const double each : weight) sum.AddNumber(each);
}

RowChannels ChannelsOf(const Row& row, const std::function<std::size_t(const std::string&)>& need) {
  RowChannels channels;
  if (row.how == Row::How::kReference) return channels;
  channels.own = need(row.channel);
  if (!row.HasQuaternion()) return channels;
  auto& quaternion = channels.quaternion.emplace();
  const auto names = compare::QuaternionNames(row.channel);
  for (std::size_t k = 0; k < 4; ++k) quaternion[k] = need(names[k]);
  return channels;
}

std::optional<double> ValueOf(const Row& row, const Computed& computed, const RowChannels& channels,
                              double delay_s) {
  if (row.how == Row::How::kReference) {
    if (row.reference >= computed.references.size()) return std::nullopt;
    return computed.references[row.reference][row.value];
  }
  const Course course(row, computed, channels);
  const auto aligned = [&](double value) {
    return compare::NearestTurn(value, row.point.measured, row.period);
  };
  if (row.how == Row::How::kRow) {
    if (row.row >= course.values().size()) return std::nullopt;
    return aligned(course.OfRow(row.row, row.orientation));
  }
  const std::vector<double>& times = computed.time_s;
  if (times.empty()) return std::nullopt;
  if (row.how == Row::How::kRest) {
    const auto moment = std::lower_bound(times.begin(), times.end(), row.from_s - 1e-9);
    if (moment == times.end()) return std::nullopt;
    return aligned(course.OfRow(static_cast<std::size_t>(moment - times.begin()), row.orientation));
  }
  if (row.how == Row::How::kAt) {
    const double time_s = course.Clamped(row.from_s - delay_s);
    return aligned(row.orientation ? course.At(time_s, *row.orientation) : course.At(time_s));
  }
  return row.samples ? OfSamples(row, course, delay_s) : OfWhole(row, course, delay_s);
}

}  // namespace taut::identify
