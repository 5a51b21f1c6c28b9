#include "plant/sensors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/random.h"
#include "plant/random_streams.h"
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
      errors_(cable_count * seeds_.size()) {
  EachReading([this](std::vector<double>& row) { row.resize(errors_.size()); }, seen_);
  shown_.cables = MapReadings([](const std::vector<double>& row) { return row.data(); }, seen_);
  for (std::size_t j = 0; j < seeds_.size(); ++j) DrawErrors(j);
}

void Sensors::DrawErrors(std::size_t lane) {
  for (std::size_t c = 0; c < cable_count_; ++c) {
    Errors& of = errors_[c * seeds_.size() + lane];
    of = {};
    const auto draw = [&](double deviation, std::uint32_t stream) {
      return deviation == 0 ? 0.0 : deviation * math::Random(seeds_[lane], stream, c).Normal();
    };
    if (spec_.load_cell) {
      of.bias_n = draw(spec_.load_cell->bias_n, kLoadCellBias);
      of.gain = 1 + draw(spec_.load_cell->gain_error, kLoadCellGain);
      of.drift_n_per_s = draw(spec_.load_cell->drift_n_per_s, kLoadCellDrift);
    }
    if (spec_.encoder) {
      of.zero_m = draw(spec_.encoder->zero_error_m, kEncoderZero);
      of.encoder_gain = 1 + draw(spec_.encoder->gain_error, kEncoderGain);
    }
  }
}

void Sensors::Restart(int lane, const RolloutWorld& world) {
  const auto j = static_cast<std::size_t>(lane);
  seeds_[j] = world.seed;
  DrawErrors(j);
}

/// Slots of the delay line count from the lane's first tick, so their order is the same in every
/// lane.
void Sensors::Serialize(LaneState& state) {
  tension_delay_.Serialize(state);
  rest_delay_.Serialize(state);
  for (std::size_t i = static_cast<std::size_t>(state.lane()); i < errors_.size();
       i += seeds_.size()) {
    Errors& of = errors_[i];
    state.Values(of.bias_n, of.gain, of.drift_n_per_s, of.zero_m, of.encoder_gain, of.start_m,
                 of.index_passed);
  }
  EachReading([&state](std::vector<double>& row) { state.Row(row); }, seen_);
}

void Sensors::Sample(const Tick& tick, const Observation& exact) {
  shown_.lanes = exact.lanes;
  shown_.time_s = exact.time_s;
  shown_.faults = exact.faults;
  shown_.bodies = exact.bodies;
  shown_.goal = exact.goal;
  const std::size_t lanes = seeds_.size();
  for (std::size_t i = 0; i < errors_.size(); ++i) {
    const std::size_t lane = i % lanes;
    if (!Has(tick.due, static_cast<int>(lane))) continue;
    const std::int64_t number = tick.number[lane];
    seen_.tension_n[i] = Tension(i, number, exact.cables.tension_n[i]);
    const double* const rest_m = exact.shaft_m ? exact.shaft_m : exact.cables.rest_length_m;
    seen_.rest_length_m[i] = RestLength(i, number, rest_m[i]);
    seen_.stiffness_n_per_m[i] = exact.cables.stiffness_n_per_m[i];
    if (spec_.length_from_tension) {
      EstimateLength(i, number, exact.cables.stiffness_n_per_m[i]);
    } else {
      seen_.length_m[i] = exact.cables.length_m[i];
      seen_.rate_m_per_s[i] = exact.cables.rate_m_per_s[i];
    }
    // A load cell measures the forces of spring and damper together.
    seen_.elastic_n[i] = spec_.load_cell ? seen_.tension_n[i] : exact.cables.elastic_n[i];
  }
}

double Sensors::Normal(std::size_t i, std::int64_t tick, std::uint32_t stream) const {
  const std::size_t lanes = seeds_.size();
  const std::uint64_t sample =
      static_cast<std::uint64_t>(tick) * cable_count_ + static_cast<std::uint64_t>(i / lanes);
  return math::Random(seeds_[i % lanes], stream, sample).Normal();
}

/// Returns the measured tension (docs/theory/sensors.md, S.1 to S.3).
double Sensors::Tension(std::size_t i, std::int64_t tick, double exact) {
  if (!spec_.load_cell) return exact;
  const LoadCellSpec& cell = *spec_.load_cell;
  const Errors& wrong = errors_[i];
  double x = wrong.gain * exact + wrong.bias_n;
  if (wrong.drift_n_per_s != 0) {
    x += wrong.drift_n_per_s * (static_cast<double>(tick) * spec_.period_s);
  }
  if (cell.noise_n > 0) x += cell.noise_n * Normal(i, tick, kLoadCellNoise);
  if (cell.counts) {
    x = Counted(*cell.counts, i, tick, x);
  } else {
    x = std::max(cell.min_n, std::min(cell.max_n, x));
    if (cell.quantum_n > 0) {
      x = cell.min_n + cell.quantum_n * std::floor((x - cell.min_n) / cell.quantum_n + 0.5);
    }
  }
  tension_delay_.Newest(i, tick) = x;
  return tension_delay_.Oldest(i, tick);
}

/// Returns the tension that the board computes from an integer count (docs/theory/sensors.md, S.4).
double Sensors::Counted(const LoadCellCounts& counts, std::size_t i, std::int64_t tick,
                        double x) const {
  double u = (x - counts.offset_n) / counts.gain_n_per_count;
  if (counts.noise_counts > 0) u += counts.noise_counts * Normal(i, tick, kLoadCellCount);
  const double last =
      std::min(std::ldexp(1.0, counts.bits) - 1.0, static_cast<double>(counts.saturation_count));
  const double count = std::max(0.0, std::min(last, std::floor(u)));
  return counts.gain_n_per_count * count + counts.offset_n;
}

/// Returns the measured rest length (docs/theory/sensors.md, S.5 and S.6).
double Sensors::RestLength(std::size_t i, std::int64_t tick, double exact) {
  if (!spec_.encoder) return exact;
  const EncoderSpec& encoder = *spec_.encoder;
  Errors& wrong = errors_[i];
  if (tick == 0) wrong.start_m = exact;
  const double mark = encoder.index_m;
  if (mark > 0 && !wrong.index_passed &&
      std::floor(exact / mark) != std::floor(wrong.start_m / mark)) {
    wrong.index_passed = true;
    wrong.zero_m = mark * std::floor(wrong.zero_m / mark + 0.5);
  }
  double x = exact;
  if (wrong.encoder_gain != 1) x = wrong.start_m + wrong.encoder_gain * (exact - wrong.start_m);
  x += wrong.zero_m;
  const double quantum = encoder.quantum_m;
  rest_delay_.Newest(i, tick) = quantum > 0 ? quantum * std::floor(x / quantum + 0.5) : x;
  return rest_delay_.Oldest(i, tick);
}

void Sensors::EstimateLength(std::size_t i, std::int64_t tick, double stiffness) {
  const double length =
      control::LengthFromTension(seen_.rest_length_m[i], seen_.tension_n[i], stiffness);
  seen_.rate_m_per_s[i] = tick == 0 ? 0.0 : (length - seen_.length_m[i]) / spec_.period_s;
  seen_.length_m[i] = length;
}

}  // namespace taut::plant
