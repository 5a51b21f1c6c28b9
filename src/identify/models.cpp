#include "identify/models.h"

#include <algorithm>

#include "base/bytes.h"
#include "description/yaml/reader.h"

namespace taut::identify {
namespace {

/// Limit of cached results. With the cache, Jacobian columns of parameters that affect only
/// measurement offsets need no simulation.
constexpr std::size_t kMostKept = 256;

bool ActsOn(const FitEstimate& e, std::size_t experiment) {
  return e.kind == FitEstimate::Kind::kParameter &&
         std::find(e.experiments.begin(), e.experiments.end(), experiment) != e.experiments.end();
}

std::string Pack(const std::pair<std::size_t, Overrides>& job) {
  base::ByteWriter out;
  out.Put(job.first);
  out.Put(job.second.size());
  for (const auto& [name, value] : job.second) {
    out.Put(name);
    out.Put(value);
  }
  return std::move(out.bytes);
}

std::pair<std::size_t, Overrides> UnpackJob(const std::string& piece) {
  base::ByteReader in(piece);
  std::pair<std::size_t, Overrides> job;
  in.Get(job.first);
  job.second.resize(in.Size());
  for (auto& [name, value] : job.second) {
    in.Get(name);
    in.Get(value);
  }
  return job;
}

std::string Text(const Overrides& overrides) {
  std::string out;
  for (const auto& [name, value] : overrides) out += name + "=" + value + "\n";
  return out;
}

}  // namespace

Models::Models(const FitSpec& spec, int threads, const std::atomic<bool>* stop)
    : spec_(spec), stop_(stop), pool_(threads) {
  std::map<std::string, std::size_t> known;
  for (std::size_t e = 0; e < spec.experiments.size(); ++e) {
    const FitExperiment& one = spec.experiments[e];
    Model model{e, {}, {}, {}};
    std::string key = one.experiment_file + "\n" + std::to_string(static_cast<int>(one.forward)) +
                      "\n" + Text(one.set);
    for (std::size_t i = 0; i < spec.estimates.size(); ++i) {
      if (!ActsOn(spec.estimates[i], e)) continue;
      model.parameters.push_back(i);
      key += std::to_string(i) + " ";
    }
    const auto [at, fresh] = known.emplace(key, models_.size());
    if (fresh) models_.push_back(std::move(model));
    of_.push_back(at->second);
  }
}

std::size_t Models::Need(std::size_t model, const std::string& channel) {
  std::vector<std::string>& channels = models_[model].channels;
  const auto at = std::find(channels.begin(), channels.end(), channel);
  if (at != channels.end()) return static_cast<std::size_t>(at - channels.begin());
  channels.push_back(channel);
  return channels.size() - 1;
}

void Models::NeedMoment(std::size_t model, double time_s) {
  std::vector<double>& moments_s = models_[model].moments_s;
  const auto at = std::lower_bound(moments_s.begin(), moments_s.end(), time_s - 1e-9);
  if (at == moments_s.end() || *at > time_s + 1e-9) moments_s.insert(at, time_s);
}

Overrides Models::At(const Model& model, const std::vector<double>& point) const {
  Overrides out = spec_.experiments[model.experiment].set;
  for (const std::size_t i : model.parameters) {
    out.emplace_back(spec_.estimates[i].parameter, description::Shown(point[i]));
  }
  return out;
}

Models::Answer Models::ComputeOne(const Job& job) const {
  const Model& model = models_[job.first];
  const FitExperiment& one = spec_.experiments[model.experiment];
  Diagnostics found;
  const auto experiment = LoadExperiment(one.experiment_file, job.second, found);
  if (!experiment) {
    Computed out;
    // All files were readable when the fit began, so the parameter values are not the cause.
    const auto& errors = found.items();
    const auto unreadable = std::find_if(errors.begin(), errors.end(),
                                         [](const Diagnostic& error) { return error.unreadable; });
    if (unreadable != errors.end()) {
      out.unreadable = unreadable->at.file + ": " + unreadable->what;
    } else {
      out.failed = errors.empty() ? "the experiment cannot be read" : errors[0].what;
    }
    return std::make_shared<const Computed>(std::move(out));
  }
  return std::make_shared<const Computed>(
      one.forward == FitForward::kDynamic
          ? Run(*experiment, model.channels, stop_)
          : Rest(*experiment, one.forward, model.moments_s, model.channels, stop_));
}

std::vector<Models::Answer> Models::ComputeAll(const std::vector<Job>& jobs) {
  std::vector<Answer> made(jobs.size());
  auto work = [&](int, std::size_t i) {
    if (!stop_ || !*stop_) made[i] = ComputeOne(jobs[i]);
  };
  if (!jobs.empty()) pool_.ForEach(jobs.size(), work);
  return made;
}

std::vector<Models::Answer> Models::ComputeSpread(const std::vector<Job>& jobs) const {
  std::vector<std::string> pieces;
  for (const Job& job : jobs) pieces.push_back(Pack(job));
  std::vector<Answer> made(jobs.size());
  if (jobs.empty()) return made;
  const std::vector<std::string> answers = spread_(pieces);
  if (answers.size() != jobs.size()) return made;  // the computation was stopped
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    made[i] = std::make_shared<const Computed>(UnpackComputed(answers[i]));
  }
  return made;
}

std::vector<std::string> Models::Do(std::span<const std::string> pieces) {
  std::vector<Job> jobs;
  for (const std::string& piece : pieces) jobs.push_back(UnpackJob(piece));
  std::vector<std::string> answers;
  for (const Answer& answer : ComputeAll(jobs)) {
    if (!answer || answer->stopped) return {};
    answers.push_back(Pack(*answer));
  }
  return answers;
}

std::string Models::Meaning() const {
  std::string out;
  for (const Model& model : models_) {
    out += "model " + std::to_string(model.experiment) + "\n";
    for (const std::size_t i : model.parameters) out += spec_.estimates[i].name + "\n";
    for (const std::string& channel : model.channels) out += channel + "\n";
    for (const double moment_s : model.moments_s) out += description::Shown(moment_s) + "\n";
  }
  return out;
}

void Models::Remember(const std::string& key, const Answer& answer) {
  if (!lately_.emplace(key, answer).second) return;
  order_.push_back(key);
  if (order_.size() <= kMostKept) return;
  lately_.erase(order_.front());
  order_.pop_front();
}

std::vector<std::map<std::size_t, Models::Answer>> Models::Compute(
    const std::vector<std::vector<double>>& points, const std::set<std::size_t>& models) {
  if (!input_error_.empty()) return {};
  std::map<std::string, Answer> answers;
  std::vector<std::pair<std::string, Job>> jobs;
  std::vector<std::map<std::size_t, std::string>> keys(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (const std::size_t m : models) {
      Job job{m, At(models_[m], points[p])};
      const std::string key = std::to_string(m) + "\n" + Text(job.second);
      keys[p][m] = key;
      const auto known = lately_.find(key);
      const bool fresh =
          answers.emplace(key, known == lately_.end() ? nullptr : known->second).second;
      if (fresh && known == lately_.end()) jobs.emplace_back(key, std::move(job));
    }
  }
  std::vector<Job> plain;
  for (const auto& [key, job] : jobs) plain.push_back(job);
  const std::vector<Answer> made = spread_ ? ComputeSpread(plain) : ComputeAll(plain);
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (made[i] && !made[i]->unreadable.empty()) input_error_ = made[i]->unreadable;
    if (!made[i] || made[i]->stopped || !input_error_.empty()) return {};
    ++computed_;
    answers[jobs[i].first] = made[i];
    Remember(jobs[i].first, made[i]);
  }
  std::vector<std::map<std::size_t, Answer>> out(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (const auto& [m, key] : keys[p]) out[p][m] = answers[key];
  }
  return out;
}

}  // namespace taut::identify
