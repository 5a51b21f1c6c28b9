#include "fit/differences.h"

#include <algorithm>
#include <cmath>

namespace taut::fit {
namespace {

/// Thresholds of a kink: disagreement between the two step sizes (eq. F.9), relative to the slope
/// and in residuals per scale.
constexpr double kKinkShare = 0.05, kKinkLeast = 0.05;

bool Usable(const Residuals& answer) { return answer.failed.empty(); }

std::vector<double> Secant(double x1, const std::vector<double>& f1, double x0,
                           const std::vector<double>& f0) {
  std::vector<double> slope(f1.size());
  for (std::size_t i = 0; i < f1.size(); ++i) slope[i] = (f1[i] - f0[i]) / (x1 - x0);
  return slope;
}

/// Returns a + factor (a - b).
std::vector<double> Beyond(std::vector<double> a, const std::vector<double>& b, double factor) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += factor * (a[i] - b[i]);
  return a;
}

double Norm(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

double Distance(const std::vector<double>& a, const std::vector<double>& b, double factor = 1.0) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - factor * b[i]) * (a[i] - factor * b[i]);
  return std::sqrt(sum);
}

/// Slopes for both step sizes, each of second order, and the second differences.
struct TwoSizes {
  std::vector<double> wide, narrow;
  std::vector<double> bend_wide, bend_narrow;  ///< h f''; empty for one-sided stencils.
};

/// Computes the slope (f(+h) - f(-h)) / 2h and the bend (f(+h) - 2 f + f(-h)) / h.
void Central(double up, const std::vector<double>& f_up, double down,
             const std::vector<double>& f_down, const std::vector<double>& f,
             std::vector<double>& slope, std::vector<double>& bend) {
  slope = Secant(up, f_up, down, f_down);
  const double h = 0.5 * (up - down);
  bend.resize(f.size());
  for (std::size_t i = 0; i < f.size(); ++i) bend[i] = (f_up[i] - 2.0 * f[i] + f_down[i]) / h;
}

TwoSizes Both(const Stencil& s, double value, const std::vector<double>& f,
              std::span<const Residuals> a) {
  TwoSizes sizes;
  if (s.central) {
    Central(s.at[0], a[0].value, s.at[1], a[1].value, f, sizes.wide, sizes.bend_wide);
    Central(s.at[2], a[2].value, s.at[3], a[3].value, f, sizes.narrow, sizes.bend_narrow);
  } else {
    const auto whole = Secant(s.at[0], a[0].value, value, f);
    const auto half = Secant(s.at[1], a[1].value, value, f);
    const auto quarter = Secant(s.at[2], a[2].value, value, f);
    sizes.wide = Beyond(half, whole, 1.0);
    sizes.narrow = Beyond(quarter, half, 1.0);
  }
  return sizes;
}

}  // namespace

Stencil MakeStencil(const FitProblem& problem, const std::vector<double>& values,
                    std::size_t parameter, bool both_sizes, double share) {
  const FitParameter& p = problem.parameters[parameter];
  const double value = values[parameter];
  const double up = p.high - value, down = value - p.low;
  double h = share * p.step * FitScale(p);
  Stencil stencil;
  stencil.parameter = parameter;
  stencil.central = std::min(up, down) >= 0.25 * h;
  if (stencil.central) {
    h = std::min(h, std::min(up, down));
    stencil.at = {std::min(value + h, p.high), std::max(value - h, p.low)};
    if (both_sizes) stencil.at.insert(stencil.at.end(), {value + 0.5 * h, value - 0.5 * h});
  } else {
    h = up >= down ? std::min(h, up) : -std::min(h, down);
    stencil.at = {std::clamp(value + h, p.low, p.high), value + 0.5 * h};
    if (both_sizes) stencil.at.push_back(value + 0.25 * h);
  }
  return stencil;
}

void AddPoints(const Stencil& stencil, const std::vector<double>& values,
               std::vector<std::vector<double>>& points) {
  for (const double at : stencil.at) points.emplace_back(values)[stencil.parameter] = at;
}

std::vector<double> Slope(const Stencil& s, double value, const std::vector<double>& residual,
                          std::span<const Residuals> answers) {
  if (Usable(answers[0]) && Usable(answers[1])) {
    if (s.central) return Secant(s.at[0], answers[0].value, s.at[1], answers[1].value);
    const auto whole = Secant(s.at[0], answers[0].value, value, residual);
    return Beyond(Secant(s.at[1], answers[1].value, value, residual), whole, 1.0);
  }
  for (std::size_t k = 0; k < answers.size(); ++k) {
    if (Usable(answers[k])) return Secant(s.at[k], answers[k].value, value, residual);
  }
  return std::vector<double>(residual.size(), 0.0);
}

FitColumn CheckedColumn(const Stencil& s, double value, double scale,
                        const std::vector<double>& residual, std::span<const Residuals> answers) {
  FitColumn column;
  for (const Residuals& answer : answers) {
    if (!Usable(answer) && column.failed.empty()) column.failed = answer.failed;
  }
  if (!column.failed.empty()) {
    // If points are missing, skip the check. Use the slope of the narrow stencil if possible.
    const bool narrow = s.central && Usable(answers[2]) && Usable(answers[3]);
    column.slope = narrow ? Secant(s.at[2], answers[2].value, s.at[3], answers[3].value)
                          : Slope(s, value, residual, answers);
    return column;
  }
  const TwoSizes sizes = Both(s, value, residual, answers);
  // Richardson extrapolation of two second-order slopes: order four for central stencils, three for
  // one-sided ones.
  column.slope = Beyond(sizes.narrow, sizes.wide, 1.0 / 3.0);
  column.error = scale * Distance(sizes.narrow, sizes.wide);
  double odd = column.error, even = 0;
  double size = scale * std::max(Norm(sizes.narrow), Norm(sizes.wide));
  if (s.central) {
    even = scale * Distance(sizes.bend_narrow, sizes.bend_wide, 0.5);
    column.curved = scale * Norm(sizes.bend_wide);
    size = std::max(size, 0.5 * column.curved);
  } else {
    const auto half = Secant(s.at[1], answers[1].value, value, residual);
    column.curved =
        2.0 * scale * Distance(half, Secant(s.at[0], answers[0].value, value, residual));
  }
  const double apart = std::sqrt(odd * odd + even * even);
  column.kink_share = size > 0 ? apart / size : 0.0;
  column.kink = column.kink_share > kKinkShare && apart > kKinkLeast;
  return column;
}

}  // namespace taut::fit
