// Comparison of a run with reference values.
#include "report/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/facts.h"

namespace taut::report {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

const char* Of(ReferenceSpec::Statistic statistic) {
  switch (statistic) {
    case ReferenceSpec::Statistic::kMean:
      return "mean";
    case ReferenceSpec::Statistic::kMin:
      return "min";
    case ReferenceSpec::Statistic::kMax:
      break;
  }
  return "max";
}

}  // namespace

std::string StatisticName(const ReferenceSpec& reference) { return Of(reference.statistic); }

std::string QuantityName(const ReferenceSpec& reference) {
  return reference.quantity == ReferenceSpec::Quantity::kElastic ? "elastic" : "tension";
}

double OurValue(const RunSummary& run, const ReferenceSpec& reference, int cable) {
  const CableSummary& found = run.cables[static_cast<std::size_t>(cable)];
  const CableSummary::Quantity& quantity =
      reference.quantity == ReferenceSpec::Quantity::kElastic ? found.elastic : found.tension;
  if (reference.phase.empty()) return quantity.max_n;
  for (std::size_t i = 0; i < run.phases.size() && i < quantity.phases.size(); ++i) {
    if (run.phases[i].name != reference.phase || !Complete(run, run.phases[i])) continue;
    const Range& range = quantity.phases[i];
    switch (reference.statistic) {
      case ReferenceSpec::Statistic::kMean:
        return range.mean;
      case ReferenceSpec::Statistic::kMin:
        return range.min;
      case ReferenceSpec::Statistic::kMax:
        return range.max;
    }
  }
  return kUnknown;
}

namespace {

std::string LargestDifference(const RunSummary& run, const ReferenceSpec& reference) {
  const ReferenceSpec::Value* worst = nullptr;
  double worst_share = -1;
  for (const ReferenceSpec::Value& value : reference.values) {
    const double share = std::fabs(OurValue(run, reference, value.cable) / value.force_n - 1);
    if (!(share > worst_share) || !std::isfinite(share)) continue;
    worst_share = share;
    worst = &value;
  }
  if (worst == nullptr) return "the run did not reach this phase";
  return fmt::format("largest difference {:.2f} %: {} {:.3f} N, reference {:.3f} N",
                     100 * worst_share, run.cables[static_cast<std::size_t>(worst->cable)].name,
                     OurValue(run, reference, worst->cable), worst->force_n);
}

/// Returns the source, quantity and phase of a comparison as text.
std::string SubjectOf(const ReferenceSpec& reference) {
  return fmt::format("compared with {}: {} {} of {} cables, {}", reference.source,
                     StatisticName(reference), QuantityName(reference), reference.values.size(),
                     reference.phase.empty() ? "whole run" : reference.phase);
}

}  // namespace

std::vector<std::string> ReferenceDifferences(const RunSummary& run) {
  std::vector<std::string> lines;
  for (const ReferenceSpec& reference : run.references) {
    lines.push_back(SubjectOf(reference) + ": " + LargestDifference(run, reference));
  }
  return lines;
}

std::string ReferenceLines(const RunSummary& run) {
  std::string out;
  for (const ReferenceSpec& reference : run.references) {
    out += "\n" + SubjectOf(reference) + "\n  " + LargestDifference(run, reference);
  }
  return out.empty() ? out : out + "\n";
}

}  // namespace taut::report
