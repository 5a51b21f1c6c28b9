// SIMD numbers: each lane equals the scalar operation, to the bit, also for NaN, signed zeros and
// infinities. Two lanes use the processor's registers. Four lanes, compiled without flags for wider
// registers, use the compiler's vectors, as on processors without a separate source file.
#include "simd/wide.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

namespace taut::test {
namespace {

using Limits = std::numeric_limits<double>;
const std::vector<double> kNumbers = {0.0,
                                      -0.0,
                                      1.0,
                                      -1.0,
                                      1.5,
                                      -2.25,
                                      1e-310,
                                      -1e-310,
                                      Limits::min(),
                                      Limits::max(),
                                      Limits::infinity(),
                                      -Limits::infinity(),
                                      Limits::quiet_NaN(),
                                      -Limits::quiet_NaN(),
                                      3.0};

std::uint64_t Bits(double x) { return std::bit_cast<std::uint64_t>(x); }

/// Compares f(a, b) for all pairs of numbers, with other pairs in the other lanes.
template <int N, class F>
void ExpectEachLaneAsAlone(const char* what, F f) {
  using W = simd::Wide<N>;
  using One = simd::Wide<1>;
  const std::size_t count = kNumbers.size();
  for (std::size_t first = 0; first < count * count; ++first) {
    W a = W::Splat(0.0), b = W::Splat(0.0);
    const auto pair = [&](int lane) {
      return (first + 7 * static_cast<std::size_t>(lane)) % (count * count);
    };
    for (int i = 0; i < N; ++i) {
      a.Set(i, kNumbers[pair(i) / count]);
      b.Set(i, kNumbers[pair(i) % count]);
    }
    const W got = f(a, b);
    for (int i = 0; i < N; ++i) {
      const One alone = f(One::Splat(a[i]), One::Splat(b[i]));
      ASSERT_EQ(Bits(got[i]), Bits(alone.v))
          << what << " of " << a[i] << " and " << b[i] << " in lane " << i << " of " << N << ": "
          << got[i] << ", not " << alone.v;
    }
  }
}

template <int N>
void ExpectLanesAsOne() {
  ExpectEachLaneAsAlone<N>("the greater", [](auto a, auto b) { return Max(a, b); });
  ExpectEachLaneAsAlone<N>("the smaller", [](auto a, auto b) { return Min(a, b); });
  ExpectEachLaneAsAlone<N>("the size", [](auto a, auto) { return Abs(a); });
  ExpectEachLaneAsAlone<N>("the root", [](auto a, auto) { return Sqrt(a); });
  ExpectEachLaneAsAlone<N>("the opposite", [](auto a, auto) { return -a; });
  ExpectEachLaneAsAlone<N>("less", [](auto a, auto b) { return Select(a < b, a, b); });
  ExpectEachLaneAsAlone<N>("not greater", [](auto a, auto b) { return Select(!(a > b), a, b); });
  ExpectEachLaneAsAlone<N>("equal", [](auto a, auto b) { return Select(a == b, a, b); });
  ExpectEachLaneAsAlone<N>("both", [](auto a, auto b) { return Select((a < b) & (b > -a), a, b); });
  ExpectEachLaneAsAlone<N>("either",
                           [](auto a, auto b) { return Select((a < b) | (b == -a), a, b); });
}

TEST(Wide, TwoLanesDoAsOne) { ExpectLanesAsOne<2>(); }
TEST(Wide, LanesOfTheCompilersOwnVectorsDoAsOne) { ExpectLanesAsOne<4>(); }

TEST(Wide, TheGreaterAndTheSmallerAreTheSecondWhereNeitherIs) {
  using W = simd::Wide<2>;
  const W nan = W::Splat(Limits::quiet_NaN()), one = W::Splat(1.0);
  const W plus = W::Splat(0.0), minus = W::Splat(-0.0);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(Max(nan, one)[i], 1.0);
    EXPECT_EQ(Min(nan, one)[i], 1.0);
    EXPECT_NE(Max(one, nan)[i], Max(one, nan)[i]);
    EXPECT_NE(Min(one, nan)[i], Min(one, nan)[i]);
    EXPECT_EQ(Bits(Max(plus, minus)[i]), Bits(-0.0));
    EXPECT_EQ(Bits(Min(minus, plus)[i]), Bits(0.0));
  }
}

template <int N>
void ExpectAnySeesEveryLane() {
  EXPECT_FALSE(Any(simd::Mask<N>::Splat(false)));
  EXPECT_TRUE(Any(simd::Mask<N>::Splat(true)));
  for (int i = 0; i < N; ++i) {
    auto mask = simd::Mask<N>::Splat(false);
    mask.Set(i, true);
    EXPECT_TRUE(Any(mask)) << "lane " << i << " of " << N;
    mask = simd::Mask<N>::Splat(true);
    mask.Set(i, false);
    EXPECT_TRUE(Any(mask)) << "all but lane " << i << " of " << N;
  }
}

TEST(Wide, AnySeesEveryLane) {
  ExpectAnySeesEveryLane<2>();
  ExpectAnySeesEveryLane<4>();
}

}  // namespace
}  // namespace taut::test
