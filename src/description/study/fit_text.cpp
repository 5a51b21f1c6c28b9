// Text that identifies a fit, to detect changes of its file.
#include <cmath>

#include "description/study/key_line.h"
#include "description/yaml/reader.h"
#include "taut/fit_spec.h"

namespace taut {
namespace {

using description::KeyLine, description::Shown;

std::string Of(const std::vector<std::size_t>& experiments) {
  std::string out = " of";
  for (const std::size_t e : experiments) out += " " + std::to_string(e);
  return out;
}

std::string Span(const std::optional<std::pair<double, double>>& span) {
  return span ? Shown(span->first) + ".." + Shown(span->second) : "none";
}

std::string ResidualLine(const FitResidual& r) {
  std::string out = r.channels.empty() ? "references" : r.channels;
  if (r.channels.empty()) {
    out += r.references ? " " + std::to_string(static_cast<int>(*r.references)) : " all";
  }
  out += " sd " + Shown(r.sd) + " or " + Shown(r.relative_sd) + " statistic " +
         std::to_string(static_cast<int>(r.statistic));
  out += " window " + r.phase.value_or("") + " " + Span(r.span_s) + " " + Span(r.after_setpoint_s);
  out += " loss " + std::to_string(static_cast<int>(r.loss)) + " " + Shown(r.loss_sd);
  return out + Of(r.experiments);
}

}  // namespace

std::string FitText(const FitSpec& fit) {
  std::string out = KeyLine("fit", fit.name);
  for (const FitExperiment& one : fit.experiments) {
    std::string set;
    for (const auto& [name, value] : one.set) set += " " + name + "=" + value;
    out +=
        KeyLine("experiment " + one.name, std::string(one.train ? "train" : "test") + " forward " +
                                              std::to_string(static_cast<int>(one.forward)) + set);
  }
  for (const FitEstimate& e : fit.estimates) {
    const FitRange& r = e.range;
    std::string text = Shown(r.low) + ".." + Shown(r.high) + " start " + Shown(r.start) +
                       " scale " + Shown(r.scale);
    if (r.sd) text += " prior " + Shown(r.mean.value_or(NAN)) + " sd " + Shown(*r.sd);
    out += KeyLine("estimate " + e.name, text + Of(e.experiments));
  }
  for (const FitResidual& r : fit.residuals) out += KeyLine("residual", ResidualLine(r));
  out += KeyLine("groups", std::to_string(static_cast<int>(fit.groups)));
  const FitSearch& s = fit.search;
  out += KeyLine("search", "starts " + std::to_string(s.starts) + " step " + Shown(s.step) +
                               " iterations " + std::to_string(s.iterations) + " tolerance " +
                               Shown(s.tolerance) + " folds " + std::to_string(s.folds) + " seed " +
                               std::to_string(s.seed));
  return out;
}

}  // namespace taut
