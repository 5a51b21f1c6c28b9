// Elementary functions against an oracle: the C library's long double functions (64 bits of
// mantissa or more), which are accurate to about 0.001 units in the last place of a double.
#include "math/elementary.h"
#include "tests/constants.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

namespace taut::math {
namespace {

static_assert(std::numeric_limits<long double>::digits >= 64,
              "the oracle needs a wide long double");

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kBoundUlp = 0.502;  // 0.5001 of the functions, the rest of the oracle

/// Returns the distance of `got` from the exact value, in units of its last place.
double UlpsOff(double got, long double wanted) {
  const double rounded = std::fabs(static_cast<double>(wanted));
  const double ulp = std::max(std::nextafter(rounded, kInf) - rounded, 0x1p-1074);
  return static_cast<double>(std::fabs(static_cast<long double>(got) - wanted) / ulp);
}

using Ours = double (*)(double);
using Theirs = long double (*)(long double);

/// Returns the largest error over 20 000 arguments, with either sign and sizes spread evenly over
/// the exponents.
double WorstUlps(Ours ours, Theirs theirs, double smallest, double largest, bool negative = true) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> log_size(std::log2(smallest), std::log2(largest));
  double worst = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    double x = std::exp2(log_size(random));
    if (negative && i % 2 == 1) x = -x;
    worst = std::max(worst, UlpsOff(ours(x), theirs(x)));
  }
  return worst;
}

TEST(Elementary, SinCosAndTanAreCorrectlyRoundedUpTo1e9) {
  EXPECT_LE(WorstUlps(Sin, sinl, 1e-300, 1e9), kBoundUlp);
  EXPECT_LE(WorstUlps(Cos, cosl, 1e-300, 1e9), kBoundUlp);
  EXPECT_LE(WorstUlps(Tan, tanl, 1e-300, 1e9), kBoundUlp);
  EXPECT_LE(WorstUlps(Sin, sinl, 0.1, 10), kBoundUlp);
  EXPECT_LE(WorstUlps(Cos, cosl, 0.1, 10), kBoundUlp);
  EXPECT_LE(WorstUlps(Tan, tanl, 0.1, 10), kBoundUlp);
}

// Cancellation: sin(fl(k pi / 2)) needs every bit of the argument reduction.
TEST(Elementary, SinAndCosKeepTheirDigitsNextToMultiplesOfHalfPi) {
  for (int k = 1; k < 5000; ++k) {
    const double x = k * (std::numbers::pi / 2);
    EXPECT_LE(UlpsOff(Sin(x), sinl(x)), kBoundUlp) << k;
    EXPECT_LE(UlpsOff(Cos(x), cosl(x)), kBoundUlp) << k;
  }
}

TEST(Elementary, AsinAcosAndAtanAreCorrectlyRounded) {
  EXPECT_LE(WorstUlps(Asin, asinl, 1e-300, 1), kBoundUlp);
  EXPECT_LE(WorstUlps(Acos, acosl, 1e-300, 1), kBoundUlp);
  EXPECT_LE(WorstUlps(Asin, asinl, 0.01, 1), kBoundUlp);
  EXPECT_LE(WorstUlps(Acos, acosl, 0.01, 1), kBoundUlp);
  EXPECT_LE(WorstUlps(Atan, atanl, 1e-300, 1e300), kBoundUlp);
  EXPECT_LE(WorstUlps(Atan, atanl, 0.01, 100), kBoundUlp);
}

TEST(Elementary, AcosKeepsItsDigitsNextToOne) {
  for (int i = 1; i < 1000; ++i) {
    const double x = 1.0 - i * 0x1p-53;
    EXPECT_LE(UlpsOff(Acos(x), acosl(x)), kBoundUlp) << i;
    EXPECT_LE(UlpsOff(Asin(-x), asinl(-x)), kBoundUlp) << i;
  }
}

TEST(Elementary, Atan2IsCorrectlyRoundedInEveryQuadrantAndScale) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> exponent(-300, 300), close(-3, 3);
  for (int i = 0; i < 20'000; ++i) {
    const double base = exponent(random),
                 other = i % 3 == 0 ? exponent(random) : base + close(random);
    const double y = (i & 1 ? -1 : 1) * std::pow(10.0, base),
                 x = (i & 2 ? -1 : 1) * std::pow(10.0, other);
    if (std::fabs(y / x) < 0x1p-1000) continue;  // subnormal results have a separate bound
    EXPECT_LE(UlpsOff(Atan2(y, x), atan2l(y, x)), kBoundUlp) << y << " " << x;
  }
}

TEST(Elementary, ExpAndLogAreCorrectlyRounded) {
  EXPECT_LE(WorstUlps(Exp, expl, 1e-300, 708), kBoundUlp);
  EXPECT_LE(WorstUlps(Exp, expl, 0.01, 708), kBoundUlp);
  EXPECT_LE(WorstUlps(Log, logl, 1e-320, 1.7e308, false), kBoundUlp);
  EXPECT_LE(WorstUlps(Log, logl, 0.5, 2, false), kBoundUlp);
  for (int i = -1000; i < 1000; ++i) {
    const double x = 1.0 + i * 0x1p-52;
    EXPECT_LE(UlpsOff(Log(x), logl(x)), kBoundUlp) << i;
  }
}

TEST(Elementary, ASubnormalExpIsWithinOneUnitInTheLastPlace) {
  for (double x = -745.0; x < -708.0; x += 0.0371) EXPECT_LE(UlpsOff(Exp(x), expl(x)), 1.0) << x;
}

TEST(Elementary, PowIsCorrectlyRounded) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> log2_base(-60, 60), exponent(-11, 11);
  for (int i = 0; i < 20'000; ++i) {
    const double base = std::exp2(log2_base(random)), power = exponent(random);
    // The oracle's error grows with the logarithm of the result.
    EXPECT_LE(UlpsOff(Pow(base, power), powl(base, power)), 0.51) << base << " ^ " << power;
  }
}

TEST(Elementary, ExactResultsAreExact) {
  for (int i = -60; i <= 60; ++i) EXPECT_EQ(Pow(2.0, i), std::ldexp(1.0, i));
  EXPECT_EQ(Pow(10.0, 15.0), 1e15);
  EXPECT_EQ(Pow(3.0, 20.0), 3486784401.0);
  EXPECT_EQ(Pow(-3.0, 3.0), -27.0);
  EXPECT_EQ(Pow(-2.0, 4.0), 16.0);
  EXPECT_EQ(Pow(0.25, 0.5), 0.5);
  EXPECT_EQ(Exp(0.0), 1.0);
  EXPECT_EQ(Log(1.0), 0.0);
  EXPECT_EQ(Cos(0.0), 1.0);
  EXPECT_EQ(Sin(std::numbers::pi / 6), 0.49999999999999994);  // its argument is the double below pi
                                                              // / 6
  EXPECT_EQ(Acos(1.0), 0.0);
  EXPECT_EQ(Acos(-1.0), std::numbers::pi);
  EXPECT_EQ(Asin(1.0), std::numbers::pi / 2);
}

TEST(Elementary, SpecialCasesFollowC) {
  for (const Ours f : {Sin, Cos, Tan, Asin, Acos, Atan, Exp, Log}) EXPECT_TRUE(std::isnan(f(kNan)));
  EXPECT_TRUE(std::isnan(Sin(kInf)));
  EXPECT_TRUE(std::isnan(Sin(1.1e9)));
  EXPECT_TRUE(std::isnan(Asin(1.0000001)));
  EXPECT_TRUE(std::isnan(Log(-1.0)));
  EXPECT_TRUE(std::isnan(Pow(-2.0, 0.5)));
  EXPECT_EQ(Log(0.0), -kInf);
  EXPECT_EQ(Exp(kInf), kInf);
  EXPECT_EQ(Exp(-kInf), 0.0);
  EXPECT_EQ(Exp(710.0), kInf);
  EXPECT_EQ(Exp(-746.0), 0.0);
  for (const double y : {-kInf, -2.0, -0.0, 0.0, 2.0, kInf}) {
    for (const double x : {-kInf, -2.0, -0.0, 0.0, 2.0, kInf}) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(Atan2(y, x)),
                std::bit_cast<std::uint64_t>(std::atan2(y, x)))
          << y << " " << x;
      EXPECT_EQ(std::bit_cast<std::uint64_t>(Pow(x, y)),
                std::bit_cast<std::uint64_t>(std::pow(x, y)))
          << x << " ^ " << y;
    }
  }
}

// The values are mpmath's, rounded to double. A compiler that contracts or reorders breaks the
// double-double arithmetic; every machine must give these bits.
TEST(Elementary, TheBitsAreThese) {
  EXPECT_EQ(Sin(1.0), 0x1.aed548f090ceep-1);
  EXPECT_EQ(Cos(1e6), 0x1.df9df9906d32cp-1);
  EXPECT_EQ(Tan(1.5), 0x1.c33ed50b88777p+3);
  EXPECT_EQ(Exp(1.0), 0x1.5bf0a8b145769p+1);
  EXPECT_EQ(Log(10.0), 0x1.26bb1bbb55516p+1);
  EXPECT_EQ(Pow(2.0, 0.5), 0x1.6a09e667f3bcdp+0);
  EXPECT_EQ(Atan2(1.0, -3.0), 0x1.68f095fdf593cp+1);
}

}  // namespace
}  // namespace taut::math
