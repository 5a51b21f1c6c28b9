// Control law that rolls toward a goal, against rotations and sums written explicitly
#include "taut/control/toward_goal.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "simd/wide.h"

namespace taut::control {
namespace {

using Vector = std::array<double, 3>;
using Matrix = std::array<Vector, 3>;  // rows

Vector Times(const Matrix& m, const Vector& v) {
  Vector out{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) out[i] += m[i][k] * v[k];
  }
  return out;
}

Matrix Transposed(const Matrix& m) {
  Matrix out{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) out[i][k] = m[k][i];
  }
  return out;
}

/// Inverts by Gaussian elimination, column by column.
Matrix Inverse(Matrix m) {
  Matrix out{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (std::size_t p = 0; p < 3; ++p) {
    const double pivot = m[p][p];
    for (std::size_t k = 0; k < 3; ++k) m[p][k] /= pivot, out[p][k] /= pivot;
    for (std::size_t i = 0; i < 3; ++i) {
      const double factor = m[i][p];
      for (std::size_t k = 0; i != p && k < 3; ++k) {
        m[i][k] -= factor * m[p][k];
        out[i][k] -= factor * out[p][k];
      }
    }
  }
  return out;
}

Direction<double> Of(const Vector& v) { return {v[0], v[1], v[2]}; }

/// Five struts in irregular directions
struct Struts {
  std::vector<Vector> described{
      {1, 0, 0}, {0.6, 0.8, 0}, {0, -0.28, 0.96}, {0.48, 0.6, 0.64}, {-0.36, 0.48, 0.8}};

  StrutFrame<double> Frame() const {
    Matrix s{};
    for (const Vector& u : described) {
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) s[i][k] += u[i] * u[k];
      }
    }
    const Matrix inverse = Inverse(s);
    return {inverse[0][0], inverse[1][1], inverse[2][2],
            inverse[0][1], inverse[1][2], inverse[0][2]};
  }
  Direction<double> InRobotAfter(const Matrix& change, const Vector& v) const {
    std::vector<Direction<double>> before, now;
    for (const Vector& u : described) before.push_back(Of(u)), now.push_back(Of(Times(change, u)));
    return InRobot(Frame(), before.data(), now.data(), now.size(), Of(v));
  }
};

// R is a rotation by 2.1 rad about (1, 2, 2) / 3, by Rodrigues' formula. A direction v of the world
// is R^T v in the robot.
TEST(TowardGoal, ATurnedRobotSeesTheWorldTurnedBack) {
  const Vector n{1.0 / 3, 2.0 / 3, 2.0 / 3};
  const double c = std::cos(2.1), s = std::sin(2.1);
  const Matrix cross{{{0, -n[2], n[1]}, {n[2], 0, -n[0]}, {-n[1], n[0], 0}}};
  Matrix turn{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      turn[i][k] = c * (i == k) + (1 - c) * n[i] * n[k] + s * cross[i][k];
    }
  }
  for (const Vector& v : {Vector{0, 0, 1}, Vector{0.6, -0.8, 0}}) {
    const Direction<double> seen = Struts().InRobotAfter(turn, v);
    const Vector expected = Times(Transposed(turn), v);
    EXPECT_NEAR(seen.x, expected[0], 1e-14);
    EXPECT_NEAR(seen.y, expected[1], 1e-14);
    EXPECT_NEAR(seen.z, expected[2], 1e-14);
  }
}

// Struts moved by a linear map F determine F: v' = F^T v, so that v' . r = v . F r is the new place
// of r along v.
TEST(TowardGoal, AWarpedRobotsPlacesAreWhereTheMapPutsThem) {
  const Matrix map{{{1.1, 0.2, 0}, {-0.3, 0.9, 0.1}, {0.05, 0, 1.2}}};
  const Vector v{0.6, 0.8, 0}, place{0.4, -0.9, 0.3};
  const Vector there = Times(map, place);
  EXPECT_NEAR(Along(Struts().InRobotAfter(map, v), Of(place)), v[0] * there[0] + v[1] * there[1],
              1e-14);
}

TEST(TowardGoal, TheSignalIsThePolynomial) {
  const TowardGoal<double> law{0.11, -0.7, 0.3, 0.05, -0.2, 0.6, 0.13, -0.17, 0.19, -0.23};
  for (const double a : {-1.2, 0.0, 0.4}) {
    for (const double z : {-0.9, 0.0, 1.1}) {
      const double sum = -0.7 * a + 0.3 * z + 0.05 * a * a - 0.2 * a * z + 0.6 * z * z +
                         0.13 * std::pow(a, 3) - 0.17 * a * a * z + 0.19 * a * z * z -
                         0.23 * std::pow(z, 3);
      EXPECT_NEAR(TowardGoalSignal(law, a, z, 1.0), 0.11 + sum, 1e-15);
      EXPECT_NEAR(TowardGoalSignal(law, a, z, 0.25), 0.11 + 0.25 * sum, 1e-15);
    }
  }
  for (const double turns : {0.0, 0.1, -0.25, 0.5}) {
    EXPECT_NEAR(BeatStrength(0.3, turns), 1 + 0.3 * std::cos(2 * std::numbers::pi * turns), 1e-15);
  }
}

TEST(TowardGoal, LanesComputeWhatADoubleDoes) {
  using Lanes = simd::Wide<4>;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1, 1);
  std::array<Lanes, 14> in{};
  for (Lanes& row : in) {
    row = Lanes::Splat(0);
    for (int lane = 0; lane < 4; ++lane) row.v[lane] = number(random);
  }
  const auto signal = [&in]<class Real>(const auto& of) -> Real {
    const TowardGoal<Real> law{of(in[0]), of(in[1]), of(in[2]), of(in[3]), of(in[4]),
                               of(in[5]), of(in[6]), of(in[7]), of(in[8]), of(in[9])};
    return TowardGoalSignal<Real>(law, of(in[10]), of(in[11]),
                                  BeatStrength<Real>(of(in[12]), of(in[13])));
  };
  const Lanes together = signal.operator()<Lanes>([](const Lanes& row) { return row; });
  for (int lane = 0; lane < 4; ++lane) {
    EXPECT_EQ(together[lane],
              signal.operator()<double>([lane](const Lanes& row) { return row[lane]; }));
  }
}

}  // namespace
}  // namespace taut::control
