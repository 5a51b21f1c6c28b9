// Random inputs of fuzz targets: reproducibility, and detection of every failing input.
#include "fuzz/random_inputs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <set>

#include "fuzz/fuzz_folder.h"

namespace taut::fuzz {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::uint64_t kSeed = 7;

bool IsInput(const std::uint8_t* data, std::size_t size, std::uint64_t index) {
  return Bytes(data, data + size) == RandomInput(kSeed, index);
}
int Good(const std::uint8_t*, std::size_t) { return 0; }
int AbortsAtThree(const std::uint8_t* data, std::size_t size) {
  Must(!IsInput(data, size, 3), "it is input 3");
  return 0;
}
int CrashesAtTwo(const std::uint8_t* data, std::size_t size) {
  if (IsInput(data, size, 2)) std::raise(SIGSEGV);
  return 0;
}
int ThrowsAtOne(const std::uint8_t* data, std::size_t size) {
  if (IsInput(data, size, 1)) throw 1;
  return 0;
}
int HangsAtOne(const std::uint8_t* data, std::size_t size) {
  volatile bool hangs = IsInput(data, size, 1);
  while (hangs) continue;
  return 0;
}
int IsInterruptedAtFour(const std::uint8_t* data, std::size_t size) {
  if (IsInput(data, size, 4)) std::raise(SIGINT);
  return 0;
}

Campaign Of(long count) {
  Campaign campaign;
  campaign.seed = kSeed;
  campaign.count = count;
  campaign.shows_progress = false;
  return campaign;
}

TEST(RandomInputs, DifferInAllAndAreTheSameAgain) {
  std::set<std::string> all;
  std::set<std::size_t> lengths;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    for (std::uint64_t i = 0; i < 1000; ++i) {
      const Bytes input = RandomInput(seed, i);
      EXPECT_EQ(input, RandomInput(seed, i));
      all.insert({input.begin(), input.end()});
      lengths.insert(input.size());
    }
  }
  EXPECT_GE(all.size(), 1990u);  // only 256 inputs of one byte exist
  EXPECT_EQ(*lengths.begin(), 1u);
  EXPECT_EQ(*lengths.rbegin(), 256u);
}

TEST(RandomInputs, AreMutationsOfGivenOnes) {
  const Bytes base(40, 'a');
  std::set<Bytes> all;
  std::set<std::size_t> lengths;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const Bytes input = MutatedInput(kSeed, i, {base, {}}, MutateBytes);
    EXPECT_EQ(input, MutatedInput(kSeed, i, {base, {}}, MutateBytes));
    if (input.size() > 8) {  // of the long base
      EXPECT_GE(std::count(input.begin(), input.end(), 'a'), static_cast<long>(input.size() / 2));
      all.insert(input);
    }
    lengths.insert(input.size());
  }
  EXPECT_GE(all.size(), 300u);  // half of the bases are empty; some copies change nothing
  EXPECT_LT(*lengths.begin(), 5u);
  EXPECT_GT(*lengths.rbegin(), 42u);
}

TEST(RandomInputs, AreMutatedWithinTheirSpace) {
  for (unsigned seed = 0; seed < 10'000; ++seed) {
    Bytes data(8, 1);
    data.push_back(7);  // behind the space
    const std::size_t size = MutateBytes(data.data(), seed % 9, 8, seed);
    EXPECT_LE(size, 8u);
    EXPECT_EQ(data[8], 7);
  }
}

TEST(RandomInputs, AreCounted) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(TryRandomInputs(Of(10), Good), 0);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "stat::number_of_executed_units: 10\n");
}

TEST(RandomInputs, AreCountedUpToAnInterrupt) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(TryRandomInputs(Of(10), IsInterruptedAtFour), 130);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "stat::number_of_executed_units: 5\n");
}

TEST(RandomInputsDeathTest, OneThatFailsIsNamedAndKeptAndEndsTheProgram) {
  const Folder folder;
  Campaign campaign = Of(10);
  campaign.found_prefix = folder.Path("found-");
  EXPECT_EXIT(TryRandomInputs(campaign, AbortsAtThree), testing::ExitedWithCode(1),
              "it is input 3\n\nfails: input 3 of seed 7; again: --seed 7 --first 3 --inputs 1; "
              "kept as .*/found-7-3\n");
  const std::string kept = ReadAll(folder.Path("found-7-3"));
  EXPECT_EQ(Bytes(kept.begin(), kept.end()), RandomInput(kSeed, 3));
  EXPECT_EXIT(TryFile(folder.Path("found-7-3"), 1, AbortsAtThree), testing::ExitedWithCode(1),
              "fails: .*/found-7-3\n");
  campaign.first = 4;
  EXPECT_EQ(TryRandomInputs(campaign, AbortsAtThree), 0);
}

TEST(RandomInputsDeathTest, ACrashAnExceptionAndAHangAreFailures) {
  EXPECT_EXIT(TryRandomInputs(Of(10), CrashesAtTwo), testing::ExitedWithCode(1),
              "fails: input 2 of seed 7");
  EXPECT_EXIT(TryRandomInputs(Of(10), ThrowsAtOne), testing::ExitedWithCode(1),
              "fails: input 1 of seed 7");
  Campaign impatient = Of(10);
  impatient.timeout_s = 1;
  EXPECT_EXIT(TryRandomInputs(impatient, HangsAtOne), testing::ExitedWithCode(1),
              "hangs: input 1 of seed 7");
}

}  // namespace
}  // namespace taut::fuzz
