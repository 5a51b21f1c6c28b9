// Result of a fit as JSON.
#include <cmath>
#include <nlohmann/json.hpp>

#include "identify/labels.h"
#include "taut/version.h"

namespace taut {
namespace {

using namespace identify;  // NOLINT(google-build-using-namespace): only in this file
using Json = nlohmann::ordered_json;

Json Number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }
Json Numbers(const std::vector<double>& xs) {
  Json out = Json::array();
  for (const double x : xs) out.push_back(Number(x));
  return out;
}

Json Parameters(const Identification& fit, const FitOutcome& outcome) {
  Json out = Json::array();
  const FitProblem& problem = fit.train();
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    const FitParameter& p = problem.parameters[i];
    const ParameterVerdict& v = outcome.verdict.identifiability.parameters[i];
    Json confounded_with = Json::object();
    for (const auto& [which, change] : v.confounded_with) {
      confounded_with[problem.parameters[which].name] = Number(change);
    }
    out.push_back({{"name", p.name},
                   {"unit", p.unit},
                   {"start", p.start},
                   {"low", Number(p.low)},
                   {"high", Number(p.high)},
                   {"prior_sd", Number(p.prior_sd)},
                   {"value", v.value},
                   {"se", Number(v.se)},
                   {"se_jackknife", v.se_jackknife ? Number(*v.se_jackknife) : Json(nullptr)},
                   {"se_residuals", v.se_residuals ? Number(*v.se_residuals) : Json(nullptr)},
                   {"groups_apart", v.groups_apart},
                   {"contradictions", v.contradictions},
                   {"verdict", VerdictName(v.kind)},
                   {"pull", Number(v.pull)},
                   {"kink", v.kink},
                   {"confounded_with", confounded_with},
                   {"sentence", v.sentence}});
  }
  return out;
}

Json Errors(const std::vector<FitPoint>& points, const BeforeAfter& residuals) {
  Json out = Json::array();
  for (const ChannelErrors& e : ErrorsByChannel(points, residuals)) {
    out.push_back({{"channel", e.channel},
                   {"unit", e.unit},
                   {"data", e.count},
                   {"untuned_rms", Number(e.untuned)},
                   {"fitted_rms", Number(e.fitted)},
                   {"fitted_bias", Number(e.fitted_bias)}});
  }
  return out;
}

Json ByExperiment(const Identification& fit, const std::vector<FitPoint>& points,
                  const BeforeAfter& residuals) {
  Json out = Json::array();
  for (const ExperimentErrors& e : ErrorsByExperiment(fit.spec(), points, residuals)) {
    out.push_back({{"experiment", e.experiment},
                   {"data", e.count},
                   {"untuned_rms_sd", Number(e.untuned)},
                   {"fitted_rms_sd", Number(e.fitted)}});
  }
  return out;
}

Json Points(const Identification& fit, const std::vector<FitPoint>& points,
            const BeforeAfter& residuals) {
  Json out = Json::array();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const FitPoint& p = points[i];
    const auto computed = [&](const std::vector<double>& of) {
      return i < of.size() ? Number(p.measured + of[i] * p.sd) : Json(nullptr);
    };
    out.push_back({{"experiment", fit.spec().experiments[p.experiment].name},
                   {"channel", p.channel},
                   {"where", p.where},
                   {"time_s", p.time_s},
                   {"measured", p.measured},
                   {"sd", p.sd},
                   {"untuned", computed(residuals.untuned)},
                   {"fitted", computed(residuals.fitted)}});
  }
  return out;
}

/// Returns the ends of all starts of the search.
Json Starts(const FitOutcome& outcome) {
  Json out = Json::array();
  for (const FitTrack& track : outcome.fit.state.tracks) {
    const bool failed = track.end == FitEnd::kFailed;
    out.push_back({{"chi2", failed ? Json(nullptr) : Number(2 * track.cost)},
                   {"values", Numbers(track.values)},
                   {"iterations", track.iterations},
                   {"end", track.why}});
  }
  return out;
}

Json Of(const FitErrors& e) {
  return {{"data", e.count},
          {"untuned_rms_sd", Number(e.untuned)},
          {"fitted_rms_sd", Number(e.fitted)},
          {"failed", e.failed}};
}

Json Of(const ChiSquare& chi2) {
  return {{"value", Number(chi2.value)}, {"freedom", Number(chi2.freedom)}, {"p", Number(chi2.p)}};
}

Json Of(const DesignWorth& worth) {
  return {{"name", worth.name},
          {"fixed", worth.fixed},
          {"information_nats", Number(worth.information)},
          {"sd_ratio", Numbers(worth.sd_ratio)}};
}

Json Alone(const Identification& fit, const FitVerdict& v) {
  const std::vector<FitParameter>& parameters = fit.train().parameters;
  Json fits = Json::array(), tests = Json::array();
  for (const AloneFit& one : v.alone.fits) {
    Json values = Json::object();
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      if (!one.value[j]) continue;
      values[parameters[j].name] = {{"value", Number(*one.value[j])}, {"se", Number(*one.se[j])}};
    }
    fits.push_back(
        {{"experiment", fit.spec().experiments[static_cast<std::size_t>(one.experiment)].name},
         {"parameters", values}});
  }
  for (const Homogeneity& test : v.alone.tested) {
    tests.push_back({{"parameter", parameters[test.parameter].name},
                     {"chi2", Number(test.chi2)},
                     {"freedom", test.freedom},
                     {"p", Number(test.p)},
                     {"apart", test.apart},
                     {"sentence", test.sentence}});
  }
  return {{"fits", fits}, {"tests", tests}, {"why", v.alone.why}};
}

Json Aliases(const Identification& fit, const FitVerdict& v) {
  Json out = Json::array();
  for (const AliasTest& test : v.aliases) {
    Json changes = Json::object();
    for (std::size_t j = 0; j < test.change.size(); ++j) {
      changes[fit.train().parameters[j].name] = {{"change", Number(test.change[j])},
                                                 {"se_ratio", Number(test.se_ratio[j])}};
    }
    out.push_back({{"name", test.name},
                   {"unit", test.unit},
                   {"value", Number(test.value)},
                   {"se", Number(test.se)},
                   {"chi2_fall", Number(test.fall)},
                   {"p", Number(test.p)},
                   {"confounded", test.confounded},
                   {"parameters", changes},
                   {"sentence", test.sentence}});
  }
  return out;
}

Json Profiles(const Identification& fit, const FitOutcome& outcome) {
  Json out = Json::array();
  for (const FitProfile& p : outcome.profiles) {
    Json points = Json::array();
    for (const ProfilePoint& point : p.points) {
      points.push_back({{"value", point.value},
                        {"rise", Number(point.rise)},
                        {"values", Numbers(point.values)},
                        {"failed", point.failed}});
    }
    out.push_back({{"parameter", fit.train().parameters[p.parameter].name},
                   {"low", Number(p.low)},
                   {"high", Number(p.high)},
                   {"low_open", p.low_open},
                   {"high_open", p.high_open},
                   {"sentence", p.why.empty() ? p.sentence : p.why},
                   {"points", points}});
  }
  return out;
}

Json Of(const CarriedLoad& carried, const Identification& fit) {
  const ProportionCheck& check = carried.check;
  Json rows = Json::array();
  for (const CarriedLoad::Row& row : carried.rows) {
    rows.push_back({{"where", row.where},
                    {"applied_n", row.applied_n},
                    {"carried_n", row.carried_n},
                    {"sd_n", row.sd_n}});
  }
  const bool there = check.why.empty();
  return {{"name", carried.name},
          {"experiment", fit.spec().experiments[carried.experiment].name},
          {"share", there ? Number(check.slope) : Json(nullptr)},
          {"se", there ? Number(check.se) : Json(nullptr)},
          {"chi2", there ? Number(check.chi2) : Json(nullptr)},
          {"p", there ? Number(check.p) : Json(nullptr)},
          {"consistent", there ? Json(check.consistent) : Json(nullptr)},
          {"sentence", there ? check.sentence : check.why},
          {"rows", rows}};
}

}  // namespace

std::string OutcomeJson(const Identification& fit, const FitOutcome& outcome) {
  const FitVerdict& v = outcome.verdict;
  Json directions = Json::array();
  for (const FitDirection& d : v.identifiability.directions) {
    directions.push_back({{"singular", Number(d.singular)},
                          {"null", d.null},
                          {"fixed", d.fixed},
                          {"direction", Numbers(d.direction)}});
  }
  Json out{{"fit", fit.spec().name},
           {"taut_version", kVersion},
           {"judgement", WordOf(v.judgement)},
           {"rejected", v.rejected},
           {"unidentifiable", v.unidentifiable},
           {"contradiction", v.contradiction},
           {"unreliable", v.unreliable},
           {"worse_on_hold_out", v.worse},
           {"sentences", v.sentences},
           {"chi2", {{"data", Of(v.data)}, {"prior", Of(v.prior)}, {"total", Of(v.total)}}},
           {"starts", Starts(outcome)},
           {"parameters", Parameters(fit, outcome)},
           {"condition", Number(v.identifiability.condition)},
           {"combinations_fixed", v.identifiability.fixed},
           {"directions", directions},
           {"correlation", Numbers(v.identifiability.correlation)},
           {"train", Errors(fit.train_points(), outcome.train)},
           {"train_experiments", ByExperiment(fit, fit.train_points(), outcome.train)}};
  out["experiments_alone"] = Alone(fit, v);
  out["aliases"] = Aliases(fit, v);
  if (v.hold_out) {
    out["held_out"] = Errors(fit.test_points(), outcome.test);
    out["hold_out"] = Of(*v.hold_out);
    out["held_out_experiments"] = ByExperiment(fit, fit.test_points(), outcome.test);
  }
  if (v.cross_validation.why.empty() && !v.cross_validation.folds.empty()) {
    out["cross_validation"] = Of(v.cross_validation.all);
  }
  if (!outcome.carried.empty()) {
    out["carried"] = Json::array();
    for (const CarriedLoad& carried : outcome.carried) out["carried"].push_back(Of(carried, fit));
  }
  Json groups = Json::array();
  for (const GroupEffect& g : v.jackknife.groups) {
    groups.push_back({{"without", fit.train().group_names[static_cast<std::size_t>(g.group)]},
                      {"values", Numbers(g.values)}});
  }
  out["jackknife"] = groups;
  if (!outcome.profiles.empty()) out["profiles"] = Profiles(fit, outcome);
  if (outcome.design) {
    Json alone = Json::array(), greedy = Json::array();
    for (const DesignWorth& w : outcome.design->alone) alone.push_back(Of(w));
    for (const DesignWorth& w : outcome.design->greedy) greedy.push_back(Of(w));
    out["design"] = {{"now", Of(outcome.design->now)},
                     {"alone", alone},
                     {"greedy", greedy},
                     {"sentences", outcome.design->sentences}};
  }
  out["points"] = {{"train", Points(fit, fit.train_points(), outcome.train)},
                   {"test", Points(fit, fit.test_points(), outcome.test)}};
  return out.dump(1) + "\n";
}

}  // namespace taut
