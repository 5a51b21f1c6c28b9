#include "plant/sensors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/random.h"
#include "plant/streams.h"
#include "taut/control/impedance.h"

namespace taut::plant {

Sensors::Delay::Delay(double delay_s, double period_s, std::size_t size)
    : delay_(static_cast<std::int64_t>(std::floor(delay_s / period_s + 0.5))),
      size_(size),
      ring_(size * static_cast<std::size_t>(delay_ + 1)) {}

double* Sensors::Delay::Slot(std::int64_t tick) noexcept {
  return ring_.data() + size_ * static_cast<std::size_t>(tick % (delay_ + 1));
}

Sensors::Sensors(const SensorSpec& spec, std::size_t cable_count, std::vector<std::uint64_t> seeds)
    : spec_(spec),
      clock_{spec.period_s, 0.0},
      cable_count_(cable_count),
      seeds_(std::move(seeds)),
      tension_delay_(spec.load_cell ? spec.load_cell->delay_s : 0.0, spec.period_s,
                     cable_count * seeds_.size()),
      rest_delay_(spec.encoder ? spec.encoder->delay_s : 0.0, spec.period_s,
                  cable_count * seeds_.size()) {
  const std::size_t size = cable_count * seeds_.size();
  for (std::vector<double>* row :
       {&bias_n_, &rest_m_, &length_m_, &rate_m_per_s_, &tension_n_, &elastic_n_, &stiffness_}) {
    row->resize(size);
  }
  if (!spec_.load_cell || spec_.load_cell->bias_n == 0) return;
  for (std::size_t i = 0; i < size; ++i) {
    math::Random random(seeds_[i % seeds_.size()], kLoadCellBias, i / seeds_.size());
    bias_n_[i] = spec_.load_cell->bias_n * random.Normal();
  }
}

void Sensors::Sample(double time_s, const ReadingRows& exact) {
  if (!control::IsDue(clock_, tick_, time_s)) return;
  const std::size_t size = bias_n_.size();
  SampleTension(exact.tension_n);
  SampleRestLength(exact.rest_length_m);
  std::copy_n(exact.stiffness_n_per_m, size, stiffness_.begin());
  if (spec_.length_from_tension) {
    EstimateLength(exact.stiffness_n_per_m);
  } else {
    std::copy_n(exact.length_m, size, length_m_.begin());
    std::copy_n(exact.rate_m_per_s, size, rate_m_per_s_.begin());
  }
  // A load cell cannot tell the spring from the damper.
  const double* const elastic = spec_.load_cell ? tension_n_.data() : exact.elastic_n;
  std::copy_n(elastic, size, elastic_n_.begin());
  ++tick_;
}

void Sensors::SampleTension(const double* exact) {
  const std::size_t size = tension_n_.size(), lanes = seeds_.size();
  if (!spec_.load_cell) {
    std::copy_n(exact, size, tension_n_.begin());
    return;
  }
  const LoadCellSpec& cell = *spec_.load_cell;
  double* const newest = tension_delay_.Newest(tick_);
  for (std::size_t i = 0; i < size; ++i) newest[i] = exact[i] + bias_n_[i];
  if (cell.noise_n > 0) {
    for (std::size_t i = 0; i < size; ++i) {
      const std::uint64_t sample =
          static_cast<std::uint64_t>(tick_) * cable_count_ + static_cast<std::uint64_t>(i / lanes);
      newest[i] += cell.noise_n * math::Random(seeds_[i % lanes], kLoadCellNoise, sample).Normal();
    }
  }
  for (std::size_t i = 0; i < size; ++i) {
    double x = std::max(cell.min_n, std::min(cell.max_n, newest[i]));
    if (cell.quantum_n > 0) {
      x = cell.min_n + cell.quantum_n * std::floor((x - cell.min_n) / cell.quantum_n + 0.5);
    }
    newest[i] = x;
  }
  std::copy_n(tension_delay_.Oldest(tick_), size, tension_n_.begin());
}

void Sensors::SampleRestLength(const double* exact) {
  const std::size_t size = rest_m_.size();
  if (!spec_.encoder) {
    std::copy_n(exact, size, rest_m_.begin());
    return;
  }
  const double quantum = spec_.encoder->quantum_m;
  double* const newest = rest_delay_.Newest(tick_);
  for (std::size_t i = 0; i < size; ++i) {
    newest[i] = quantum > 0 ? quantum * std::floor(exact[i] / quantum + 0.5) : exact[i];
  }
  std::copy_n(rest_delay_.Oldest(tick_), size, rest_m_.begin());
}

void Sensors::EstimateLength(const double* stiffness) {
  for (std::size_t i = 0; i < length_m_.size(); ++i) {
    const double length = control::LengthFromTension(rest_m_[i], tension_n_[i], stiffness[i]);
    rate_m_per_s_[i] = tick_ == 0 ? 0.0 : (length - length_m_[i]) / clock_.period_s;
    length_m_[i] = length;
  }
}

ReadingRows Sensors::rows() const noexcept {
  return {rest_m_.data(),    length_m_.data(),  rate_m_per_s_.data(),
          tension_n_.data(), elastic_n_.data(), stiffness_.data()};
}

}  // namespace taut::plant
