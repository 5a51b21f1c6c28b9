// Random numbers, with expectations from the generator's authors and from closed forms of the
// distributions
#include "math/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace taut::math {
namespace {

// kat_vectors of Random123 1.14.0, the reference implementation of the paper
TEST(Random, PhiloxGivesItsAuthorsKnownAnswers) {
  using Counter = std::array<std::uint32_t, 4>;
  EXPECT_EQ(Philox({0, 0, 0, 0}, {0, 0}),
            (Counter{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  constexpr std::uint32_t f = 0xffffffff;
  EXPECT_EQ(Philox({f, f, f, f}, {f, f}),
            (Counter{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(Philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Counter{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Random, ANumberDependsOnSeedStreamAndIndexAlone) {
  const auto first = [](std::uint64_t seed, std::uint32_t stream, std::uint64_t index) {
    return Random(seed, stream, index).Bits();
  };
  EXPECT_EQ(first(1, 2, 3), first(1, 2, 3));
  EXPECT_NE(first(1, 2, 3), first(4, 2, 3));
  EXPECT_NE(first(1, 2, 3), first(1, 4, 3));
  EXPECT_NE(first(1, 2, 3), first(1, 2, 4));
  EXPECT_NE(first(1, 2, 3), first(1 + (1ull << 32), 2, 3));
  EXPECT_NE(first(1, 2, 3), first(1, 2, 3 + (1ull << 32)));
}

TEST(Random, UniformNumbersStayWithinTheirBounds) {
  Random random(7, 0, 0);
  double least = 1, most = 0;
  for (int i = 0; i < 100000; ++i) {
    const double x = random.Uniform();
    least = std::min(least, x);
    most = std::max(most, x);
    const double y = random.Uniform(-2.0, 3.0);
    ASSERT_GE(y, -2.0);
    ASSERT_LE(y, 3.0);
  }
  EXPECT_GE(least, 0.0);
  EXPECT_LT(least, 1e-4);
  EXPECT_LT(most, 1.0);
  EXPECT_GT(most, 1.0 - 1e-4);
}

// With n = 10^6 samples the k-th moment's standard error is sqrt(var / n); five of them.
TEST(Random, NormalNumbersHaveTheMomentsOfANormalDistribution) {
  const int n = 1'000'000;
  Random random(11, 5, 0);
  double m1 = 0, m2 = 0, m3 = 0, m4 = 0;
  for (int i = 0; i < n; ++i) {
    const double x = random.Normal();
    m1 += x;
    m2 += x * x;
    m3 += x * x * x;
    m4 += x * x * x * x;
  }
  const double error = 5.0 / std::sqrt(n);
  EXPECT_NEAR(m1 / n, 0.0, error);
  EXPECT_NEAR(m2 / n, 1.0, error * std::sqrt(2.0));
  EXPECT_NEAR(m3 / n, 0.0, error * std::sqrt(15.0));
  EXPECT_NEAR(m4 / n, 3.0, error * std::sqrt(96.0));
}

// Kolmogorov's distance to the normal distribution; 1.95 / sqrt(n) is exceeded once in a thousand.
TEST(Random, NormalNumbersFollowTheNormalDistributionUpToTheTail) {
  const int n = 1'000'000;
  Random random(13, 5, 0);
  std::vector<double> x(n);
  for (double& value : x) value = random.Normal();
  std::sort(x.begin(), x.end());
  double distance = 0;
  for (int i = 0; i < n; ++i) {
    const double exact = 0.5 * std::erfc(-x[static_cast<std::size_t>(i)] / std::sqrt(2.0));
    distance = std::max(
        {distance, std::fabs(exact - i / double{n}), std::fabs(exact - (i + 1) / double{n})});
  }
  EXPECT_LT(distance, 1.95 / std::sqrt(n));
  // beyond the last layer: 2 x 2.88e-4 of all, to five standard errors
  const double beyond = std::erfc(3.442619855899 / std::sqrt(2.0));
  const auto count = static_cast<double>(
      std::count_if(x.begin(), x.end(), [](double v) { return std::fabs(v) > 3.442619855899; }));
  EXPECT_NEAR(count / n, beyond, 5 * std::sqrt(beyond / n));
}

// Equal for all compilers, instruction sets and C libraries
TEST(Random, BitsAreTheSameEverywhere) {
  Random random(42, 1, 9);
  std::uint64_t hash = 0;
  for (int i = 0; i < 10000; ++i) {
    hash = hash * 6364136223846793005u + std::bit_cast<std::uint64_t>(random.Normal());
  }
  EXPECT_EQ(hash, 4417470335054789725u);
}

}  // namespace
}  // namespace taut::math
