// Snapshots of a simulation's worlds: they continue with the same bits, and foreign ones change
// nothing
#include <gtest/gtest.h>

#include "taut/lane_state.h"
#include "tests/unit/plant/simulation_fixture.h"

namespace taut::test {
namespace {

TEST(Simulation, ASavedWorldContinuesInAnyWorldOfAnySimulation) {
  const ExperimentSpec experiment = Load("push_20n_motors", 1.5);
  const auto variants = Variants(experiment, 3);
  const auto simulation = Create(experiment, {.variants = variants});
  simulation->RunUntil(0.6);
  // Commands, gains and forces of the program are part of the state.
  auto gains = simulation->Gains("outer_top_1", 2);
  if (gains) {
    gains->tension_offset_n += 1;
    EXPECT_TRUE(simulation->SetGains(*gains, 2));
  }
  simulation->SetNodeForce(0, {0.5, 0, 1}, 2);
  simulation->RunUntil(0.7);
  const auto saved = simulation->Save(2);
  simulation->RunUntil(0.9);
  const std::uint64_t expected = simulation->Hash(2);
  const auto other = Create(experiment, {.variants = variants, .simd = Simd::kScalar});
  other->RunUntil(0.2);
  Diagnostics out;
  ASSERT_TRUE(other->Restore(saved, out, 0)) << out.Format();
  EXPECT_NEAR(other->Time(0), 0.7, 1e-12);
  other->RunUntil(0.9);
  EXPECT_EQ(other->Hash(0), expected);
  EXPECT_NE(other->Hash(1), expected);
}

TEST(Simulation, SnapshotsOfOthersAreRefused) {
  const ExperimentSpec experiment = Load("push_20n", 1), another = Load("push_20n", 2);
  const auto variants = Variants(experiment, 2);
  const auto simulation = Create(experiment);
  const auto refused = [&](const std::vector<std::uint8_t>& bytes) {
    Diagnostics out;
    EXPECT_FALSE(simulation->Restore(bytes, out));
    return out.items().empty() ? std::string() : std::string(out.items()[0].id);
  };
  EXPECT_EQ(refused({1, 2, 3}), "snapshot.not_a_snapshot");
  EXPECT_EQ(refused(Create(another)->Save()), "snapshot.other_environment");
  EXPECT_EQ(refused(Create(experiment, {.variants = variants})->Save(1)), "snapshot.other_variant");
  auto damaged = simulation->Save();
  damaged.back() ^= 1;
  EXPECT_EQ(refused(damaged), "snapshot.damaged");
}

/// Forces of the program at the snapshot, before it and after it, also cleared ones.
TEST(Simulation, SnapshotsHoldAndClearForcesOnNodes) {
  for (const char* name : {"push_20n", "stand_still"}) {
    const ExperimentSpec experiment = Load(name, 1);
    const auto plain = Create(experiment), simulation = Create(experiment);
    Diagnostics out;
    const auto untouched = simulation->Save();
    simulation->SetNodeForce(3, {0, 0, 2});
    simulation->RunUntil(0.05);
    const auto pushed = simulation->Save();
    simulation->SetNodeForce(3, {});  // cleared, but not stepped yet
    const auto cleared = simulation->Save();
    simulation->RunUntil(0.1);
    const std::uint64_t expected = simulation->Hash();
    ASSERT_TRUE(simulation->Restore(untouched, out)) << out.Format();
    simulation->RunUntil(0.1);
    plain->RunUntil(0.1);
    EXPECT_EQ(simulation->Hash(), plain->Hash()) << name;
    // Restores into a simulation that never had a force on this node, but has one on another node.
    const auto other = Create(experiment, {.worlds = 3});
    other->SetNodeForce(5, {1, 0, 0}, 1);
    other->RunUntil(0.02);
    for (int w = 0; w < 3; ++w) ASSERT_TRUE(other->Restore(cleared, out, w)) << out.Format();
    ASSERT_TRUE(other->Restore(pushed, out, 2)) << out.Format();
    ASSERT_EQ(other->ExternalForces(2).size(), 1u);
    other->SetNodeForce(3, {}, 2);
    other->RunUntil(0.1);
    for (int w = 0; w < 3; ++w) EXPECT_EQ(other->Hash(w), expected) << name << w;
  }
}

/// Many forces on few nodes need more space in memory than in the snapshot.
TEST(Simulation, SnapshotsHoldMoreForcesThanNodes) {
  const auto simulation = Create(Load("stand_still", 1));
  const std::vector<ExternalForce> forces(20'000, {1, {1e-6, 0, 0}});
  simulation->SetExternalForces(forces);
  const auto saved = simulation->Save();
  simulation->SetExternalForces({});
  Diagnostics out;
  ASSERT_TRUE(simulation->Restore(saved, out)) << out.Format();
  EXPECT_EQ(simulation->ExternalForces().size(), forces.size());
}

/// Remembers how often it has acted
class Counter final : public Controller {
 public:
  ClockSpec clock() const override { return {0.01, 0.0}; }
  void Act(const Tick& tick, const Observation&, Commands&) override {
    if (Has(tick.due, 0)) ++count_;
  }
  void Serialize(plant::LaneState& state) override { state.Value(count_); }

 private:
  std::uint64_t count_ = 0;
};

TEST(Simulation, SnapshotsOfOtherControllersChangeNothing) {
  const ExperimentSpec experiment = Load("push_20n", 1);
  Extensions counts, also_positions;
  counts.controllers = {[](const ControlSetup&) { return std::make_unique<Counter>(); }};
  ControllerSpec position;
  position.position.push_back({0, {{0.0, 0.2}}});
  also_positions.controllers = ControllersOf(position);
  const auto plain = Create(experiment);
  const auto counting = Create(experiment, {.extensions = counts});
  const auto other = Create(experiment, {.extensions = also_positions});
  for (Simulation* one : {plain.get(), counting.get(), other.get()}) one->RunUntil(0.1);
  const auto refused = [&](Simulation& into, const std::vector<std::uint8_t>& bytes) {
    const std::uint64_t before = into.Hash();
    const auto saved = into.Save();
    Diagnostics out;
    EXPECT_FALSE(into.Restore(bytes, out));
    EXPECT_EQ(into.Hash(), before);
    EXPECT_EQ(into.Save(), saved);
    return out.items().empty() ? std::string() : std::string(out.items()[0].id);
  };
  EXPECT_EQ(refused(*counting, plain->Save()), "snapshot.other_environment");
  EXPECT_EQ(refused(*plain, counting->Save()), "snapshot.other_environment");
  EXPECT_EQ(refused(*counting, other->Save()), "snapshot.other_controllers");
  EXPECT_EQ(refused(*other, counting->Save()), "snapshot.other_controllers");
}

TEST(Simulation, VariantsThatWereReplacedCanBeRestored) {
  const ExperimentSpec experiment = Load("push_20n", 1);
  const auto variants = Variants(experiment, 2);
  const auto simulation = Create(experiment, {.variants = variants});
  const auto first = simulation->Save(0), second = simulation->Save(1);
  Diagnostics out;
  EXPECT_TRUE(simulation->Restore(second, out, 0)) << out.Format();
  EXPECT_TRUE(simulation->Restore(first, out, 1)) << out.Format();
  const auto plain = Create(experiment, {.variants = variants});
  for (Simulation* one : {simulation.get(), plain.get()}) one->RunUntil(0.2);
  EXPECT_EQ(simulation->Hash(0), plain->Hash(1));
  EXPECT_EQ(simulation->Hash(1), plain->Hash(0));
}

}  // namespace
}  // namespace taut::test
