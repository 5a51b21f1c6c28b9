// Laws in SIMD lanes give the same bits as in a single lane, for any contents of the other lanes.
#include <gtest/gtest.h>

#include <bit>

#include "tests/solver/law_instances.h"

namespace taut::test {
namespace {

constexpr int kMostLanes = 8;

struct Question {
  std::vector<double> numbers;  ///< Inputs of all lanes.
  int stride;
};

/// Returns contacts near solutions of their law, so that the lanes of a group are on all its
/// branches.
Question AboutContacts(std::uint64_t index) {
  Question q{{}, kContactNumbers + kQuestionNumbers<3>};
  for (int lane = 0; lane < kMostLanes; ++lane) {
    math::Random random(11, static_cast<std::uint32_t>(lane), index);
    const std::vector<double> contact = RandomContactNumbers(random, 1.5);
    q.numbers.insert(q.numbers.end(), contact.begin(), contact.end());
    const bool sticks = random.Uniform() < 0.5;  // near the bias, with little friction
    for (std::size_t r = 0; r < 3; ++r) {
      const double off = random.Uniform(-1, 1);
      q.numbers.push_back(-contact[2 + r] + (sticks ? 0.02 : 1) * off);
    }
    q.numbers.push_back(random.Uniform(-0.5, 1));
    for (int r = 1; r < 3; ++r) q.numbers.push_back((sticks ? 0.05 : 1) * random.Uniform(-1, 1));
    q.numbers.push_back(kSoftnesses[index % 3]);
    q.numbers.push_back(random.Uniform());
  }
  return q;
}
Question AboutCables(std::uint64_t index) {
  Question q{{}, kCableNumbers + kQuestionNumbers<1>};
  for (int lane = 0; lane < kMostLanes; ++lane) {
    math::Random random(12, static_cast<std::uint32_t>(lane), index);
    const std::vector<double> cable = RandomCableNumbers(random);
    q.numbers.insert(q.numbers.end(), cable.begin(), cable.end());
    const double u = random.Uniform(-2, 2), center = random.Uniform(-0.5, 2);
    q.numbers.insert(q.numbers.end(), {u, center, kSoftnesses[index % 3], random.Uniform()});
  }
  return q;
}

/// Compares the results of `lanes` lanes, evaluated together, with the results of single lanes.
template <int R, class Together, class Alone>
void ExpectSameBits(const Question& q, int lanes, const Together& together, const Alone& alone) {
  std::vector<double> mine(At(lanes * kAnswerNumbers<R>)), wanted = mine;
  for (int first = 0; first < kMostLanes; first += lanes) {
    const double* const in = q.numbers.data() + first * q.stride;
    together(in, mine.data());
    for (int i = 0; i < lanes; ++i) {
      alone(in + i * q.stride, wanted.data() + i * kAnswerNumbers<R>);
    }
    for (std::size_t k = 0; k < mine.size(); ++k) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(mine[k]), std::bit_cast<std::uint64_t>(wanted[k]))
          << "answer " << k % At(kAnswerNumbers<R>) << ": " << mine[k] << ", not " << wanted[k];
    }
  }
}

void ExpectContactsSame(int lanes, AskContactsFunction* together) {
  for (std::uint64_t i = 0; i < 1000; ++i) {
    for (const bool one_direction : {false, true}) {
      ExpectSameBits<3>(
          AboutContacts(i), lanes,
          [&](const double* in, double* out) { together(in, out, one_direction); },
          [&](const double* in, double* out) { AskContacts<Num>(in, out, one_direction); });
      if (testing::Test::HasFatalFailure()) return;
    }
  }
}
void ExpectCablesSame(int lanes, AskCablesFunction* together) {
  for (std::uint64_t i = 0; i < 1000; ++i) {
    ExpectSameBits<1>(AboutCables(i), lanes, together, AskCables<Num>);
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(LawLanes, TwoLanesGiveTheBitsOfOne) {
  ExpectContactsSame(2, AskContacts<simd::Wide<2>>);
  ExpectCablesSame(2, AskCables<simd::Wide<2>>);
}
#ifdef TAUT_HAS_AVX2
TEST(LawLanes, FourLanesGiveTheBitsOfOne) {
  if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "this machine has no AVX2";
  ExpectContactsSame(4, kAskFourContacts);
  ExpectCablesSame(4, kAskFourCables);
}
#endif
#ifdef TAUT_HAS_AVX512
TEST(LawLanes, EightLanesGiveTheBitsOfOne) {
  if (!__builtin_cpu_supports("avx512f") || !__builtin_cpu_supports("avx512dq") ||
      !__builtin_cpu_supports("avx512vl")) {
    GTEST_SKIP() << "this machine has no AVX-512";
  }
  ExpectContactsSame(8, kAskEightContacts);
  ExpectCablesSame(8, kAskEightCables);
}
#endif

}  // namespace
}  // namespace taut::test
