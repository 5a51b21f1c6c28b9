// Sensors of several cables in several worlds: assignment of noise and errors to worlds, and
// restarts
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "plant/sensors.h"

namespace taut::plant {
namespace {

constexpr std::size_t kCables = 2, kLanes = 3;
using Row = std::array<double, kCables * kLanes>;  // cable c of lane j at c kLanes + j

/// Equal cables, and their sensor readings
class Company {
 public:
  explicit Company(const SensorSpec& spec) : sensors_(spec, kCables, {11, 12, 13}) {
    rest_m.fill(1.0);
    tension_n.fill(10.0);
    rest_.fill(1.0);
  }
  void Sample(Lanes due, const std::array<std::int64_t, kLanes>& number) {
    const std::array<double, kLanes> time_s{};
    Observation exact;
    exact.lanes = kLanes;
    exact.time_s = time_s.data();
    exact.cables =
        MapReadings([this](const double&) { return std::as_const(rest_).data(); }, CableState{});
    exact.cables.rest_length_m = rest_m.data();
    exact.cables.tension_n = tension_n.data();
    sensors_.Sample({due, number.data()}, exact);
  }
  void Sample(std::int64_t number) { Sample(AllLanes(kLanes), {number, number, number}); }
  Row Tensions() const { return Seen(sensors_.seen().cables.tension_n); }
  Row RestLengths() const { return Seen(sensors_.seen().cables.rest_length_m); }
  void Restart(int lane, std::uint64_t seed) {
    RolloutWorld world;
    world.seed = seed;
    sensors_.Restart(lane, world);
  }

  Row rest_m, tension_n;

 private:
  static Row Seen(const double* row) {
    Row out;
    std::copy_n(row, out.size(), out.begin());
    return out;
  }
  Sensors sensors_;
  Row rest_;
};

SensorSpec Noisy() {
  SensorSpec spec;
  spec.load_cell.emplace().noise_n = 0.5;
  return spec;
}

TEST(SensorLanes, EveryCableOfEveryWorldHasItsOwnNoise) {
  Company company(Noisy());
  std::set<double> all;
  for (int tick = 0; tick < 10; ++tick) {
    company.Sample(tick);
    for (const double seen : company.Tensions()) all.insert(seen);
  }
  EXPECT_EQ(all.size(), 10 * kCables * kLanes);
}

TEST(SensorLanes, AWorldsNoiseIsThatOfItsSeedWhoeverStandsBesideIt) {
  Company company(Noisy());
  Sensors alone(Noisy(), kCables, {12});
  std::array<double, kCables> ten;
  ten.fill(10.0);
  const double time_s = 0;
  Observation exact;
  exact.time_s = &time_s;
  exact.cables =
      MapReadings([&](const double&) { return std::as_const(ten).data(); }, CableState{});
  for (std::int64_t tick = 0; tick < 5; ++tick) {
    company.Sample(tick);
    alone.Sample({1, &tick}, exact);
    for (int c = 0; c < static_cast<int>(kCables); ++c) {
      EXPECT_EQ(company.Tensions()[static_cast<std::size_t>(c) * kLanes + 1],
                alone.seen().Cable(c).tension_n);
    }
  }
}

TEST(SensorLanes, AWorldThatIsNotDueKeepsWhatItHas) {
  Company company(Noisy());
  company.Sample(0);
  const Row before = company.Tensions();
  company.tension_n.fill(20.0);
  company.Sample(0b101, {1, 1, 1});
  const Row now = company.Tensions();
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (i % kLanes == 1) {
      EXPECT_EQ(now[i], before[i]);
    } else {
      EXPECT_GT(now[i], 15);
    }
  }
}

// A restarted world has the errors of its new seed, and its encoders have not passed an index mark.
TEST(SensorLanes, AWorldThatBeginsAnewHasOtherErrorsAndKnowsNoMark) {
  SensorSpec spec;
  spec.load_cell.emplace().bias_n = 0.5;
  spec.encoder = EncoderSpec{.zero_error_m = 0.3, .index_m = 0.25};
  Company company(spec);
  company.Sample(0);
  const Row biased_n = company.Tensions();
  company.rest_m.fill(1.3);  // over the mark at 1.25
  company.Sample(1);
  company.Restart(1, 99);
  company.rest_m.fill(1.1);
  company.Sample(AllLanes(kLanes), {2, 0, 2});
  const Row tension_n = company.Tensions(), rest_m = company.RestLengths();
  for (std::size_t i = 0; i < tension_n.size(); ++i) {
    const double turns = (rest_m[i] - 1.1) / 0.25;
    if (i % kLanes == 1) {
      EXPECT_NE(tension_n[i], biased_n[i]);
      EXPECT_GT(std::fabs(turns - std::round(turns)), 1e-3) << "the zero is wrong again";
    } else {
      EXPECT_EQ(tension_n[i], biased_n[i]);
      EXPECT_NEAR(turns, std::round(turns), 1e-9);
    }
  }
}

// The next mark that a restarted world passes has its effect.
TEST(SensorLanes, AWorldThatBeganAnewSeesItsMark) {
  SensorSpec spec;
  spec.encoder = EncoderSpec{.zero_error_m = 0.3, .index_m = 0.25};
  Company company(spec);
  const auto sample = [&company](double rest_m, std::int64_t number) {
    company.rest_m.fill(rest_m);
    company.Sample(number);
  };
  sample(1.1, 0);
  sample(1.3, 1);
  for (int lane = 0; lane < static_cast<int>(kLanes); ++lane) {
    company.Restart(lane, 20 + static_cast<std::uint64_t>(lane));
  }
  sample(1.1, 0);
  sample(1.3, 1);
  for (const double seen : company.RestLengths()) {
    EXPECT_NEAR((seen - 1.3) / 0.25, std::round((seen - 1.3) / 0.25), 1e-9);
  }
}

TEST(SensorLanes, ADelayIsTheNearestNumberOfSamples) {
  for (const auto& [delay_s, samples] : {std::pair{0.0024, 2}, {0.0026, 3}, {0.0004, 0}}) {
    SensorSpec spec;
    spec.load_cell.emplace().delay_s = delay_s;
    Company company(spec);
    for (int tick = 0; tick < 6; ++tick) {
      company.tension_n.fill(tick);
      company.Sample(tick);
    }
    EXPECT_EQ(company.Tensions()[0], 5 - samples) << delay_s;
  }
}

// A converter counts from the lower end of its range.
TEST(SensorLanes, QuantaBeginAtTheLowerEndOfTheRange) {
  SensorSpec spec;
  spec.load_cell.emplace().min_n = 1.03;
  spec.load_cell->max_n = 50;
  spec.load_cell->quantum_n = 0.5;
  Company company(spec);
  company.tension_n.fill(10.0);
  company.Sample(0);
  EXPECT_DOUBLE_EQ(company.Tensions()[0], 1.03 + 18 * 0.5);
}

// Noise of the force and noise of the counts are independent: their variances add (n = 60000:
// accurate to s^2 sqrt(2 / n); times five).
TEST(SensorLanes, BothNoisesOfACellAreIndependent) {
  SensorSpec spec = Noisy();
  spec.load_cell->counts.emplace().noise_counts = 3;
  Company company(spec);
  company.tension_n.fill(50.0);
  double mean = 0, square = 0;
  const int ticks = 10'000, n = ticks * static_cast<int>(kCables * kLanes);
  for (int tick = 0; tick < ticks; ++tick) {
    company.Sample(tick);
    for (const double seen : company.Tensions()) {
      mean += (seen - 50) / n;
      square += (seen - 50) * (seen - 50) / n;
    }
  }
  const double g = 0.1567, variance = 0.25 + g * g * (9 + 1.0 / 12);
  EXPECT_NEAR(square - mean * mean, variance, 5 * variance * std::sqrt(2.0 / n));
}

// Bias and gain are drawn independently: with both, a cell without load is off by the bias.
TEST(SensorLanes, ACellsGainLeavesItsBiasAlone) {
  SensorSpec bias, both;
  bias.load_cell.emplace().min_n = -10;
  bias.load_cell->bias_n = 0.5;
  both = bias;
  both.load_cell->gain_error = 0.1;
  Company one(bias), other(both);
  for (Company* company : {&one, &other}) {
    company->tension_n.fill(0.0);
    company->Sample(0);
  }
  EXPECT_EQ(one.Tensions(), other.Tensions());
  EXPECT_NE(one.Tensions()[0], 0);
}

// The zero error is an absolute offset: the encoder's gain, which scales displacements, does not
// change it.
TEST(SensorLanes, AnEncodersGainLeavesItsZeroAlone) {
  SensorSpec zero, both;
  zero.encoder = EncoderSpec{.zero_error_m = 0.3};
  both.encoder = EncoderSpec{.zero_error_m = 0.3, .gain_error = 0.05};
  Company one(zero), other(both);
  one.Sample(0);
  other.Sample(0);
  EXPECT_EQ(one.RestLengths(), other.RestLengths());
}

}  // namespace
}  // namespace taut::plant
