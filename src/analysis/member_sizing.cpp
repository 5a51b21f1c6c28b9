// Sizing of rods and cables: least mass for given yield, buckling and slenderness limits
// (docs/theory/inverse_statics.md, section 6).
#include "taut/member_sizing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace taut {
namespace {

class Checks {
 public:
  Checks(const SizingTask& task, Diagnostics& out)
      : task_(task), out_(out), before_(out.items().size()) {}
  void Positive(double value, const char* what) {
    if (value > 0 && std::isfinite(value)) return;
    out_.Error("sizing.not_positive", {}, task_.name + ": " + what + " must be a number above 0");
  }
  void True(bool holds, const char* what) {
    if (!holds) out_.Error("sizing.bad_task", {}, task_.name + ": " + what);
  }
  void Common() {
    Positive(task_.material.yield_pa, "the yield stress");
    Positive(task_.material.density_kg_per_m3, "the density");
    Positive(task_.length_m, "the length");
    Positive(task_.yield_factor, "the safety factor of yielding");
    True(std::all_of(task_.force_n.begin(), task_.force_n.end(),
                     [](double f) { return std::isfinite(f); }),
         "forces must be finite numbers");
  }
  bool ok() const { return out_.items().size() == before_; }

 private:
  const SizingTask& task_;
  Diagnostics& out_;
  std::size_t before_;
};

SizedMember OfRadius(const SizingTask& task, double radius_m, double inner_share) {
  const double c2 = inner_share * inner_share, r2 = radius_m * radius_m;
  SizedMember sized;
  sized.radius_m = radius_m;
  sized.member.area_m2 = std::numbers::pi * r2 * (1 - c2);
  sized.member.second_moment_m4 = 0.25 * std::numbers::pi * r2 * r2 * (1 - c2 * c2);
  sized.member.young_pa = task.material.young_pa;
  sized.member.yield_pa = task.material.yield_pa;
  sized.mass_kg = task.material.density_kg_per_m3 * sized.member.area_m2 * task.length_m;
  sized.member.mass_kg = sized.mass_kg;
  return sized;
}

/// Returns R from the yield condition pi R^2 (1 - c^2) yield = factor |N|.
double YieldRadius(const SizingTask& task, double inner_share) {
  double largest = 0;
  for (const double force : task.force_n) largest = std::max(largest, std::fabs(force));
  const double share = 1 - inner_share * inner_share;
  return std::sqrt(task.yield_factor * largest /
                   (std::numbers::pi * share * task.material.yield_pa));
}

}  // namespace

// Euler: pi^2 E I / l^2 = factor N with I = pi R^4 (1 - c^4) / 4; slenderness: l / i with i = R
// sqrt(1 + c^2) / 2.
std::optional<SizedMember> LightestRod(const SizingTask& task, Diagnostics& out) {
  Checks checks(task, out);
  checks.Common();
  checks.Positive(task.material.young_pa, "Young's modulus");
  checks.Positive(task.buckling_factor, "the safety factor of buckling");
  checks.True(task.buckling_length_m >= 0 && std::isfinite(task.buckling_length_m),
              "the buckling length must be a finite number of at least 0");
  checks.True(task.inner_radius_share >= 0 && task.inner_radius_share < 1,
              "the ratio of inner to outer radius must be at least 0 and below 1");
  if (task.slenderness) checks.Positive(*task.slenderness, "the slenderness");
  if (!checks.ok()) return std::nullopt;

  const double c2 = task.inner_radius_share * task.inner_radius_share;
  const double length = task.buckling_length_m > 0 ? task.buckling_length_m : task.length_m;
  double pressed = 0;
  for (const double force : task.force_n) pressed = std::max(pressed, -force);
  const double euler = std::pow(4 * task.buckling_factor * pressed * length * length /
                                    (std::numbers::pi * std::numbers::pi * std::numbers::pi *
                                     task.material.young_pa * (1 - c2 * c2)),
                                0.25);
  const double stout =
      task.slenderness ? 2 * length / (*task.slenderness * std::sqrt(1 + c2)) : 0.0;
  double radius = 0;
  SizingLimit limit = SizingLimit::kNothing;
  const auto take = [&](double least, SizingLimit what) {
    if (least > radius) radius = least, limit = what;
  };
  take(YieldRadius(task, task.inner_radius_share), SizingLimit::kYield);
  take(euler, SizingLimit::kBuckling);
  take(stout, SizingLimit::kSlenderness);
  SizedMember sized = OfRadius(task, radius, task.inner_radius_share);
  sized.member.buckling_length_m = length;
  sized.limit = limit;
  return sized;
}

std::optional<SizedMember> LightestCable(const SizingTask& task, Diagnostics& out) {
  Checks checks(task, out);
  checks.Common();
  checks.True(
      std::none_of(task.force_n.begin(), task.force_n.end(), [](double f) { return f < 0; }),
      "forces of a cable must not be compressive (negative)");
  if (!checks.ok()) return std::nullopt;
  SizedMember sized = OfRadius(task, YieldRadius(task, 0), 0);
  sized.member.second_moment_m4 = 0;  // a cable has no bending stiffness
  sized.member.strength_n = task.material.yield_pa * sized.member.area_m2;
  if (sized.radius_m > 0) sized.limit = SizingLimit::kYield;
  return sized;
}

}  // namespace taut
