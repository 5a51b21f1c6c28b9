// Sensors between the robot and its controllers, against closed forms
#include "plant/sensors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "plant/lane_clock.h"
#include "plant/loop.h"

namespace taut::plant {
namespace {

/// Rows for one cable in one world
struct One {
  CableState cable{.rest_length_m = 1.0,
                   .length_m = 1.1,
                   .rate_m_per_s = 0.0,
                   .tension_n = 10.0,
                   .elastic_n = 9.0,
                   .stiffness_n_per_m = 100.0};
  ReadingRows rows() const {
    return MapReadings([](const double& x) { return &x; }, cable);
  }
};

SensorSpec WithCell(const LoadCellSpec& cell) {
  SensorSpec spec;
  spec.load_cell = cell;
  return spec;
}

/// Sensors of one cable in one world, on their clock
struct Sampler {
  explicit Sampler(const SensorSpec& spec, std::uint64_t seed = 1)
      : sensors(spec, 1, {seed}), clock(sensors.clock(), 1) {}

  void Sample(double time_s, const One& exact) {
    const Tick tick = clock.Due(&time_s, AllLanes(1));
    Observation observation;
    observation.cables = exact.rows();
    if (tick.due != 0) sensors.Sample(tick, observation);
    clock.Advance(tick.due);
  }
  void SampleNext(const One& exact) { Sample(clock.NextS(0), exact); }
  CableState seen() const { return sensors.seen().Cable(0); }

  Sensors sensors;
  LaneClock clock;
};

/// Returns a cell's readings of a constant tension.
std::vector<double> Samples(const LoadCellSpec& cell, double tension_n, int count,
                            std::uint64_t seed = 1) {
  Sampler sensors(WithCell(cell), seed);
  One exact;
  exact.cable.tension_n = tension_n;
  std::vector<double> out;
  for (int i = 0; i < count; ++i) {
    sensors.SampleNext(exact);
    out.push_back(sensors.seen().tension_n);
  }
  return out;
}

struct Moments {
  double mean = 0, variance = 0;
};
Moments MomentsOf(const std::vector<double>& x) {
  Moments m;
  for (const double v : x) m.mean += v / static_cast<double>(x.size());
  for (const double v : x)
    m.variance += (v - m.mean) * (v - m.mean) / static_cast<double>(x.size());
  return m;
}

TEST(Sensors, WithoutAnythingAreExact) {
  Sampler sensors(SensorSpec{});
  One exact;
  sensors.Sample(0.0, exact);
  const CableState seen = sensors.seen();
  EXPECT_EQ(seen.rest_length_m, exact.cable.rest_length_m);
  EXPECT_EQ(seen.length_m, exact.cable.length_m);
  EXPECT_EQ(seen.tension_n, exact.cable.tension_n);
  EXPECT_EQ(seen.elastic_n, exact.cable.elastic_n);
  EXPECT_EQ(seen.stiffness_n_per_m, exact.cable.stiffness_n_per_m);
}

// n = 100000 samples: the mean is accurate to s / sqrt(n), the variance to s^2 sqrt(2 / n); times
// five.
TEST(Sensors, NoiseHasTheVarianceThatWasAskedFor) {
  LoadCellSpec cell;
  cell.noise_n = 0.3;
  const int n = 100'000;
  const Moments m = MomentsOf(Samples(cell, 10.0, n));
  EXPECT_NEAR(m.mean, 10.0, 5 * 0.3 / std::sqrt(n));
  EXPECT_NEAR(m.variance, 0.09, 5 * 0.09 * std::sqrt(2.0 / n));
  EXPECT_EQ(Samples(cell, 10.0, 5, 7), Samples(cell, 10.0, 5, 7));
  EXPECT_NE(Samples(cell, 10.0, 5, 7), Samples(cell, 10.0, 5, 8));
}

TEST(Sensors, ABiasStaysForARunAndDiffersBetweenRuns) {
  LoadCellSpec cell;
  cell.bias_n = 0.5;
  std::vector<double> biases;
  for (std::uint64_t seed = 0; seed < 20'000; ++seed) {
    const auto samples = Samples(cell, 10.0, 2, seed);
    ASSERT_EQ(samples[0], samples[1]);
    biases.push_back(samples[0] - 10.0);
  }
  const Moments m = MomentsOf(biases);
  EXPECT_NEAR(m.mean, 0.0, 5 * 0.5 / std::sqrt(20'000));
  EXPECT_NEAR(m.variance, 0.25, 5 * 0.25 * std::sqrt(2.0 / 20'000));
}

// A rounded number is off by up to half a quantum, uniformly: variance q^2 / 12. The number passes
// n = 1000 places of each quantum, whose variance is q^2 / 12 (1 - 1 / n^2).
TEST(Sensors, QuantaAreThoseOfTheConverter) {
  LoadCellSpec cell;
  cell.max_n = 100.0;
  cell.quantum_n = 100.0 / 1023.0;
  std::vector<double> errors;
  for (int i = 0; i < 10'000; ++i) {
    const double exact = 20.0 + cell.quantum_n * (i + 0.5) / 1000;
    const double seen = Samples(cell, exact, 1)[0];
    const double counts = seen / cell.quantum_n;
    ASSERT_NEAR(counts, std::round(counts), 1e-9);
    ASSERT_LE(std::fabs(seen - exact), 0.5 * cell.quantum_n * (1 + 1e-9));
    errors.push_back(seen - exact);
  }
  const Moments m = MomentsOf(errors);
  const double q = cell.quantum_n;
  EXPECT_NEAR(m.variance, q * q / 12, 1e-3 * q * q);
}

TEST(Sensors, ACellSaturatesAtTheEndsOfItsRange) {
  LoadCellSpec cell;
  cell.min_n = 1.0;
  cell.max_n = 50.0;
  EXPECT_EQ(Samples(cell, 60.0, 1)[0], 50.0);
  EXPECT_EQ(Samples(cell, 0.2, 1)[0], 1.0);
  EXPECT_EQ(Samples(cell, 20.0, 1)[0], 20.0);
}

// A ramp seen d samples late is lower by d times its rise; before that, the first sample is kept.
TEST(Sensors, ADelayIsWholeSamples) {
  LoadCellSpec cell;
  cell.delay_s = 0.003;
  SensorSpec spec = WithCell(cell);
  spec.encoder = EncoderSpec{0.0, 0.001};
  Sampler sensors(spec);
  One exact;
  for (int i = 0; i < 10; ++i) {
    exact.cable.tension_n = 10.0 + i;
    exact.cable.rest_length_m = 1.0 - 0.25 * i;
    sensors.SampleNext(exact);
    EXPECT_EQ(sensors.seen().tension_n, 10.0 + std::max(0, i - 3));
    EXPECT_EQ(sensors.seen().elastic_n,
              sensors.seen().tension_n);  // a cell measures the whole tension only
    EXPECT_EQ(sensors.seen().rest_length_m, 1.0 - 0.25 * std::max(0, i - 1));
  }
}

TEST(Sensors, AnEncoderCounts) {
  SensorSpec spec;
  spec.encoder = EncoderSpec{0.25, 0.0};
  Sampler sensors(spec);
  One exact;
  for (const auto& [rest, seen] : {std::pair{1.1, 1.0}, {1.13, 1.25}, {0.1, 0.0}}) {
    exact.cable.rest_length_m = rest;
    sensors.SampleNext(exact);
    EXPECT_EQ(sensors.seen().rest_length_m, seen);
  }
}

// L + T / k, and its rate from one sample to the next
TEST(Sensors, LengthFollowsFromTensionAndRestLength) {
  SensorSpec spec;
  spec.length_from_tension = true;
  Sampler sensors(spec);
  One exact;
  sensors.Sample(0.0, exact);
  EXPECT_DOUBLE_EQ(sensors.seen().length_m, 1.0 + 10.0 / 100.0);
  EXPECT_EQ(sensors.seen().rate_m_per_s, 0.0);
  exact.cable.tension_n = 10.5;
  sensors.Sample(0.001, exact);
  EXPECT_NEAR(sensors.seen().rate_m_per_s, 0.005 / 0.001, 1e-9);
}

TEST(Sensors, SampleOnTheirOwnClock) {
  SensorSpec spec;
  spec.period_s = 0.01;
  Sampler sensors(spec);
  One exact;
  for (int ms = 0; ms < 30; ++ms) {
    exact.cable.tension_n = ms;
    sensors.Sample(0.001 * ms, exact);
    EXPECT_EQ(sensors.seen().tension_n, ms / 10 * 10);
  }
}

// The paper's eq. 7, inverted and rounded down: count = floor((T + 4.9363) / 0.1567)
TEST(Sensors, CountsAreThoseOfThePaper) {
  LoadCellSpec cell;
  cell.counts.emplace();
  for (const auto& [tension_n, count] :
       {std::pair{0.0, 31}, {-4.9363, 0}, {-6.0, 0}, {20.0, 159}, {50.0, 350}, {110.0, 733}}) {
    EXPECT_EQ(std::floor((tension_n + 4.9363) / 0.1567), tension_n == -6.0 ? -7 : count);
    EXPECT_EQ(Samples(cell, tension_n, 1)[0], 0.1567 * count - 4.9363) << tension_n;
  }
  // The amplifier saturates at 25 lb, 111.21 N; a converter of 9 bits saturates before.
  EXPECT_NEAR(Samples(cell, 150.0, 1)[0], 111.21, 0.1567);
  cell.counts->bits = 9;
  EXPECT_EQ(Samples(cell, 150.0, 1)[0], 0.1567 * 511 - 4.9363);
}

// Noise of s counts, rounded down: the mean is half a count low, the variance s^2 + 1 / 12.
TEST(Sensors, NoiseInCountsSmoothesTheRounding) {
  LoadCellSpec cell;
  cell.counts.emplace();
  cell.counts->noise_counts = 1.5;
  const int n = 100'000;
  const Moments m = MomentsOf(Samples(cell, 20.0, n));
  const double g = 0.1567, variance = g * g * (1.5 * 1.5 + 1.0 / 12);
  EXPECT_NEAR(m.mean, 20.0 - 0.5 * g, 5 * std::sqrt(variance / n));
  EXPECT_NEAR(m.variance, variance, 5 * variance * std::sqrt(2.0 / n));
}

// Each cell has a separate gain and drift, constant during a run.
TEST(Sensors, GainsAndDriftsAreDrawnOnceARun) {
  LoadCellSpec cell;
  cell.gain_error = 0.02;
  cell.drift_n_per_s = 0.1;
  std::vector<double> gains, drifts;
  for (std::uint64_t seed = 0; seed < 20'000; ++seed) {
    const auto at_10 = Samples(cell, 10.0, 3, seed), at_30 = Samples(cell, 30.0, 1, seed);
    gains.push_back((at_30[0] - at_10[0]) / 20 - 1);
    ASSERT_NEAR(at_30[0] - 30, 30 * gains.back(), 1e-12);
    drifts.push_back((at_10[2] - at_10[0]) / 0.002);
    ASSERT_NEAR(at_10[1] - at_10[0], 0.001 * drifts.back(), 1e-12);
  }
  EXPECT_NEAR(MomentsOf(gains).variance, 4e-4, 5 * 4e-4 * std::sqrt(2.0 / 20'000));
  EXPECT_NEAR(MomentsOf(drifts).variance, 0.01, 5 * 0.01 * std::sqrt(2.0 / 20'000));
}

// A zero error persists until an index mark passes; then the error is a whole number of turns.
TEST(Sensors, AnIndexLeavesWholeTurnsOfAWrongZero) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SensorSpec spec;
    spec.encoder = EncoderSpec{.zero_error_m = 0.3, .index_m = 0.25};
    Sampler sensors(spec, seed);
    One exact;
    exact.cable.rest_length_m = 1.1;
    sensors.SampleNext(exact);
    const double zero = sensors.seen().rest_length_m - 1.1;
    exact.cable.rest_length_m = 1.01;  // no mark: they are at 1.0 and 1.25
    sensors.SampleNext(exact);
    ASSERT_NEAR(sensors.seen().rest_length_m - 1.01, zero, 1e-12);
    for (const double rest : {0.99, 1.2}) {
      exact.cable.rest_length_m = rest;
      sensors.SampleNext(exact);
      const double turns = (sensors.seen().rest_length_m - rest) / 0.25;
      ASSERT_NEAR(turns, std::round(turns), 1e-9);
      ASSERT_NEAR(turns, zero / 0.25, 0.5 + 1e-9);
    }
  }
}

// Gain error: the displacement from the start is wrong, the start is not.
TEST(Sensors, AnEncodersGainIsOfTheWayFromTheStart) {
  std::vector<double> gains;
  for (std::uint64_t seed = 0; seed < 20'000; ++seed) {
    SensorSpec spec;
    spec.encoder = EncoderSpec{.gain_error = 0.05};
    Sampler sensors(spec, seed);
    One exact;
    sensors.SampleNext(exact);
    ASSERT_EQ(sensors.seen().rest_length_m, 1.0);
    exact.cable.rest_length_m = 0.8;
    sensors.SampleNext(exact);
    gains.push_back((1.0 - sensors.seen().rest_length_m) / 0.2 - 1);
  }
  EXPECT_NEAR(MomentsOf(gains).variance, 0.0025, 5 * 0.0025 * std::sqrt(2.0 / 20'000));
}

// If a gear has backlash, an encoder measures the shaft's motion, not the cable's.
TEST(Sensors, AnEncoderIsOnTheMotorsShaft) {
  SensorSpec spec;
  spec.encoder = EncoderSpec{0.25, 0.0};
  Sampler sensors(spec);
  One exact;
  const double shaft_m = 1.6;
  Observation observation;
  observation.cables = exact.rows();
  observation.shaft_m = &shaft_m;
  const double time_s = 0;
  const Tick tick = sensors.clock.Due(&time_s, AllLanes(1));
  sensors.sensors.Sample(tick, observation);
  EXPECT_EQ(sensors.seen().rest_length_m, 1.5);
}

// The noise does not depend on the step, because it is drawn per sample, not per step.
TEST(Sensors, NoiseDoesNotDependOnTheStep) {
  Diagnostics out;
  auto experiment =
      LoadExperiment(std::string(TAUT_SOURCE_DIR) + "/share/experiments/stand_still.yaml", {}, out);
  ASSERT_TRUE(experiment) << out.Format();
  LoadCellSpec cell;
  cell.noise_n = 1.0;
  experiment->sensors = WithCell(cell);
  const auto noise_at_end = [&](double step_s) {
    experiment->step_s = step_s;
    WorldBatch batch(Model::Compile(experiment->robot.def, out), {});
    const auto plant = PlantOf(batch);
    Loop loop(*experiment, *plant);
    while (loop.time_s() < 0.1 - 1e-9) loop.Step();
    const double exact_n = loop.exact().Cable(3).tension_n;
    loop.Prepare();
    return loop.seen().Cable(3).tension_n - exact_n;
  };
  const double noise = noise_at_end(0.001);
  EXPECT_GT(std::fabs(noise), 1e-3);
  EXPECT_NEAR(noise_at_end(0.0001), noise, 1e-12);
}

}  // namespace
}  // namespace taut::plant
