// Oscillators with feedback, and the networks that compute it, against closed forms
#include "taut/control/feedback_cpg.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "simd/wide.h"
#include "taut/control/network.h"
#include "tests/constants.h"

namespace taut::control {
namespace {

template <class Real = double>
struct Oscillators {
  std::vector<FeedbackCpgLaw<Real>> laws;
  std::vector<CpgCoupling<Real>> couplings;
  std::vector<FeedbackCpgState<Real>> states;
  std::vector<CpgFeedback<Real>> feedback;
  std::vector<FeedbackCpgWork<Real>> work;

  Oscillators(std::size_t count, FeedbackCpgLaw<Real> law, Real frequency_hz)
      : laws(count, law),
        states(count, StartFeedbackCpg<Real>(Literal<Real>(0.0f), frequency_hz)),
        feedback(count, {Literal<Real>(0.0f), Literal<Real>(0.0f), Literal<Real>(0.0f)}),
        work(count) {}

  void Couple(int to, int from, Real weight_per_m, Real phase_turns) {
    couplings.push_back(MakeCoupling(static_cast<std::uint16_t>(to),
                                     static_cast<std::uint16_t>(from), weight_per_m, phase_turns));
  }
  void Step(Real step_s, int count) {
    StepFeedbackCpg<Real>({laws.data(), laws.size(), couplings.data(), couplings.size()},
                          feedback.data(), step_s, static_cast<std::uint16_t>(count), states.data(),
                          work.data());
  }
};

// G.17 with c = 1 + k_a f_a: rho^2 = c / (1 + (c / rho_0^2 - 1) exp(-2 a c t))
TEST(FeedbackCpg, TheAmplitudeFollowsItsFeedback) {
  const double a = 3.0;
  for (const double says : {0.7, -0.4, -1.0}) {
    Oscillators<> one(1, {0.05, a, 0.0, 1.5, 0.0}, 0.0);
    one.feedback[0].amplitude = says;
    const double c = 1.0 + 1.5 * says;
    for (int tick = 1; tick <= 200; ++tick) {
      one.Step(0.001, 10);
      const double square = c / (1.0 + (c - 1.0) * std::exp(-2.0 * a * c * tick * 0.01));
      ASSERT_NEAR(one.states[0].relative, std::sqrt(square), 1e-10) << says << " " << tick;
      ASSERT_NEAR(FeedbackCpgSignal(one.laws[0], one.states[0]), 0.05 * std::sqrt(square), 1e-11);
    }
  }
}

TEST(FeedbackCpg, PhaseFeedbackHastensAnOscillator) {
  Oscillators<> one(1, {0.1, 5.0, 0.0, 0.0, 0.4}, 0.5);
  one.feedback[0].phase = -0.25;  // 0.4 turns per second
  one.Step(0.001, 3000);
  EXPECT_NEAR(one.states[0].phase_turns, 0.2, 1e-12);  // 1.2 turns
}

// From G.15 and G.16 without coupling, pi v^2 + k_f f_f cos theta is invariant.
TEST(FeedbackCpg, FrequencyFeedbackKeepsAnInvariant) {
  Oscillators<> one(1, {0.1, 5.0, 2.0, 0.0, 0.0}, 0.8);
  one.feedback[0].frequency = 0.5;
  const auto invariant = [&] {
    const FeedbackCpgState<double>& s = one.states[0];
    return std::numbers::pi * s.frequency_hz * s.frequency_hz +
           2.0 * 0.5 * std::cos(kTwoPi * s.phase_turns);
  };
  const double before = invariant();
  double most = 0.8, least = 0.8;
  for (int tick = 0; tick < 500; ++tick) {
    one.Step(0.001, 10);
    ASSERT_NEAR(invariant(), before, 1e-9);
    most = std::max(most, one.states[0].frequency_hz);
    least = std::min(least, one.states[0].frequency_hz);
  }
  // v^2 is 0.64 at theta = 0, and larger by 2 k_f f_f / pi at half a turn.
  EXPECT_NEAR(most, std::sqrt(0.64 + 2.0 / std::numbers::pi), 1e-3);
  EXPECT_NEAR(least, 0.8, 1e-9);
}

// Two mutually coupled oscillators: d = theta_2 - theta_1 obeys d' = k (f_2 - f_1) + 2 c sin(phi -
// d), with c = w r, so that phase feedback shifts the locked phase from phi by asin(k (f_2 - f_1) /
// 2 c).
TEST(FeedbackCpg, PhaseFeedbackShiftsWhatCouplingsHold) {
  const double w = 6.0, R = 0.5, k_turns = 0.3;
  Oscillators<> two(2, {R, 5.0, 0.0, 0.0, k_turns}, 1.0);
  two.Couple(0, 1, w, 0.2);
  two.Couple(1, 0, w, -0.2);
  two.feedback[0].phase = -1.0;
  two.feedback[1].phase = 1.0;
  two.Step(0.001, 10000);
  const double d = WrapTurns(two.states[1].phase_turns - two.states[0].phase_turns) * kTwoPi;
  EXPECT_NEAR(d, kTwoPi * 0.2 + std::asin(2.0 * k_turns * kTwoPi / (2.0 * w * R)), 1e-9);
}

TEST(FeedbackCpg, WithoutFeedbackItTurnsLikeTheOtherOscillators) {
  Oscillators<> ours(3, {0.2, 4.0, 1.0, 1.0, 1.0}, 0.7);
  std::vector<CpgLaw<double>> laws(3, {0.7, 0.2, 4.0});
  std::vector<CpgState<double>> states(3, {0.0, 0.2, 0.0});
  std::vector<CpgWork<double>> work(3);
  for (const auto& [to, from, phase] : {std::tuple{0, 1, 0.1}, {1, 2, -0.3}, {2, 0, 0.25}}) {
    ours.Couple(to, from, 8.0, phase);
  }
  ours.Step(0.002, 700);
  StepCpg<double>({laws.data(), 3, ours.couplings.data(), 3}, nullptr, 0.002, 700, states.data(),
                  work.data());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(ours.states[i].phase_turns, states[i].phase_turns, 1e-13) << i;
    EXPECT_DOUBLE_EQ(ours.states[i].relative, 1.0);
  }
}

TEST(FeedbackCpg, HalvingTheStepDividesTheErrorBySixteen) {
  const auto at = [](double h) {
    Oscillators<> two(2, {0.3, 6.0, 1.5, 0.8, 0.2}, 1.0);
    two.Couple(0, 1, 10.0, 0.1);
    two.feedback[0] = {0.5, 0.5, -1.0};
    two.Step(h, static_cast<int>(std::lround(0.8 / h)));
    return two.states[0];
  };
  const FeedbackCpgState<double> fine = at(0.0005), half = at(0.01), whole = at(0.02);
  EXPECT_NEAR((whole.phase_turns - fine.phase_turns) / (half.phase_turns - fine.phase_turns), 16.0,
              1.5);
  EXPECT_NEAR((whole.frequency_hz - fine.frequency_hz) / (half.frequency_hz - fine.frequency_hz),
              16.0, 1.5);
}

TEST(FeedbackCpg, ALaneIsItsNetworkAlone) {
  using Lanes = simd::Wide<4>;
  const auto row = [](double a, double b, double c, double d) {
    Lanes x{};
    x.Set(0, a), x.Set(1, b), x.Set(2, c), x.Set(3, d);
    return x;
  };
  const Lanes R = row(0.1, 0.2, 0.05, 0.3), w = row(5, -9, 20, 3);
  const Lanes says = row(0.3, -0.9, 1, 0);
  Oscillators<Lanes> side_by_side(
      2, {R, Lanes::Splat(5), Lanes::Splat(1), Lanes::Splat(0.5), Lanes::Splat(0.3)},
      Lanes::Splat(0.9));
  side_by_side.Couple(0, 1, w, Lanes::Splat(0.15));
  side_by_side.feedback[0] = {says, says, says};
  side_by_side.Step(Lanes::Splat(0.002), 500);
  for (int lane = 0; lane < 4; ++lane) {
    Oscillators<> alone(2, {R[lane], 5, 1, 0.5, 0.3}, 0.9);
    alone.Couple(0, 1, w[lane], 0.15);
    alone.feedback[0] = {says[lane], says[lane], says[lane]};
    alone.Step(0.002, 500);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(side_by_side.states[i].phase_turns[lane], alone.states[i].phase_turns);
      EXPECT_EQ(side_by_side.states[i].relative[lane], alone.states[i].relative);
      EXPECT_EQ(side_by_side.states[i].frequency_hz[lane], alone.states[i].frequency_hz);
    }
  }
}

TEST(FeedbackCpg, TheBitsAreTheSameEverywhere) {
  Oscillators<> two(2, {0.1, 5.0, 1.0, 0.5, 0.3}, 0.9);
  two.Couple(0, 1, 5.0, 0.15);
  two.Couple(1, 0, 7.0, 0.05);
  two.feedback[0] = {0.3, Sigmoid(0.7), Sigmoid(-1.3)};
  two.Step(0.002, 500);
  std::uint64_t bits = 0;
  for (const FeedbackCpgState<double>& state : two.states) {
    for (const double x : {state.phase_turns, state.relative, state.frequency_hz}) {
      bits = bits * 31 + std::bit_cast<std::uint64_t>(x);
    }
  }
  EXPECT_EQ(bits, 17595375919693728587u);
}

TEST(Network, TheSigmoidIsThatOfTheExponential) {
  for (double x = -60; x <= 60; x += 0.0137) {
    const double exact = 1.0 / (1.0 + std::exp(-x));
    ASSERT_NEAR(Sigmoid(x), exact, 1e-14) << x;
    ASSERT_NEAR(Sigmoid(static_cast<float>(x)), exact, 1e-5) << x;
    ASSERT_DOUBLE_EQ(Sigmoid(x) + Sigmoid(-x), 1.0) << x;
  }
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(Sigmoid(0.0), 0.5);
  EXPECT_EQ(Sigmoid(inf), 1.0);
  EXPECT_LT(Sigmoid(-inf), 1e-17);
  EXPECT_TRUE(std::isnan(Sigmoid(std::numeric_limits<double>::quiet_NaN())));
}

std::vector<double> Said(const NetworkShape& shape, const std::vector<double>& weights,
                         const std::vector<double>& inputs) {
  std::vector<double> hidden(static_cast<std::size_t>(shape.hidden)),
      out(static_cast<std::size_t>(shape.outputs));
  EvaluateNetwork<double>(
      shape, [&](int n) { return weights.at(static_cast<std::size_t>(n)); },
      [&](int i) { return inputs.at(static_cast<std::size_t>(i)); }, hidden.data(),
      [&](int k, double y) { out.at(static_cast<std::size_t>(k)) = y; });
  return out;
}

// 2 sigma(x) - 1 is tanh(x / 2): the network computed independently, with matrices and library
// functions.
TEST(Network, ItIsTwoMatricesAndTwoSigmoids) {
  const NetworkShape shape{3, 4, 2};
  ASSERT_EQ(WeightCount(shape), 26);
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0.0, 2.0);
  for (int trial = 0; trial < 50; ++trial) {
    double W[4][3], b[4], U[2][4], c[2];
    std::vector<double> weights, x(3);
    for (double& value : x) value = normal(random);
    for (int j = 0; j < 4; ++j) {
      for (double& value : W[j]) weights.push_back(value = normal(random));
      weights.push_back(b[j] = normal(random));
    }
    for (int k = 0; k < 2; ++k) {
      for (double& value : U[k]) weights.push_back(value = normal(random));
      weights.push_back(c[k] = normal(random));
    }
    const std::vector<double> y = Said(shape, weights, x);
    for (int k = 0; k < 2; ++k) {
      double sum = c[k];
      for (int j = 0; j < 4; ++j) {
        const double z = W[j][0] * x[0] + W[j][1] * x[1] + W[j][2] * x[2] + b[j];
        sum += U[k][j] * (1.0 + std::tanh(z / 2.0)) / 2.0;
      }
      EXPECT_NEAR(y[static_cast<std::size_t>(k)], std::tanh(sum / 2.0), 1e-12);
    }
  }
}

TEST(Network, WithoutWeightsItSaysNothing) {
  EXPECT_EQ(Said({2, 3, 2}, std::vector<double>(17), {0.3, -0.8}), (std::vector<double>{0, 0}));
}

}  // namespace
}  // namespace taut::control
