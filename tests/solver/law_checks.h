/// Checks for constraint laws of all kinds (sim/constraint/links.h, ConstraintLaw). A kind provides
///   Violation(law, u, l): distance of u and l from the law as stated in theory
///   NewtonFunction(law, u, l, center, e): function whose root Newton's method finds; row by row a
///   velocity where the scale matters, that is, multiplied by the law's inverse mass
/// as overloads, derived from the theory and not from the law's code.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "math/random.h"
#include "sim/constraint/cable_row.h"
#include "sim/constraint/contact_point.h"

namespace taut::test {

/// Number type of one lane that is unique to the tests, so that they share no template instance
/// with the library.
struct TestNumbers {};
using Num = simd::Wide<1, TestNumbers>;
using Contact2 = sim::ContactPoint<Num, 2>;
using Cable = sim::CableRow<Num>;

template <int R>
using Rows = std::array<double, static_cast<std::size_t>(R)>;
template <int R>
using Matrix = std::array<Rows<R>, static_cast<std::size_t>(R)>;
template <class Law>
using RowsOf = Rows<Law::kRows>;

constexpr std::size_t At(int i) { return static_cast<std::size_t>(i); }

/// Returns rows as the array type of the laws.
template <int R>
struct Packed {
  Num x[R];
  Packed() : x{} {}
  explicit Packed(const Rows<R>& from) {
    for (int r = 0; r < R; ++r) x[r] = Num::Splat(from[At(r)]);
  }
  operator Num*() { return x; }
  Rows<R> Plain() const {
    Rows<R> out{};
    for (int r = 0; r < R; ++r) out[At(r)] = x[r][0];
    return out;
  }
};
template <std::size_t R>
Packed(const std::array<double, R>&) -> Packed<static_cast<int>(R)>;

template <std::size_t R>
double Largest(const std::array<double, R>& x) {
  double worst = 0;
  for (const double y : x) worst = std::max(worst, std::abs(y));
  return worst;
}
template <std::size_t R>
double Largest(const std::array<std::array<double, R>, R>& m) {
  double worst = 0;
  for (const auto& row : m) worst = std::max(worst, Largest(row));
  return worst;
}
template <std::size_t R>
std::array<double, R> Difference(std::array<double, R> a, const std::array<double, R>& b) {
  for (std::size_t r = 0; r < R; ++r) a[r] -= b[r];
  return a;
}

template <class Law>
RowsOf<Law> Projected(const Law& law, const RowsOf<Law>& u, const RowsOf<Law>& center, double e) {
  Packed<Law::kRows> out;
  law.Project(Packed(u), Packed(center), Num::Splat(e), out);
  return out.Plain();
}
template <class Law>
RowsOf<Law> ProjectedFrozen(const Law& law, const RowsOf<Law>& u, const RowsOf<Law>& center,
                            double e, const RowsOf<Law>& l0) {
  Packed<Law::kRows> out;
  law.ProjectFrozen(Packed(u), Packed(center), Num::Splat(e), Packed(l0), out);
  return out.Plain();
}
template <class Law>
double ResidualOf(const Law& law, const RowsOf<Law>& u, const RowsOf<Law>& l) {
  return law.Residual(law.BranchOf(Packed(u), Packed(l)), Packed(u), Packed(l))[0];
}

constexpr double kSoftnesses[] = {1.0, 1e-2, 1e-6};

/// Checks that a solution stays unchanged for every softness and has no residual. u, l of order 1.
template <class Law>
void ExpectSolution(const Law& law, const RowsOf<Law>& u, const RowsOf<Law>& l) {
  ASSERT_LT(Violation(law, u, l), 1e-14) << "the test's own instance";
  for (const double e : kSoftnesses) {
    // The rounding error of u + bias is amplified by 1 / e.
    EXPECT_LT(Largest(Difference(Projected(law, u, l, e), l)), 1e-14 + 1e-15 / e) << "e = " << e;
  }
  EXPECT_LT(ResidualOf(law, u, l), 2e-14);
  EXPECT_LT(Largest(NewtonFunction(law, u, l, l, 0.0)), 2e-14);
}

/// Checks that values that violate the law change, and change more under a harder law.
template <class Law>
void ExpectNoSolution(const Law& law, const RowsOf<Law>& u, const RowsOf<Law>& l) {
  ASSERT_GT(Violation(law, u, l), 1e-4) << "the test's own instance";
  for (const double e : kSoftnesses) {
    EXPECT_GT(Largest(Difference(Projected(law, u, l, e), l)), 1e-4) << "e = " << e;
  }
  EXPECT_GT(ResidualOf(law, u, l), 1e-4);
}

/// Checks that the residual is the largest entry of Newton's function [m/s].
template <class Law>
void ExpectResidualIsNewtons(const Law& law, const RowsOf<Law>& u, const RowsOf<Law>& l) {
  const double expected = Largest(NewtonFunction(law, u, l, l, 0.0));
  EXPECT_NEAR(ResidualOf(law, u, l), expected, 1e-13 * (1 + expected));
}

/// Returns d f_i / d x_j by central differences of a function of rows.
template <std::size_t R, class F>
std::array<std::array<double, R>, R> Differences(const F& f, const std::array<double, R>& x,
                                                 double step) {
  std::array<std::array<double, R>, R> out{};
  for (std::size_t j = 0; j < R; ++j) {
    auto high = x, low = x;
    high[j] += step, low[j] -= step;
    const auto change = Difference(f(high), f(low));
    for (std::size_t i = 0; i < R; ++i) out[i][j] = change[i] / (high[j] - low[j]);
  }
  return out;
}

/// Returns true if a change by `step` in any row crosses a kink of f: its one-sided differences
/// then differ.
template <std::size_t R, class F>
bool HasKink(const F& f, const std::array<double, R>& x, double step, double scale) {
  const auto here = f(x);
  for (std::size_t j = 0; j < R; ++j) {
    auto high = x, low = x;
    high[j] += step, low[j] -= step;
    const auto bend = Difference(Difference(f(high), here), Difference(here, f(low)));
    if (Largest(bend) > 1e-3 * step * scale) return true;
  }
  return false;
}

constexpr double kStep = 1e-6;

/// Checks Derivative against Project and, with its upper triangle mirrored to the lower one,
/// against ProjectFrozen. Returns false next to a kink.
template <class Law>
bool CheckDerivative(const Law& law, const RowsOf<Law>& u, const RowsOf<Law>& center, double e) {
  constexpr int R = Law::kRows;
  const auto project = [&](const RowsOf<Law>& at) { return Projected(law, at, center, e); };
  const auto l0 = project(u);
  const auto frozen = [&](const RowsOf<Law>& at) {
    return ProjectedFrozen(law, at, center, e, l0);
  };
  Num g[R * R];
  Packed<R> l;
  law.Derivative(law.Project(Packed(u), Packed(center), Num::Splat(e), l), Num::Splat(e), g);
  const auto true_g = Differences(project, u, kStep), frozen_g = Differences(frozen, u, kStep);
  const double scale = 1 / e;  // inverse masses are of order 1
  if (HasKink(project, u, kStep, scale)) return false;
  for (int i = 0; i < R; ++i) {
    for (int j = 0; j < R; ++j) {
      EXPECT_NEAR(g[R * i + j][0], -true_g[At(i)][At(j)], 1e-7 * scale) << i << " " << j;
      EXPECT_NEAR(g[R * (i < j ? i : j) + (i < j ? j : i)][0], -frozen_g[At(i)][At(j)],
                  1e-7 * scale)
          << i << " " << j;
    }
  }
  EXPECT_EQ(frozen(u), l0) << "the frozen law is the law where it was frozen";
  return true;
}

/// The frozen law is the gradient of a convex function: its impulses only oppose the motion.
template <class Law>
void ExpectFrozenPushesBack(const Law& law, const RowsOf<Law>& u1, const RowsOf<Law>& u2,
                            const RowsOf<Law>& center, const RowsOf<Law>& l0, double e) {
  const auto dl =
      Difference(ProjectedFrozen(law, u1, center, e, l0), ProjectedFrozen(law, u2, center, e, l0));
  double power = 0;
  for (int r = 0; r < Law::kRows; ++r) power += dl[At(r)] * (u1[At(r)] - u2[At(r)]);
  EXPECT_LE(power, 1e-15 / e);
}

/// Checks that A dl + S du = r is Newton's equation of NewtonFunction: row by row equal up to a
/// factor. Returns false next to a kink.
template <class Law>
bool CheckLinearize(const Law& law, const RowsOf<Law>& u, const RowsOf<Law>& l, double e) {
  constexpr int R = Law::kRows;
  const auto of_l = [&](const RowsOf<Law>& at) { return NewtonFunction(law, u, at, l, e); };
  const auto of_u = [&](const RowsOf<Law>& at) { return NewtonFunction(law, at, l, l, e); };
  if (HasKink(of_l, l, kStep, 1.0) || HasKink(of_u, u, kStep, 1.0)) return false;
  sim::LinearLaw<Num, R> linear;
  law.Linearize(law.BranchOf(Packed(u), Packed(l)), Packed(u), Packed(l), Num::Splat(e), linear);
  const auto f = of_l(l);
  const auto by_l = Differences(of_l, l, kStep), by_u = Differences(of_u, u, kStep);
  for (int i = 0; i < R; ++i) {
    std::array<double, 2 * R + 1> mine, wanted;
    for (int j = 0; j < R; ++j) {
      mine[At(j)] = linear.A[i][j][0], mine[At(R + j)] = linear.S[i][j][0];
      wanted[At(j)] = by_l[At(i)][At(j)], wanted[At(R + j)] = by_u[At(i)][At(j)];
    }
    mine[2 * R] = linear.r[i][0], wanted[2 * R] = -f[At(i)];
    // The factor equates the largest derivatives.
    const auto largest = std::max_element(wanted.begin(), wanted.end() - 1, [](double a, double b) {
      return std::abs(a) < std::abs(b);
    });
    const double factor = mine[static_cast<std::size_t>(largest - wanted.begin())] / *largest;
    EXPECT_GT(factor, 0.01);
    EXPECT_LT(factor, 100);
    for (int k = 0; k <= 2 * R; ++k) {
      EXPECT_NEAR(mine[At(k)], factor * wanted[At(k)], 1e-7 * factor) << "row " << i << ", " << k;
    }
  }
  return true;
}

/// Returns J M^-1 J^T of the law's links, from their directions and levers.
template <class Law>
Matrix<Law::kRows> InverseMassOf(const Law& law) {
  Num sum[Law::kRows * Law::kRows] = {};
  for (int i = 0; i < law.link_count; ++i) sim::AddCoupling(law.links[i], law.links[i], sum);
  Matrix<Law::kRows> out{};
  for (int i = 0; i < Law::kRows; ++i) {
    for (int j = 0; j < Law::kRows; ++j) out[At(i)][At(j)] = sum[Law::kRows * i + j][0];
  }
  return out;
}

/// Returns the impulses of SolveAlone from u0, l0, and the velocities that they cause.
template <class Law>
std::array<RowsOf<Law>, 2> SolvedAlone(const Law& law, RowsOf<Law> u, const RowsOf<Law>& l0) {
  Packed<Law::kRows> l(l0);
  law.SolveAlone(Packed(u), l);
  const auto w = InverseMassOf(law);
  const auto change = Difference(l.Plain(), l0);
  for (int i = 0; i < Law::kRows; ++i) {
    for (int j = 0; j < Law::kRows; ++j) u[At(i)] += w[At(i)][At(j)] * change[At(j)];
  }
  return {u, l.Plain()};
}

template <class Law>
RowsOf<Law> Clamped(const Law& law, const RowsOf<Law>& from) {
  Packed<Law::kRows> l(from);
  law.Clamp(l);
  return l.Plain();
}

/// Returns random rows in [-size, size].
template <int R>
Rows<R> RandomRows(math::Random& random, double size = 1) {
  Rows<R> x;
  for (double& y : x) y = random.Uniform(-size, size);
  return x;
}

}  // namespace taut::test
