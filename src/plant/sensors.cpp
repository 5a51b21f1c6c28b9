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
  bias_n_.resize(size);
  EachReading([size](std::vector<double>& row) { row.resize(size); }, seen_);
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
  std::copy_n(exact.stiffness_n_per_m, size, seen_.stiffness_n_per_m.begin());
  if (spec_.length_from_tension) {
    EstimateLength(exact.stiffness_n_per_m);
  } else {
    std::copy_n(exact.length_m, size, seen_.length_m.begin());
    std::copy_n(exact.rate_m_per_s, size, seen_.rate_m_per_s.begin());
  }
  // A load cell cannot tell the spring from the damper.
  const double* const elastic = spec_.load_cell ? seen_.tension_n.data() : exact.elastic_n;
  std::copy_n(elastic, size, seen_.elastic_n.begin());
  ++tick_;
}

void Sensors::SampleTension(const double* exact) {
  const std::size_t size = seen_.tension_n.size(), lanes = seeds_.size();
  if (!spec_.load_cell) {
    std::copy_n(exact, size, seen_.tension_n.begin());
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
  std::copy_n(tension_delay_.Oldest(tick_), size, seen_.tension_n.begin());
}

void Sensors::SampleRestLength(const double* exact) {
  const std::size_t size = seen_.rest_length_m.size();
  if (!spec_.encoder) {
    std::copy_n(exact, size, seen_.rest_length_m.begin());
    return;
  }
  const double quantum = spec_.encoder->quantum_m;
  double* const newest = rest_delay_.Newest(tick_);
  for (std::size_t i = 0; i < size; ++i) {
    newest[i] = quantum > 0 ? quantum * std::floor(exact[i] / quantum + 0.5) : exact[i];
  }
  std::copy_n(rest_delay_.Oldest(tick_), size, seen_.rest_length_m.begin());
}

void Sensors::EstimateLength(const double* stiffness) {
  for (std::size_t i = 0; i < seen_.length_m.size(); ++i) {
    const double length =
        control::LengthFromTension(seen_.rest_length_m[i], seen_.tension_n[i], stiffness[i]);
    seen_.rate_m_per_s[i] = tick_ == 0 ? 0.0 : (length - seen_.length_m[i]) / clock_.period_s;
    seen_.length_m[i] = length;
  }
}

ReadingRows Sensors::rows() const noexcept {
  return MapReadings([](const std::vector<double>& row) { return row.data(); }, seen_);
}

}  // namespace taut::plant
