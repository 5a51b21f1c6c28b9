#include "plant/sensors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/random.h"
#include "plant/streams.h"
#include "taut/control/impedance.h"

namespace taut::plant {

Sensors::Delay::Delay(double delay_s, double period_s, std::size_t cables, std::size_t lanes)
    : delay_(static_cast<std::int64_t>(std::floor(delay_s / period_s + 0.5))),
      size_(cables * lanes),
      ring_(size_ * static_cast<std::size_t>(delay_ + 1)) {}

Sensors::Sensors(const SensorSpec& spec, std::size_t cable_count, std::vector<std::uint64_t> seeds)
    : spec_(spec),
      cable_count_(cable_count),
      seeds_(std::move(seeds)),
      tension_delay_(spec.load_cell ? spec.load_cell->delay_s : 0.0, spec.period_s, cable_count,
                     seeds_.size()),
      rest_delay_(spec.encoder ? spec.encoder->delay_s : 0.0, spec.period_s, cable_count,
                  seeds_.size()),
      bias_n_(cable_count * seeds_.size()) {
  EachReading([this](std::vector<double>& row) { row.resize(bias_n_.size()); }, seen_);
  shown_.cables = MapReadings([](const std::vector<double>& row) { return row.data(); }, seen_);
  for (std::size_t j = 0; j < seeds_.size(); ++j) DrawBias(j);
}

void Sensors::DrawBias(std::size_t lane) {
  if (!spec_.load_cell || spec_.load_cell->bias_n == 0) return;
  for (std::size_t c = 0; c < cable_count_; ++c) {
    math::Random random(seeds_[lane], kLoadCellBias, c);
    bias_n_[c * seeds_.size() + lane] = spec_.load_cell->bias_n * random.Normal();
  }
}

void Sensors::Restart(int lane, const RolloutWorld& world) {
  const auto j = static_cast<std::size_t>(lane);
  seeds_[j] = world.seed;
  DrawBias(j);
}

void Sensors::Sample(const Tick& tick, const Observation& exact) {
  shown_.lanes = exact.lanes;
  shown_.time_s = exact.time_s;
  shown_.faults = exact.faults;
  shown_.bodies = exact.bodies;
  const std::size_t lanes = seeds_.size();
  for (std::size_t i = 0; i < bias_n_.size(); ++i) {
    const std::size_t lane = i % lanes;
    if (!Has(tick.due, static_cast<int>(lane))) continue;
    const std::int64_t number = tick.number[lane];
    seen_.tension_n[i] = Tension(i, number, exact.cables.tension_n[i]);
    seen_.rest_length_m[i] = RestLength(i, number, exact.cables.rest_length_m[i]);
    seen_.stiffness_n_per_m[i] = exact.cables.stiffness_n_per_m[i];
    if (spec_.length_from_tension) {
      EstimateLength(i, number, exact.cables.stiffness_n_per_m[i]);
    } else {
      seen_.length_m[i] = exact.cables.length_m[i];
      seen_.rate_m_per_s[i] = exact.cables.rate_m_per_s[i];
    }
    // A load cell cannot tell the spring from the damper.
    seen_.elastic_n[i] = spec_.load_cell ? seen_.tension_n[i] : exact.cables.elastic_n[i];
  }
}

double Sensors::Tension(std::size_t i, std::int64_t tick, double exact) {
  if (!spec_.load_cell) return exact;
  const LoadCellSpec& cell = *spec_.load_cell;
  const std::size_t lanes = seeds_.size();
  double x = exact + bias_n_[i];
  if (cell.noise_n > 0) {
    const std::uint64_t sample =
        static_cast<std::uint64_t>(tick) * cable_count_ + static_cast<std::uint64_t>(i / lanes);
    x += cell.noise_n * math::Random(seeds_[i % lanes], kLoadCellNoise, sample).Normal();
  }
  x = std::max(cell.min_n, std::min(cell.max_n, x));
  if (cell.quantum_n > 0) {
    x = cell.min_n + cell.quantum_n * std::floor((x - cell.min_n) / cell.quantum_n + 0.5);
  }
  tension_delay_.Newest(i, tick) = x;
  return tension_delay_.Oldest(i, tick);
}

double Sensors::RestLength(std::size_t i, std::int64_t tick, double exact) {
  if (!spec_.encoder) return exact;
  const double quantum = spec_.encoder->quantum_m;
  rest_delay_.Newest(i, tick) = quantum > 0 ? quantum * std::floor(exact / quantum + 0.5) : exact;
  return rest_delay_.Oldest(i, tick);
}

void Sensors::EstimateLength(std::size_t i, std::int64_t tick, double stiffness) {
  const double length =
      control::LengthFromTension(seen_.rest_length_m[i], seen_.tension_n[i], stiffness);
  seen_.rate_m_per_s[i] = tick == 0 ? 0.0 : (length - seen_.length_m[i]) / spec_.period_s;
  seen_.length_m[i] = length;
}

}  // namespace taut::plant
