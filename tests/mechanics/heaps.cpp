/// Slabs on rods and heaps of rods: every step converges, within a bounded multiple of the mean
/// work.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/mechanics/known_scene.h"
#include "tests/physics/world.h"
#include "tests/scenes/heap.h"
#include "tests/scenes/stacks.h"

namespace taut::mechanics {
namespace {

constexpr double kHeapStepS = 1e-3;
/// Largest relaxation of inconsistent contacts (docs/theory/contact.md, section 5).
constexpr double kMostRelaxationMPerS = 1e-6;
/// Number of linear systems of the worst step, as a multiple of the scene's mean.
constexpr double kMostOfMean = 30;

/// A slab on six light rods around the center.
struct Slab {
  double mass_ratio;   ///< Mass of the slab over the mass of a rod.
  double crooked_rad;  ///< Largest deviation of each rod's direction to either side of x.
  Vec3 velocity_m_per_s{}, spin_rad_per_s{};

  static constexpr double kRodKg = 0.1;
  double WeightN() const { return kRodKg * (6 + mass_ratio) * 9.81; }

  ModelDef Def(std::uint64_t seed) const {
    constexpr double kHeapRadiusM = 0.01, kHalfLengthM = 0.05, kOutM = 0.2;
    const Material material{0.5, 0.5, 0.0};
    ModelDef def;
    scenes::AddGround(def, material);
    scenes::Chance chance(seed);
    for (int i = 0; i < 6; ++i) {
      const double place = std::numbers::pi / 3 * i,
                   heading = chance.Within(-crooked_rad, crooked_rad);
      const Vec3 middle{kOutM * std::cos(place), kOutM * std::sin(place), kHeapRadiusM};
      const Vec3 half{kHalfLengthM * std::cos(heading), kHalfLengthM * std::sin(heading), 0};
      scenes::AddRod(def, "rod_" + std::to_string(i), kRodKg, kHeapRadiusM,
                     scenes::Between(half, middle), scenes::Sum(middle, half), material);
    }
    const Vec3 half{0.3, 0.3, 0.05};
    const int slab = scenes::AddBox(def, "slab", kRodKg * mass_ratio, half,
                                    {0, 0, 2 * kHeapRadiusM + half.z}, {}, material);
    BodyDef& body = def.bodies[static_cast<std::size_t>(slab)];
    body.velocity_m_per_s = velocity_m_per_s;
    body.angular_velocity_rad_per_s = spin_rad_per_s;
    return def;
  }
};

/// Collects solver statistics over several runs.
class Steps {
 public:
  void Run(WorldBatch& world, int count) {
    double highest = 0;
    const double start = test::EnergyOf(world);
    for (int i = 0; i < count; ++i) {
      world.Step(kHeapStepS);
      const WorldStatus status = world.Status(0);
      unsolved_ += (status.bits & kStatusNotConverged) != 0;
      relaxation_ = std::max(relaxation_, status.contact_relaxation_m_per_s);
      worst_ = std::max(worst_, status.linear_solves);
      sum_ += status.linear_solves;
      ++count_;
      world.ClearStatus(0);
      highest = std::max(highest, test::EnergyOf(world) - start);
    }
    gain_ = std::max(gain_, highest / std::abs(start));
  }
  void AddTo(Report& report) const {
    report.AtMost("unsolved steps, of " + std::to_string(count_), "1", unsolved_, 0);
    report.AtMost("largest relaxation of inconsistent contacts", "m/s", relaxation_,
                  kMostRelaxationMPerS);
    report.AtMost("energy gain above the initial value", "1", gain_, 1e-9);
  }
  double worst_of_mean() const { return worst_ * static_cast<double>(count_) / sum_; }

 private:
  int unsolved_ = 0, worst_ = 0;
  long count_ = 0;
  double sum_ = 0, relaxation_ = 0, gain_ = -1;
};

double ForceOfTheGround(const WorldBatch& world) {
  double sum = 0;
  for (const ContactState& contact : world.Contacts(0)) {
    if (contact.body_b == kWorld) sum += contact.force_n.z;
  }
  return sum;
}

/// Runs one slab from several starts, until it is at rest.
void Settle(Report& report, const Slab& slab) {
  Steps steps;
  double weight = 0, speed = 0;
  for (std::uint64_t seed = 1; seed <= (report.IsFull() ? 6 : 2); ++seed) {
    WorldBatch world = test::MakeBatch(slab.Def(seed));
    steps.Run(world, report.IsFull() ? 3000 : 500);
    weight = std::max(weight, std::abs(ForceOfTheGround(world) / slab.WeightN() - 1));
    speed = std::max(speed, test::Norm(world.Body(0, 6).velocity_m_per_s));
  }
  steps.AddTo(report);
  report.AtMost("deviation of the ground force at rest from the weight (relative)", "1", weight,
                1e-9);
  report.AtMost("speed of the slab at rest", "m/s", speed, 1e-9);
}

void SpinningSlab(Report& report) { Settle(report, {1e4, 0.3, {}, {0, 0, 0.3}}); }
void SlidingSlab(Report& report) { Settle(report, {1e4, 0.3, {0.1, 0, 0}, {}}); }
void HeavySlab(Report& report) { Settle(report, {1e6, 0.3, {0.1, 0, 0}, {}}); }

/// Nearly parallel rods: they roll together with a slip of 0.1 %.
void Rollers(Report& report) {
  Steps steps;
  for (const double ratio : {1e4, 1e6}) {
    for (std::uint64_t seed = 1; seed <= (report.IsFull() ? 6 : 2); ++seed) {
      WorldBatch world = test::MakeBatch(Slab{ratio, 1e-3, {0.05, 0, 0}, {}}.Def(seed));
      steps.Run(world, report.IsFull() ? 3000 : 200);
    }
  }
  steps.AddTo(report);
}

void Heaps(Report& report, int rods, double friction, const std::vector<std::uint64_t>& seeds,
           int count) {
  Steps steps;
  for (const std::uint64_t seed : seeds) {
    scenes::RodHeap heap;
    heap.rods = rods;
    heap.friction = friction;
    heap.seed = seed;
    WorldBatch world = test::MakeBatch(heap.Def());
    steps.Run(world, count);
  }
  steps.AddTo(report);
  report.AtMost("largest number of linear systems in a step, relative to the mean", "1",
                steps.worst_of_mean(), kMostOfMean);
}

void SmallHeap(Report& report) {
  if (report.IsFull()) return Heaps(report, 20, 0.5, {1, 2, 3, 4, 5, 6, 21, 22}, 2000);
  Heaps(report, 20, 0.5, {3}, 1500);
}
void RoughHeap(Report& report) {
  if (report.IsFull()) return Heaps(report, 20, 0.8, {1, 2, 3, 4, 5, 6, 21, 22}, 2000);
  Heaps(report, 20, 0.8, {4}, 1200);
}
void LargeHeap(Report& report) {
  if (report.IsFull()) return Heaps(report, 40, 0.5, {1, 2, 3, 31}, 2000);
  Heaps(report, 24, 0.5, {1}, 600);
}

const SceneEntry kSpinningSlab("heaps", "Slab that spins on six rods, mass ratio 1e4",
                               "the laws of contact; statics at rest", SpinningSlab);
const SceneEntry kSlidingSlab("heaps", "Slab that slides on six rods, mass ratio 1e4",
                              "the laws of contact; statics at rest", SlidingSlab);
const SceneEntry kHeavySlab("heaps", "Slab that slides on six rods, mass ratio 1e6",
                            "the laws of contact; statics at rest", HeavySlab);
const SceneEntry kRollers("heaps", "Slab on six rollers that are not quite parallel",
                          "the laws of contact", Rollers);
const SceneEntry kSmallHeap("heaps", "Heap of 20 rods, friction 0.5", "the laws of contact",
                            SmallHeap);
const SceneEntry kRoughHeap("heaps", "Heap of 20 rods, friction 0.8", "the laws of contact",
                            RoughHeap);
const SceneEntry kLargeHeap("heaps", "Heap of 24 rods (full: 40)", "the laws of contact",
                            LargeHeap);

}  // namespace
}  // namespace taut::mechanics
