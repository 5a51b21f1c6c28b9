// Consistency check of proportional measurements: regression slope through 0 and its error.
#include <algorithm>
#include <cmath>
#include <map>

#include "fit/format.h"
#include "taut/fit_verdict.h"

namespace taut {
namespace {

/// Weighted sums for a regression line through 0.
struct Sums {
  double xx = 0, xy = 0;
  void Add(const ProportionPoint& p) {
    const double w = 1 / (p.sd * p.sd);
    xx += w * p.expected * p.expected;
    xy += w * p.expected * p.measured;
  }
};

/// Returns the jackknife error of the slope, leaving out one group at a time. Returns 0 for fewer
/// than three groups.
double GroupError(const Sums& all, const std::map<int, Sums>& groups) {
  std::vector<double> slopes;
  for (const auto& [group, part] : groups) {
    if (all.xx - part.xx > 0) slopes.push_back((all.xy - part.xy) / (all.xx - part.xx));
  }
  if (slopes.size() < 3) return 0;
  const double count = static_cast<double>(slopes.size());
  double mean = 0, sum = 0;
  for (const double slope : slopes) mean += slope / count;
  for (const double slope : slopes) sum += (slope - mean) * (slope - mean);
  return std::sqrt((count - 1) / count * sum);
}

}  // namespace

ProportionCheck CheckProportion(std::span<const ProportionPoint> points, const std::string& what) {
  ProportionCheck check;
  check.count = points.size();
  Sums all;
  std::map<int, Sums> groups;
  for (const ProportionPoint& p : points) {
    if (!std::isfinite(p.expected) || !std::isfinite(p.measured) || !(p.sd > 0)) {
      check.why = "a point is not finite, or its standard deviation is not above 0";
      return check;
    }
    all.Add(p);
    groups[p.group].Add(p);
  }
  if (points.size() < 2 || !(all.xx > 0)) {
    check.why = "there are fewer than two points, or all expected values are 0";
    return check;
  }
  check.slope = all.xy / all.xx;
  for (const ProportionPoint& p : points) {
    const double r = (p.measured - check.slope * p.expected) / p.sd;
    check.chi2 += r * r;
  }
  const double freedom = static_cast<double>(points.size() - 1);
  check.p = ChiSquareTail(check.chi2, freedom);
  const double by_sd = 1 / std::sqrt(all.xx);
  check.se = std::max({by_sd, by_sd * std::sqrt(check.chi2 / freedom), GroupError(all, groups)});
  check.z = (check.slope - 1) / check.se;
  check.consistent = std::fabs(check.z) <= 3 && check.p >= 0.001;
  check.sentence = what + " " + fit::Brief(100 * check.slope) + " +- " +
                   fit::Brief(100 * check.se) + " % of the expected value: ";
  if (check.consistent) {
    check.sentence += "the data are consistent";
  } else if (std::fabs(check.z) > 3) {
    check.sentence += "the difference from 100 % is " + fit::Brief(std::fabs(check.z)) +
                      " standard errors, which no model of the robot can correct";
  } else {
    check.sentence += "the forces are not proportional (chi-square " + fit::Brief(check.chi2) +
                      " with " + fit::Brief(freedom) + " degrees of freedom)";
  }
  return check;
}

}  // namespace taut
