// Fuzz target of fit files, in a folder with small experiments and measurements.
#include "fuzz/refusals.h"
#include "fuzz/small_folder.h"
#include "fuzz/text_input.h"
#include "taut/fit_spec.h"

namespace {

using taut::FitSpec;
using taut::fuzz::Must;

void CheckExperiments(const std::vector<std::size_t>& indices, const FitSpec& fit,
                      const std::string& what) {
  for (const std::size_t index : indices) {
    Must(index < fit.experiments.size(), "experiment of " + what);
  }
}

void CheckFit(const FitSpec& fit) {
  Must(!fit.experiments.empty() && !fit.estimates.empty() && !fit.residuals.empty(),
       "something to fit");
  for (const taut::FitEstimate& one : fit.estimates) {
    CheckExperiments(one.experiments, fit, one.name);
    const taut::FitRange& range = one.range;
    Must(range.scale > 0, "a scale of " + one.name);
    Must(range.low <= range.start && range.start <= range.high, "start of " + one.name);
  }
  for (const taut::FitResidual& one : fit.residuals) {
    CheckExperiments(one.experiments, fit, one.channels);
    Must(one.sd > 0 && one.relative_sd >= 0, "sd of " + one.channels);
  }
  for (const taut::FitCandidate& candidate : fit.design) {
    for (const auto& one : candidate.residuals) {
      CheckExperiments(one.experiments, fit, candidate.name);
    }
  }
  for (const taut::FitCarried& one : fit.carried) CheckExperiments(one.experiments, fit, one.name);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const taut::fuzz::SmallFolder folder;
  const std::string path = folder.Write("fits/input.yaml", data, size);
  taut::Diagnostics out;
  const auto fit = LoadFit(path, {}, out);
  taut::fuzz::CheckReading(fit.has_value(), out);
  if (!fit) return 0;
  CheckFit(*fit);
  if (!taut::fuzz::OneIn(8, data, size)) return 0;
  taut::Diagnostics ignored;
  const auto again = LoadFit(path, {}, ignored);
  Must(again && FitText(*again) == FitText(*fit), "the same text twice");
  return 0;
}
