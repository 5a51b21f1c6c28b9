/// Thread safety of a batch's const functions: calls from several threads at once.

#include <gtest/gtest.h>

#include <latch>
#include <thread>
#include <vector>

#include "tests/determinism/variety.h"

namespace taut::test {
namespace {

/// Returns a sample of a world's readings; cables are evaluated at the first call.
std::vector<double> ReadingsOf(const WorldBatch& batch, int world) {
  std::vector<double> out;
  for (int c = 0; c < static_cast<int>(batch.model().def().cables.size()); ++c) {
    EachReading([&out](double x) { out.push_back(x); }, batch.Cable(world, c));
  }
  out.push_back(batch.TotalEnergy(world).elastic_j);
  out.push_back(batch.NodePosition(world, 0).z);
  out.push_back(static_cast<double>(batch.Contacts(world).size()));
  out.push_back(static_cast<double>(batch.Hash(world) % 1024));
  return out;
}

TEST(Reading, FromSeveralThreadsAtOnceSeesWhatOneThreadSees) {
  constexpr int kThreads = 4, kWorlds = 32, kRounds = 60;
  WorldBatchOptions options;
  options.worlds = kWorlds;
  options.simd = Simd::kSse2;  // many groups
  const ModelDef def = scenes::Tetraspine().Def();
  WorldBatch read_by_all = MakeBatch(def, options), read_by_one = MakeBatch(def, options);
  for (int world = 0; world < kWorlds; ++world) {
    Scatter(read_by_all, world, world);
    Scatter(read_by_one, world, world);
  }
  for (int round = 0; round < kRounds; ++round) {
    read_by_all.Step(1e-3);
    read_by_one.Step(1e-3);
    std::vector<std::vector<double>> seen[kThreads];
    std::latch ready(kThreads);
    std::vector<std::thread> threads;
    for (auto& mine : seen) {
      mine.resize(kWorlds);
      threads.emplace_back([&] {
        const int first = static_cast<int>(&mine - seen) * kWorlds / kThreads;
        const WorldBatch& batch = read_by_all;
        ready.arrive_and_wait();
        for (int i = 0; i < kWorlds; ++i) {
          const int world = (first + i) % kWorlds;
          mine[static_cast<std::size_t>(world)] = ReadingsOf(batch, world);
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    for (int world = 0; world < kWorlds; ++world) {
      const std::vector<double> want = ReadingsOf(read_by_one, world);
      for (const auto& one : seen) {
        ASSERT_EQ(one[static_cast<std::size_t>(world)], want) << round << ", world " << world;
      }
    }
  }
}

}  // namespace
}  // namespace taut::test
