// CPG oscillators against closed forms
#include "taut/control/cpg.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "simd/wide.h"
#include "tests/constants.h"

namespace taut::control {
namespace {

template <class Real = double>
struct Network {
  std::vector<CpgLaw<Real>> laws;
  std::vector<CpgCoupling<Real>> couplings;
  std::vector<CpgState<Real>> states;
  std::vector<Real> feedback;
  std::vector<CpgWork<Real>> work;

  explicit Network(std::size_t count, CpgLaw<Real> law)
      : laws(count, law), states(count, StartCpg<Real>()), work(count) {}

  /// Starts with the amplitudes at R, so that closed forms hold from the start.
  void StartAtFullAmplitude() {
    for (std::size_t i = 0; i < laws.size(); ++i) {
      states[i].amplitude_m_per_s = laws[i].amplitude_m_per_s;
    }
  }
  void Couple(int to, int from, Real weight_per_m, Real phase_turns) {
    couplings.push_back(MakeCoupling(static_cast<std::uint16_t>(to),
                                     static_cast<std::uint16_t>(from), weight_per_m, phase_turns));
  }
  void Step(Real step_s, int count) {
    const CpgNetwork<Real> network{laws.data(), laws.size(), couplings.data(), couplings.size()};
    StepCpg(network, feedback.empty() ? nullptr : feedback.data(), step_s,
            static_cast<std::uint16_t>(count), states.data(), work.data());
  }
  /// Returns theta_j - theta_i, within -1/2..1/2.
  Real Difference(std::size_t i, std::size_t j) const {
    return WrapTurns(states[j].phase_turns - states[i].phase_turns);
  }
};

/// Returns r(t) of eq. G.4 from rest at 0.
double CriticallyDamped(double R, double a, double t) {
  return R * (1.0 - (1.0 + a * t / 2.0) * std::exp(-a * t / 2.0));
}

TEST(Cpg, TheAmplitudeIsCriticallyDamped) {
  const double R = 0.5, a = 20.0, h = 0.001;
  Network<> one(1, {0.0, R, a});
  double before = 0.0;
  for (int ms = 1; ms <= 2000; ++ms) {
    one.Step(h, 1);
    const double r = one.states[0].amplitude_m_per_s, x = a / 2.0 * ms * h;
    // The method's error is -t h^4 / 120 times the fifth derivative, at most 4.8e-11 here; the next
    // order is a h / 2 = 1 % of that.
    const double error = R * std::pow(a * h / 2.0, 4) / 120.0 * x * (4.0 - x) * std::exp(-x);
    ASSERT_NEAR(r - CriticallyDamped(R, a, ms * h), error, 1e-12) << ms;
    ASSERT_GE(r, before - 1e-16);
    ASSERT_LT(r, R + 1e-15) << "overshoots at " << ms << " ms";
    before = r;
  }
  EXPECT_NEAR(before, R, 1e-7);
}

TEST(Cpg, AnOscillatorAloneKeepsItsFrequency) {
  Network<> one(1, {1.25, 0.1, 20.0});
  one.Step(0.001, 10000);  // 12.5 turns
  EXPECT_NEAR(std::fabs(one.states[0].phase_turns), 0.5, 1e-11);
  EXPECT_NEAR(CpgVelocity(one.states[0]), -0.1, 1e-12);
}

// With w r = c for both, d = theta_2 - theta_1 obeys d' = 2 c sin(phi - d), whose solution is
// tan((d - phi) / 2) = tan((d_0 - phi) / 2) exp(-2 c t).
TEST(Cpg, TwoOscillatorsLockToTheirPhase) {
  const double R = 0.5, w = 6.0, c = w * R, phi = kTwoPi * 0.2, d0 = 0.0;
  Network<> two(2, {1.0, R, 20.0});
  two.StartAtFullAmplitude();
  two.Couple(0, 1, w, 0.2);
  two.Couple(1, 0, w, -0.2);
  for (int tick = 1; tick <= 200; ++tick) {
    two.Step(0.001, 10);
    const double d =
        phi + 2.0 * std::atan(std::tan((d0 - phi) / 2.0) * std::exp(-2.0 * c * tick * 0.01));
    EXPECT_NEAR(two.Difference(0, 1) * kTwoPi, d, 1e-9) << tick;
  }
  EXPECT_NEAR(two.Difference(0, 1), 0.2, 1e-5);
}

// With different frequencies d' = 2 pi (v_2 - v_1) + 2 c sin(phi - d): locked, behind phi by asin(2
// pi (v_2 - v_1) / 2 c), if that angle exists; else the beat is sqrt((2 pi dv)^2 - (2 c)^2) / 2 pi
// (Adler).
TEST(Cpg, UnlikeOscillatorsLockBesideTheirPhaseOrBeat) {
  const double R = 0.5, w = 6.0, c = w * R, dv = 0.5;
  Network<> two(2, {1.0, R, 20.0});
  two.laws[1].frequency_hz = 1.0 + dv;
  two.StartAtFullAmplitude();
  two.Couple(0, 1, w, 0.0);
  two.Couple(1, 0, w, 0.0);
  two.Step(0.001, 10000);
  EXPECT_NEAR(two.Difference(0, 1) * kTwoPi, std::asin(kTwoPi * dv / (2.0 * c)), 1e-10);

  const double dv_beat = 2.0,
               beat_hz = std::sqrt(std::pow(kTwoPi * dv_beat, 2) - 4.0 * c * c) / kTwoPi;
  two.laws[1].frequency_hz = 1.0 + dv_beat;
  int slips = 0;
  double before = two.Difference(0, 1);
  for (int ms = 0; ms < 20000; ++ms) {
    two.Step(0.001, 1);
    const double now = two.Difference(0, 1);
    if (now < before - 0.5) ++slips;
    before = now;
  }
  EXPECT_NEAR(slips, 20.0 * beat_hz, 1.0);
}

TEST(Cpg, AChainCarriesATravellingWave) {
  constexpr int kCount = 10;
  constexpr double kPhase = 0.1;  // turns, from each oscillator to the next
  Network<> chain(kCount, {1.0, 0.5, 20.0});
  for (int i = 0; i + 1 < kCount; ++i) {
    chain.Couple(i, i + 1, 8.0, kPhase);
    chain.Couple(i + 1, i, 8.0, -kPhase);
  }
  for (int s = 0; s < 60; ++s) chain.Step(0.001, 1000);
  for (std::size_t i = 0; i + 1 < kCount; ++i)
    EXPECT_NEAR(chain.Difference(i, i + 1), kPhase, 1e-9);
  // it continues at the common frequency
  const double before = chain.states[0].phase_turns;
  chain.Step(0.001, 250);
  EXPECT_NEAR(WrapTurns(chain.states[0].phase_turns - before), 0.25, 1e-9);
}

Network<> Tangle() {
  Network<> tangle(6, {1.3, 0.5, 20.0});
  std::mt19937 bits(7);
  const auto uniform = [&] { return static_cast<double>(bits()) / 4294967296.0; };
  for (int i = 0; i < 6; ++i) {
    tangle.laws[static_cast<std::size_t>(i)].frequency_hz += uniform();
    for (int j = 0; j < 6; ++j) {
      const double weight = 8.0 * uniform(), phase = uniform() - 0.5;
      if (j != i) tangle.Couple(i, j, weight, phase);
    }
  }
  return tangle;
}

double After1s(double step_s) {
  Network<> tangle = Tangle();
  tangle.Step(step_s, static_cast<int>(std::lround(1.0 / step_s)));
  double sum = 0;
  for (const auto& state : tangle.states) sum += CpgVelocity(state);
  return sum;
}

TEST(Cpg, HalvingTheStepDividesTheErrorBySixteen) {
  const double exact = After1s(1.0 / 16384);
  const double coarse = std::fabs(After1s(1.0 / 256) - exact);
  const double fine = std::fabs(After1s(1.0 / 512) - exact);
  EXPECT_GT(coarse, 1e-9);  // otherwise rounding would be measured
  EXPECT_GT(std::log2(coarse / fine), 3.7);
  EXPECT_LT(std::log2(coarse / fine), 4.3);
}

// One short step gives the right-hand side: the rearranged sum (eq. G.6) equals the sum of eq. G.3.
TEST(Cpg, ThePhaseFollowsThePapersEquation) {
  Network<> tangle = Tangle();
  tangle.Step(1.0 / 1024, 512);
  const std::vector<CpgState<double>> start = tangle.states;
  const double h = 0x1p-30;
  tangle.Step(h, 1);
  for (std::size_t i = 0; i < 6; ++i) {
    double rate = kTwoPi * tangle.laws[i].frequency_hz;
    for (const auto& link : tangle.couplings) {
      if (link.to != i) continue;
      const double w = kTwoPi * std::hypot(link.along, link.across);
      const double phi = std::atan2(link.across, link.along);
      rate += w * start[link.from].amplitude_m_per_s *
              std::sin(kTwoPi * (start[link.from].phase_turns - start[i].phase_turns) - phi);
    }
    const double turned = WrapTurns(tangle.states[i].phase_turns - start[i].phase_turns);
    EXPECT_NEAR(turned / h * kTwoPi, rate, 1e-5);  // 2^-53 of a turn over h is 8e-7 rad/s
  }
}

// theta' = omega + s cos theta has the period 2 pi / sqrt(omega^2 - s^2) while |s| < omega.
TEST(Cpg, FeedbackSlowsAnOscillatorByTheClosedForm) {
  const double omega = kTwoPi * 1.0, s = 4.0;
  Network<> one(1, {1.0, 0.5, 20.0});
  one.feedback = {s};
  const double rounds_hz = std::sqrt(omega * omega - s * s) / kTwoPi;
  int rounds = 0;
  double before = 0.0, crossed_s = 0.0;
  for (int step = 1; step <= 20000; ++step) {
    one.Step(0.001, 1);
    const double now = one.states[0].phase_turns;
    if (before < 0.0 && now >= 0.0) {
      ++rounds;
      crossed_s = step * 0.001 - 0.001 * now / (now - before);
    }
    before = now;
  }
  EXPECT_NEAR(rounds / crossed_s, rounds_hz, 1e-5);
}

TEST(Cpg, StrongFeedbackStopsAnOscillatorWhereItBalances) {
  const double omega = kTwoPi * 1.0, s = 10.0;
  Network<> one(1, {1.0, 0.5, 20.0});
  one.feedback = {s};
  one.Step(0.001, 5000);
  // omega + s cos theta = 0, stable where -s sin theta < 0
  EXPECT_NEAR(one.states[0].phase_turns, std::acos(-omega / s) / kTwoPi, 1e-12);
}

TEST(Cpg, FeedbackReachesItsOwnOscillatorOnly) {
  Network<> two(2, {1.0, 0.5, 20.0}), alone(1, {1.0, 0.5, 20.0});
  two.feedback = {0.0, 3.0};
  two.Step(0.001, 700);
  alone.Step(0.001, 700);
  EXPECT_EQ(two.states[0].phase_turns, alone.states[0].phase_turns);
  EXPECT_NE(two.states[1].phase_turns, alone.states[0].phase_turns);
}

TEST(Cpg, NotANumberStaysSeen) {
  Network<> two(2, {1.0, 0.5, 20.0});
  two.Couple(0, 1, 8.0, 0.1);
  two.states[1].phase_turns = std::numeric_limits<double>::quiet_NaN();
  two.Step(0.001, 3);
  EXPECT_TRUE(std::isnan(CpgVelocity(two.states[0])));
}

template <class Real>
Network<Real> Ring(Real weight_per_m) {
  const auto real = [](float x) { return FromScalar<Real>(x); };
  Network<Real> ring(3, {real(1.5f), real(0.5f), real(20.0f)});
  for (int i = 0; i < 3; ++i) ring.Couple(i, (i + 1) % 3, weight_per_m, real(0.3125f));
  ring.Step(real(0.0009765625f), 1000);
  return ring;
}

TEST(Cpg, ALaneIsItsNetworkAlone) {
  using Lanes = simd::Wide<4>;
  Lanes weight = Lanes::Splat(0);
  for (int lane = 0; lane < 4; ++lane) weight.v[lane] = 2.0 + lane;
  const Network<Lanes> lanes = Ring(weight);
  for (int lane = 0; lane < 4; ++lane) {
    const Network<double> alone = Ring(2.0 + lane);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(lanes.states[i].phase_turns[lane], alone.states[i].phase_turns);
      EXPECT_EQ(lanes.states[i].amplitude_m_per_s[lane], alone.states[i].amplitude_m_per_s);
    }
  }
}

// Equal bits with every compiler and on every machine
TEST(Cpg, TheBitsAreTheSameEverywhere) {
  EXPECT_EQ(std::bit_cast<std::uint64_t>(CpgVelocity(Ring(4.0).states[2])), 4586283323206561158u);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(CpgVelocity(Ring(4.0f).states[2])), 1026425663u);
}

}  // namespace
}  // namespace taut::control
