/// Natural frequencies of a T-bar and a D-bar with clustered cables, one of them through an eyelet
/// at the end of the other bar: examples of CTSFEM (S. Ma, M. Chen, R. E. Skelton). Exact
/// linearization of their equations gives 1.14402, 34.52647 and 41.24972 Hz, and 63.34215 and
/// 88.54425 Hz, whether the bars are elastic or rigid; with massless cables, as here, 1.148527,
/// 34.634486 and 41.729113, and 63.515182 and 89.679860.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/physics/world.h"

namespace taut::test {
namespace {

/// Two crossed bars, from (0, 0) to (2, 0) and from (1, half) to (1, -half).
struct Bars {
  double half, mass[2], stiffness, rest;  ///< Stiffness and rest length of a cable along one side.
};
constexpr Bars kTBar{2, {2.4746351864, 13.9986379133}, 31107.8383, 2.2324739177};
constexpr Bars kDBar{1, {7.8255358022, 7.8255358022}, 311079.532, 1.4119404794};

/// Center (x, y) and rotation of each of the two bars.
using Shape = std::array<double, 6>;

ModelDef Model(const Bars& cross) {
  ModelDef def;
  def.gravity_m_per_s2 = {};
  const Vec3 node[4] = {{0, 0, 0}, {1, cross.half, 0}, {2, 0, 0}, {1, -cross.half, 0}};
  for (int b = 0; b < 2; ++b) {
    BodyDef bar;
    bar.mass_kg = cross.mass[b];
    bar.com_m = {1, 0, 0};
    const double length = b == 0 ? 2 : 2 * cross.half;
    const double inertia = bar.mass_kg * length * length / 12;
    bar.inertia_kg_m2 = {b == 0 ? 1e-3 : inertia, b == 0 ? inertia : 1e-3, inertia, 0, 0, 0};
    def.bodies.push_back(bar);
  }
  const auto add = [&](std::vector<int> nodes) {
    CableDef cable;
    cable.name = "cable" + std::to_string(def.cables.size());
    for (const int n : nodes) cable.attachments.push_back({n % 2, node[n]});
    const auto sides = static_cast<double>(nodes.size() - 1);
    cable.stiffness_n_per_m = cross.stiffness / sides;
    cable.rest_length_m = cross.rest * sides;
    def.cables.push_back(cable);
  };
  add({0, 1, 2});
  add({2, 3});
  add({3, 0});
  return def;
}

/// Returns the frequency [Hz] of free vibration in one mode, from the zero crossings of the modal
/// coordinate.
double FrequencyOf(const Bars& cross, const Shape& shape, int cycles) {
  constexpr double kStep = 1e-4, kAmplitude = 1e-5;
  const ModelDef def = Model(cross);
  WorldBatch world = MakeBatch(def);
  for (int b = 0; b < 2; ++b) {
    BodyState state = world.Body(0, b);
    const double* q = &shape[static_cast<std::size_t>(3 * b)];
    state.position_m = state.position_m + kAmplitude * Vec3{q[0], q[1], 0};
    state.orientation = {1, 0, 0, 0.5 * kAmplitude * q[2]};
    world.SetBodyState(0, b, state);
  }
  const auto share = [&] {
    double sum = 0;
    for (int b = 0; b < 2; ++b) {
      const BodyState state = world.Body(0, b);
      const double* q = &shape[static_cast<std::size_t>(3 * b)];
      const BodyDef& bar = def.bodies[static_cast<std::size_t>(b)];
      sum += bar.mass_kg * (q[0] * (state.position_m.x - 1) + q[1] * state.position_m.y);
      sum += bar.inertia_kg_m2.zz * q[2] * 2 * state.orientation.z;
    }
    return sum;
  };
  double first = 0, last = 0, before = share();
  for (int crossings = 0; crossings <= 2 * cycles;) {
    world.Step(kStep);
    const double now = share();
    if (before * now < 0) {
      last = world.Time(0) - kStep * now / (now - before);
      if (crossings++ == 0) first = last;
    }
    before = now;
    if (world.Time(0) > 30) return 0;
  }
  return cycles / (last - first);
}

TEST(Clustered, TheTBarVibratesAsItsExactEquationsSay) {
  EXPECT_NEAR(FrequencyOf(kTBar, {0.560084745, 0, -0.316880569, -0.099010660, 0, 0.014004291}, 3),
              1.148527, 1e-3 * 1.148527);
  EXPECT_NEAR(FrequencyOf(kTBar, {0, 0.585999639, 0, 0, -0.103591174, 0}, 30), 34.634486,
              1e-3 * 34.634486);
  EXPECT_NEAR(FrequencyOf(kTBar, {0.172337015, 0, 1.029843450, -0.030465196, 0, -0.045513122}, 30),
              41.729113, 1e-3 * 41.729113);
}

TEST(Clustered, TheDBarDoesToo) {
  EXPECT_NEAR(FrequencyOf(kDBar, {0, 0.252771415, 0, 0, -0.252771416, 0}, 30), 63.515182,
              1e-3 * 63.515182);
  EXPECT_NEAR(FrequencyOf(kDBar, {0.126690786, 0, 0.378851554, -0.126690787, 0, -0.378851554}, 30),
              89.679860, 1e-3 * 89.679860);
}

}  // namespace
}  // namespace taut::test
