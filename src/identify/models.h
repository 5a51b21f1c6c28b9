/// Forward models of a fit. They compute experiments for given parameter values, in parallel and
/// with a cache.
#pragma once

#include <atomic>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/thread_pool.h"
#include "identify/computed.h"
#include "taut/fit_spec.h"
#include "taut/identify.h"

namespace taut::identify {

/// Experiments with the same file, forward method and parameters share one model. Not thread-safe.
class Models {
 public:
  Models(const FitSpec& spec, int threads, const std::atomic<bool>* stop);

  /// Returns the index of the model of an experiment.
  std::size_t ModelOf(std::size_t experiment) const { return of_[experiment]; }
  /// Requests a channel and returns its index among the model's channels. Call this before
  /// `Compute`.
  std::size_t Need(std::size_t model, const std::string& channel);
  /// Requests the equilibrium at a time [s]. Call this before `Compute`.
  void NeedMoment(std::size_t model, double time_s);

  const std::vector<double>& Moments(std::size_t model) const { return models_[model].moments_s; }

  using Answer = std::shared_ptr<const Computed>;
  /// Computes `models` at each point in parallel. A point has the values of all estimates of the
  /// fit. Returns one map from model to answer per point, and caches recent answers. Returns an
  /// empty vector if stopped, or if a file has become unreadable (`input_error`).
  std::vector<std::map<std::size_t, Answer>> Compute(const std::vector<std::vector<double>>& points,
                                                     const std::set<std::size_t>& models);

  /// Computes serialized jobs (an experiment with its values) on the threads of this process. If
  /// `spread` is set, `Compute` uses it instead, to distribute jobs over processes with identical
  /// answers.
  std::vector<std::string> Do(std::span<const std::string> pieces);
  void SpreadBy(FitWork spread) { spread_ = std::move(spread); }
  /// Returns all definitions that affect jobs and answers, so that processes can compare them.
  std::string Meaning() const;

  std::int64_t computed() const { return computed_; }
  const std::string& input_error() const { return input_error_; }
  int threads() const { return pool_.threads(); }

 private:
  struct Model {
    std::size_t experiment = 0;           ///< One of the experiments that share this model.
    std::vector<std::size_t> parameters;  ///< Estimates that affect this model.
    std::vector<std::string> channels;
    std::vector<double> moments_s;  ///< Times of equilibria, increasing.
  };
  using Job = std::pair<std::size_t, Overrides>;
  Overrides At(const Model& model, const std::vector<double>& point) const;
  Answer ComputeOne(const Job& job) const;
  std::vector<Answer> ComputeAll(const std::vector<Job>& jobs);
  std::vector<Answer> ComputeSpread(const std::vector<Job>& jobs) const;
  void Remember(const std::string& key, const Answer& answer);

  const FitSpec& spec_;
  const std::atomic<bool>* stop_;
  base::ThreadPool pool_;
  FitWork spread_;
  std::vector<Model> models_;
  std::vector<std::size_t> of_;  ///< Index of the model, per experiment.
  std::map<std::string, Answer> lately_;
  std::deque<std::string> order_;  ///< Keys of `lately_`, oldest first.
  std::int64_t computed_ = 0;
  std::string input_error_;
};

}  // namespace taut::identify
