// System identification: creates a fit problem from experiments, models and measured data.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "base/pattern.h"
#include "description/yaml/reader.h"
#include "identify/carried.h"
#include "identify/fit_memory.h"
#include "identify/models.h"
#include "identify/residual_rows.h"
#include "taut/version.h"

namespace taut {
namespace identify {
namespace {

/// Residual row with its model, channels and estimates.
struct Tied {
  Row row;
  std::size_t model = 0;
  RowChannels channels;
  std::vector<std::size_t> gains, offsets, delays;  ///< Indices of the row's estimates.
};

/// Rows of a problem, in the problem's order.
struct Set {
  std::string name;
  std::vector<Tied> rows;
  std::vector<FitPoint> points;
  std::set<std::size_t> models;
  FitProblem problem;
};

FitLoss ToLoss(RobustLoss loss) {
  if (loss == RobustLoss::kHuber) return FitLoss::kHuber;
  return loss == RobustLoss::kCauchy ? FitLoss::kCauchy : FitLoss::kSquare;
}

class Made : public Identification {
 public:
  Made(const FitSpec& spec, const IdentifyOptions& options)
      : spec_(spec), options_(options), models_(spec_, options.threads, options.stop) {}

  bool Begin(Diagnostics& out);

  const FitSpec& spec() const override { return spec_; }
  const std::vector<std::size_t>& estimates() const override { return estimates_; }
  const FitProblem& train() const override { return train_.problem; }
  const FitProblem* test() const override { return test_.rows.empty() ? nullptr : &test_.problem; }
  const std::vector<FitProblem>& design() const override { return designs_; }
  const std::vector<std::vector<FitPoint>>& design_points() const override {
    return design_points_;
  }
  const std::vector<FitPoint>& train_points() const override { return train_.points; }
  const std::vector<FitPoint>& test_points() const override { return test_.points; }
  const std::vector<double>& moments_s(std::size_t experiment) const override {
    return models_.Moments(models_.ModelOf(experiment));
  }
  std::vector<CarriedLoad> Carried() const override;
  std::vector<std::string> Do(std::span<const std::string> pieces) override {
    return models_.Do(pieces);
  }
  void SpreadBy(FitWork spread, int processes) override {
    models_.SpreadBy(std::move(spread));
    processes_ = processes;
  }
  std::string Agreed() const override;
  IdentifyCounts counts() const override {
    return {models_.computed(), memory_->remembered(), memory_->damaged()};
  }
  std::string memory_error() const override { return memory_->error(); }
  std::string input_error() const override { return models_.input_error(); }

 private:
  void AddRows(const FitResidual& residual, std::size_t experiment, const Measured* measured,
               Set& set, Diagnostics& out);
  void CheckActing(Diagnostics& out);
  std::vector<MeasuredForces> ForcesOf(std::size_t experiment) const;
  void ChooseEstimates();
  void MakeProblem(Set& set);
  int GroupOf(const Row& row, std::map<std::string, int>& known, FitProblem& problem) const;
  std::vector<Residuals> Answer(const Set& set, std::span<const std::vector<double>> points);
  Residuals Compose(const Set& set, const std::vector<double>& all,
                    const std::map<std::size_t, Models::Answer>& computed) const;
  std::vector<double> All(const std::vector<double>& values) const;
  /// Returns the facts that identify this fit. Stored points are reused only if they match.
  std::map<std::string, std::string> Facts() const;
  bool OpenMemory(Diagnostics& out);

  const FitSpec spec_;
  IdentifyOptions options_;
  Models models_;
  int processes_ = 1;
  std::unique_ptr<PointMemory> memory_;
  /// Channels that can be computed, per experiment.
  std::vector<std::vector<ChannelInfo>> channels_;
  std::vector<std::size_t> estimates_;
  Set train_, test_;
  std::vector<Set> design_sets_;
  std::vector<FitProblem> designs_;
  std::vector<std::vector<FitPoint>> design_points_;
};

void Made::AddRows(const FitResidual& residual, std::size_t experiment, const Measured* measured,
                   Set& set, Diagnostics& out) {
  for (Row& row : MakeRows(spec_, residual, experiment, measured, channels_[experiment], out)) {
    Tied& tied = set.rows.emplace_back();
    tied.model = models_.ModelOf(experiment);
    if (row.how == Row::How::kRest) models_.NeedMoment(tied.model, row.from_s);
    tied.channels = ChannelsOf(row, [&](const auto& c) { return models_.Need(tied.model, c); });
    for (std::size_t i = 0; i < spec_.estimates.size(); ++i) {
      const FitEstimate& e = spec_.estimates[i];
      if (std::find(e.experiments.begin(), e.experiments.end(), experiment) ==
          e.experiments.end()) {
        continue;
      }
      const bool fits = !e.channels.empty() && base::Fits(e.channels, row.channel);
      if (e.kind == FitEstimate::Kind::kGain && fits) tied.gains.push_back(i);
      if (e.kind == FitEstimate::Kind::kOffset && fits) tied.offsets.push_back(i);
      if (e.kind == FitEstimate::Kind::kDelay) tied.delays.push_back(i);
    }
    set.points.push_back(row.point);
    set.models.insert(tied.model);
    set.problem.rows.push_back(
        {0, ToLoss(residual.loss), residual.loss_sd > 0 ? residual.loss_sd : 1.345});
    tied.row = std::move(row);
  }
}

/// Reports offsets, gains and delays that affect no compared channel.
void Made::CheckActing(Diagnostics& out) {
  std::vector<bool> acts(spec_.estimates.size());
  std::set<std::string> names;
  for (const Set* set : {&train_, &test_}) {
    for (const Tied& tied : set->rows) {
      names.insert(tied.row.channel);
      for (const auto* list : {&tied.gains, &tied.offsets, &tied.delays}) {
        for (const std::size_t i : *list) acts[i] = true;
      }
    }
  }
  for (std::size_t i = 0; i < spec_.estimates.size(); ++i) {
    const FitEstimate& e = spec_.estimates[i];
    if (acts[i] || e.kind == FitEstimate::Kind::kParameter) continue;
    out.Error("estimate.compared_with_nothing", e.at,
              "estimate: no compared channel is affected by " + e.name,
              e.channels.empty() ? "" : DidYouMean(e.channels, {names.begin(), names.end()}));
  }
}

/// Returns the measurements that are compared at each equilibrium of an experiment.
std::vector<MeasuredForces> Made::ForcesOf(std::size_t experiment) const {
  std::vector<MeasuredForces> out;
  for (const Set* set : {&train_, &test_}) {
    for (const Tied& tied : set->rows) {
      const FitPoint& point = tied.row.point;
      if (point.experiment != experiment || tied.row.how == Row::How::kReference) continue;
      const double time =
          tied.row.how == Row::How::kRow ? static_cast<double>(tied.row.row + 1) : tied.row.from_s;
      auto at = std::find_if(out.begin(), out.end(), [&](const MeasuredForces& m) {
        return m.where == point.where && m.time == time;
      });
      if (at == out.end()) at = out.insert(at, {point.where, time, {}});
      at->by_channel[point.channel] = {point.measured, point.sd};
    }
  }
  return out;
}

std::vector<CarriedLoad> Made::Carried() const {
  std::vector<CarriedLoad> out;
  for (const FitCarried& asked : spec_.carried) {
    for (const std::size_t e : asked.experiments) {
      out.push_back(CarriedBy(asked, spec_.experiments[e], moments_s(e), ForcesOf(e)));
      out.back().experiment = e;
    }
  }
  return out;
}

/// Selects the estimates that affect training data. All other estimates keep their start values.
void Made::ChooseEstimates() {
  for (std::size_t i = 0; i < spec_.estimates.size(); ++i) {
    const auto& on = spec_.estimates[i].experiments;
    const bool trained = std::any_of(on.begin(), on.end(),
                                     [&](std::size_t e) { return spec_.experiments[e].train; });
    if (trained) estimates_.push_back(i);
  }
}

int Made::GroupOf(const Row& row, std::map<std::string, int>& known, FitProblem& problem) const {
  std::string name = spec_.experiments[row.experiment].name;
  if (spec_.groups == FitGroups::kChannel) name = row.channel;
  if (spec_.groups == FitGroups::kWindow) name += " " + row.point.where;
  const auto [at, fresh] = known.emplace(name, static_cast<int>(known.size()));
  if (fresh) problem.group_names.push_back(name);
  return at->second;
}

void Made::MakeProblem(Set& set) {
  FitProblem& problem = set.problem;
  for (const std::size_t i : estimates_) {
    const FitEstimate& e = spec_.estimates[i];
    FitParameter& p = problem.parameters.emplace_back();
    p.name = e.name, p.unit = e.unit == "1" ? "" : e.unit;
    p.start = e.range.start, p.low = e.range.low, p.high = e.range.high;
    if (e.range.sd) p.prior_sd = *e.range.sd;
    p.prior_mean = e.range.mean;
    p.scale = e.range.scale, p.step = spec_.search.step;
    p.nuisance = e.kind != FitEstimate::Kind::kParameter;
  }
  for (const FitExperiment& one : spec_.experiments) problem.experiment_names.push_back(one.name);
  std::map<std::string, int> groups;
  for (std::size_t i = 0; i < set.rows.size(); ++i) {
    problem.rows[i].group = GroupOf(set.rows[i].row, groups, problem);
    problem.rows[i].experiment = static_cast<int>(set.rows[i].row.experiment);
  }
  problem.forward = [this, &set](std::span<const std::vector<double>> points) {
    return Answer(set, points);
  };
}

std::vector<double> Made::All(const std::vector<double>& values) const {
  std::vector<double> all;
  for (const FitEstimate& e : spec_.estimates) all.push_back(e.range.start);
  for (std::size_t i = 0; i < estimates_.size(); ++i) all[estimates_[i]] = values[i];
  return all;
}

Residuals Made::Compose(const Set& set, const std::vector<double>& all,
                        const std::map<std::size_t, Models::Answer>& computed) const {
  Residuals out;
  const auto sum = [&](const std::vector<std::size_t>& which) {
    double total = 0;
    for (const std::size_t i : which) total += all[i];
    return total;
  };
  for (const Tied& tied : set.rows) {
    const FitExperiment& one = spec_.experiments[tied.row.experiment];
    const Computed& model = *computed.at(tied.model);
    if (!model.failed.empty()) return {{}, one.name + ": " + model.failed};
    const auto value = ValueOf(tied.row, model, tied.channels, sum(tied.delays));
    if (!value || !std::isfinite(*value)) {
      return {{}, one.name + ": no value of " + tied.row.channel + ", " + tied.row.point.where};
    }
    double x = *value;
    for (const std::size_t i : tied.gains) x *= all[i];
    x += sum(tied.offsets);
    out.value.push_back((x - tied.row.point.measured) / tied.row.point.sd);
  }
  return out;
}

std::vector<Residuals> Made::Answer(const Set& set, std::span<const std::vector<double>> points) {
  std::vector<std::string> keys;
  std::vector<std::vector<double>> missing;
  std::vector<std::string> missing_keys;
  for (const std::vector<double>& point : points) {
    keys.push_back(PointMemory::Key(set.name, point));
    if (memory_->Find(keys.back())) continue;
    if (std::find(missing_keys.begin(), missing_keys.end(), keys.back()) != missing_keys.end()) {
      continue;
    }
    missing.push_back(All(point));
    missing_keys.push_back(keys.back());
  }
  // Compute and store in parts, so that little is lost if the process is killed.
  const std::size_t part =
      4 * static_cast<std::size_t>(models_.threads()) * static_cast<std::size_t>(processes_);
  for (std::size_t from = 0; from < missing.size(); from += part) {
    const std::size_t to = std::min(from + part, missing.size());
    const auto at = [&](std::size_t i) { return missing.begin() + static_cast<std::ptrdiff_t>(i); };
    const auto answers = models_.Compute({at(from), at(to)}, set.models);
    if (answers.empty()) break;
    std::vector<std::pair<std::string, Residuals>> made;
    for (std::size_t i = from; i < to; ++i) {
      made.emplace_back(missing_keys[i], Compose(set, missing[i], answers[i - from]));
    }
    memory_->Add(made);
  }
  std::vector<Residuals> out;
  for (const std::string& key : keys) {
    const Residuals* known = memory_->Find(key);
    if (!known) break;
    out.push_back(*known);
  }
  return out;
}

std::map<std::string, std::string> Made::Facts() const {
  base::Fnv1a sum;
  for (const Set* set : {&train_, &test_}) {
    for (const FitPoint& p : set->points) {
      sum.AddText(p.channel), sum.AddText(p.where);
      sum.AddNumber(p.measured), sum.AddNumber(p.sd), sum.AddNumber(p.time_s);
    }
    for (const Tied& tied : set->rows) {
      if (tied.row.samples) tied.row.samples->AddTo(sum);
      if (tied.row.period > 0) sum.AddNumber(tied.row.period);
    }
  }
  std::uint64_t experiments = 0;
  for (const FitExperiment& one : spec_.experiments) {
    experiments = experiments * 31 + one.experiment.input_hash;
  }
  return {{"version", kVersion},
          {"fit", FitText(spec_)},
          {"data", base::HashText(sum.value())},
          {"experiments", base::HashText(experiments)}};
}

std::string Made::Agreed() const {
  std::string out;
  for (const auto& [name, value] : Facts()) out += name + ": " + value + "\n";
  return out + models_.Meaning();
}

bool Made::OpenMemory(Diagnostics& out) {
  memory_ = options_.memory_file.empty() ? std::make_unique<PointMemory>()
                                         : PointMemory::Open(options_.memory_file, Facts(), out);
  return memory_ != nullptr;
}

bool Made::Begin(Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  train_.name = "train", test_.name = "test";
  std::vector<std::optional<Measured>> measured;
  for (const FitExperiment& one : spec_.experiments) {
    channels_.push_back(one.forward == FitForward::kDynamic ? DynamicChannels(one.experiment)
                                                            : RestChannels(one.experiment));
    measured.push_back(ReadMeasured(one, out));
    if (one.forward != FitForward::kStatic) continue;
    const std::string why = WhyNoRest(one.experiment);
    if (!why.empty()) {
      out.Error("fit.no_rest", one.at,
                "experiments: " + one.name + " has no equilibrium at its set points: " + why,
                "use `forward: dynamic`");
    } else if (SetPoints(one.experiment).empty()) {
      out.Error("fit.no_setpoints", one.at, "experiments: " + one.name + " has no set points",
                "a set point is where a program of rest lengths or a push reaches a new value");
    }
  }
  for (const FitResidual& residual : spec_.residuals) {
    for (const std::size_t e : residual.experiments) {
      if (!measured[e]) continue;
      AddRows(residual, e, &*measured[e], spec_.experiments[e].train ? train_ : test_, out);
    }
  }
  if (out.items().size() != errors_before) return false;
  design_sets_.resize(spec_.design.size());
  for (std::size_t i = 0; i < spec_.design.size(); ++i) {
    design_sets_[i].name = "design " + spec_.design[i].name;
    for (const FitResidual& residual : spec_.design[i].residuals) {
      for (const std::size_t e : residual.experiments) {
        AddRows(residual, e, nullptr, design_sets_[i], out);
      }
    }
  }
  CheckActing(out);
  for (const FitCarried& asked : spec_.carried) {
    for (const std::size_t e : asked.experiments) {
      CheckCut(asked, spec_.experiments[e], ForcesOf(e), out);
    }
  }
  ChooseEstimates();
  std::size_t known = train_.rows.size();
  for (const std::size_t i : estimates_) known += spec_.estimates[i].range.sd ? 1 : 0;
  if (known < estimates_.size()) {
    out.Error(
        "fit.few_data", {spec_.files[0]},
        fmt::format("{} parameters cannot be estimated from {} data points and priors together",
                    estimates_.size(), known),
        "add priors with `sd` or data points, or estimate fewer parameters");
  }
  if (out.items().size() != errors_before || !OpenMemory(out)) return false;
  MakeProblem(train_);
  MakeProblem(test_);
  for (Set& set : design_sets_) {
    MakeProblem(set);
    designs_.push_back(set.problem);
    design_points_.push_back(set.points);
  }
  return true;
}

}  // namespace
}  // namespace identify

std::unique_ptr<Identification> Identification::Make(const FitSpec& spec,
                                                     const IdentifyOptions& options,
                                                     Diagnostics& out) {
  auto made = std::make_unique<identify::Made>(spec, options);
  if (!made->Begin(out)) return nullptr;
  return made;
}

}  // namespace taut
