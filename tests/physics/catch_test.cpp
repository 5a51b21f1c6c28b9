/// Energy of undamped cables that repeatedly go slack and become taut (docs/theory/cables.md, eq.
/// 8-11): every catch is a kink of the force, at which the scheme must neither add nor remove
/// energy.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "tests/physics/world.h"

namespace taut::test {
namespace {

constexpr double kStep = 1e-3, kMass = 0.1;
/// w h of a mass of 0.1 kg. The first four are soft: h^2 K <= 0.1.
constexpr double kSoft[] = {0.05, 0.1, 0.2, 0.31}, kStiff[] = {0.33, 0.5, 1, 2, 5, 10};

double StiffnessFor(double wh) { return kMass * wh * wh / (kStep * kStep); }

void AddBall(ModelDef& def, double mass, const Vec3& at, const Vec3& velocity) {
  BodyDef body;
  body.name = "ball" + std::to_string(def.bodies.size());
  body.mass_kg = mass;
  body.com_m = at;
  body.velocity_m_per_s = velocity;
  body.inertia_kg_m2 = {1e-5, 1e-5, 1e-5, 0, 0, 0};
  def.bodies.push_back(body);
}
void AddCable(ModelDef& def, const AttachmentDef& a, const AttachmentDef& b, double stiffness,
              double rest) {
  CableDef cable;
  cable.name = "cable" + std::to_string(def.cables.size());
  cable.attachments = {a, b};
  cable.stiffness_n_per_m = stiffness;
  cable.rest_length_m = rest;
  def.cables.push_back(cable);
}

constexpr int kPhases = 8;
BodyState StartOf(int phase) {
  BodyState state;
  state.position_m = {0.3, 0.02 * phase, 0.2};
  state.velocity_m_per_s = {0.5, 0.4 - 0.1 * phase, 1};
  return state;
}
/// Returns a ball thrown up to one side of the point that 0.5 m of cable tie it to: it falls into
/// the cable, bounces and swings in three dimensions. Eight worlds with different throws.
WorldBatch Thrown(double stiffness, double damping = 0, DampingLaw law = DampingLaw::kExact,
                  int worlds = kPhases) {
  ModelDef def;
  const BodyState first = StartOf(0);
  AddBall(def, kMass, first.position_m, first.velocity_m_per_s);
  AddCable(def, {kWorld, {0, 0, 0}}, {0, first.position_m}, stiffness, 0.5);
  def.cables[0].damping_n_s_per_m = damping;
  def.cables[0].damping_law = law;
  WorldBatchOptions options;
  options.worlds = worlds;
  WorldBatch batch = MakeBatch(def, options);
  for (int i = 0; i < worlds; ++i) batch.SetBodyState(i, 0, StartOf(i));
  return batch;
}
/// Returns the energy above the rest position on a rigid cable [J].
double EnergyAbove(const WorldBatch& batch, int world) {
  const Energy e = batch.TotalEnergy(world);
  return e.kinetic_j + e.gravity_j + e.elastic_j + kMass * 9.81 * 0.5;
}

struct Range {
  double least = 1, most = 1, end = 1;  ///< `end`: final value that is furthest from 1.
};
/// Returns the range of the worlds' energies over time, each as a share of its initial value.
template <class F>
Range Follow(WorldBatch& batch, double time_s, const F& energy) {
  Range range;
  std::vector<double> start, now;
  for (int i = 0; i < batch.worlds(); ++i) start.push_back(energy(batch, i));
  now = start;
  for (int n = 0; n < StepsIn(time_s, kStep); ++n) {
    batch.Step(kStep);
    for (int i = 0; i < batch.worlds(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      now[k] = energy(batch, i) / start[k];
      range.least = std::min(range.least, now[k]), range.most = std::max(range.most, now[k]);
    }
  }
  for (const double share : now) {
    if (std::abs(share - 1) > std::abs(range.end - 1)) range.end = share;
  }
  return range;
}

TEST(Catch, ImplicitTensionsKeepTheEnergyOfAMinuteOfCatches) {
  for (const double wh : kStiff) {
    WorldBatch batch = Thrown(StiffnessFor(wh));
    const Range energy = Follow(batch, 60, EnergyAbove);
    // The cable's direction is taken at the middle of the step: an error of third order per step.
    EXPECT_LT(energy.most, 1 + 1e-4) << "w h = " << wh;
    EXPECT_GT(energy.least, 0.995) << "w h = " << wh;
    for (int i = 0; i < kPhases; ++i) EXPECT_EQ(batch.Status(i).bits, kStatusOk) << wh;
  }
}

TEST(Catch, ExplicitTensionsKeepTheEnergyOfAMinuteOfCatches) {
  for (const double wh : kSoft) {
    WorldBatch batch = Thrown(StiffnessFor(wh));
    const Range energy = Follow(batch, 60, EnergyAbove);
    EXPECT_LT(energy.most, 1.002) << "w h = " << wh;
    // While taut, leapfrog keeps v^2 + w^2 x^2 / (1 - w^2 h^2 / 4): the energy oscillates below its
    // initial value.
    EXPECT_GT(energy.least, 1 - 0.25 * wh * wh - 0.002) << "w h = " << wh;
  }
}

TEST(Catch, ADampedCatchNeverGainsByEitherLaw) {
  for (const DampingLaw law : {DampingLaw::kExact, DampingLaw::kClamped}) {
    for (const double wh : {0.1, 0.31, 0.5, 2.0, 10.0}) {
      for (const double ratio : {0.02, 0.5, 5.0}) {
        const double k = StiffnessFor(wh);
        WorldBatch batch = Thrown(k, 2 * ratio * std::sqrt(k * kMass), law);
        const Range energy = Follow(batch, 5, EnergyAbove);
        EXPECT_LT(energy.most, 1.002) << wh << ' ' << ratio;
        EXPECT_LT(energy.end, 0.98) << wh << ' ' << ratio;
        EXPECT_GE(batch.Cable(0, 0).tension_n, 0);
      }
    }
  }
}

TEST(Catch, AWorldIsCaughtAloneAsAmongOthersWithDampers) {
  for (const double wh : {0.2, 0.5, 5.0}) {
    WorldBatch batch = Thrown(StiffnessFor(wh));
    for (int i = 0; i < kPhases; i += 2) {
      batch.SetParameter(i, Parameter::kCableDamping, 0, 0.1 * i);
    }
    batch.Step(kStep, 3000);
    for (const int i : {1, 4, 7}) {
      WorldBatch alone = Thrown(StiffnessFor(wh), i % 2 == 0 ? 0.1 * i : 0, DampingLaw::kExact, 1);
      alone.SetBodyState(0, 0, StartOf(i));
      alone.Step(kStep, 3000);
      const Vec3 a = alone.Body(0, 0).position_m, b = batch.Body(i, 0).position_m;
      EXPECT_EQ(std::bit_cast<std::uint64_t>(a.x), std::bit_cast<std::uint64_t>(b.x)) << wh << i;
      EXPECT_EQ(std::bit_cast<std::uint64_t>(a.z), std::bit_cast<std::uint64_t>(b.z)) << wh << i;
    }
  }
}

double Total(const WorldBatch& batch, int world) {
  const Energy e = batch.TotalEnergy(world);
  return e.kinetic_j + e.gravity_j + e.elastic_j;
}

/// Returns two balls in a row of three cables, thrown across the row.
WorldBatch Chain(double stiffness, double across) {
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  AddBall(def, kMass, {0, 0, 0}, {0, 0, 0.2});
  AddBall(def, 2 * kMass, {0.2, 0, 0}, {0.5, across, 0});
  AddCable(def, {0, {0, 0, 0}}, {1, {0.2, 0, 0}}, stiffness * 2 / 3, 0.5);
  AddCable(def, {kWorld, {-0.6, 0, 0}}, {0, {0, 0, 0}}, stiffness / 2, 0.5);
  AddCable(def, {kWorld, {0.8, 0, 0}}, {1, {0.2, 0, 0}}, stiffness / 2, 0.5);
  return MakeBatch(def);
}

TEST(Catch, SeveralStiffCablesKeepTheEnergyToWhatIsMeasured) {
  // A known limitation: bodies move across several cables, whose directions are taken at the middle
  // of the step. The bounds are measured; other cases gain energy without limit
  // (docs/theory/cables.md).
  struct Case {
    double wh, least, most;
  };
  for (const Case& c : {Case{0.5, 0.8, 1.01}, Case{1, 0.2, 1.03}, Case{2, 0.02, 1.2}}) {
    for (int i = 0; i < 4; ++i) {
      WorldBatch batch = Chain(StiffnessFor(c.wh), 0.3 * i);
      const Range energy = Follow(batch, 20, Total);
      EXPECT_GT(energy.least, c.least) << "w h = " << c.wh;
      EXPECT_LT(energy.most, c.most) << "w h = " << c.wh;
    }
  }
}

TEST(Catch, ARodAmongSixStiffCablesKeepsTheEnergyToWhatIsMeasured) {
  struct Case {
    double stiffness, least, most;
  };
  const Vec3 tips[] = {{0.1, 0.02, 0.03}, {-0.1, 0, 0}};
  const Vec3 anchors[] = {{1, 1, 1},   {-1, 1, -1}, {1, -1, -1},
                          {-1, -1, 1}, {1, 0, -1},  {-1, 0.3, 1}};
  for (const Case& c : {Case{400, 0.99, 1.005}, Case{4e3, 0.88, 1.01}, Case{4e4, 0.75, 1.1}}) {
    ModelDef def;
    def.gravity_m_per_s2 = {0, 0, 0};
    AddBall(def, kMass, {0, 0.01, 0.015}, {1, 2, 1.5});
    const Vec3 d = tips[0] - tips[1];
    const double across = kMass * Dot(d, d) / 12, along = 1e-3 * across, n = 1 / Dot(d, d);
    const auto entry = [&](double p, double q) { return n * p * q * (along - across); };
    def.bodies[0].inertia_kg_m2 = {across + entry(d.x, d.x), across + entry(d.y, d.y),
                                   across + entry(d.z, d.z), entry(d.x, d.y),
                                   entry(d.x, d.z),          entry(d.y, d.z)};
    def.bodies[0].angular_velocity_rad_per_s = {3, 5, 2};
    for (std::size_t i = 0; i < 6; ++i) {
      const Vec3 tip = tips[i % 2], anchor = 0.5 * anchors[i];
      AddCable(def, {kWorld, anchor}, {0, tip}, c.stiffness, 0.95 * Distance(anchor, tip));
    }
    WorldBatch batch = MakeBatch(def);
    const Range energy = Follow(batch, 20, Total);
    EXPECT_GT(energy.least, c.least) << c.stiffness;
    EXPECT_LT(energy.most, c.most) << c.stiffness;
  }
}

}  // namespace
}  // namespace taut::test
