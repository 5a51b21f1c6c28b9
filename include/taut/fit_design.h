/// Optimal experimental design: ranking of candidate measurements by their information about the
/// parameters (docs/theory/identification.md, section 7). Pure functions; any thread.
#pragma once

#include <string>
#include <vector>

#include "taut/fit.h"

namespace taut {

/// Candidate: a set of values that would be measured together (channels, an experiment, a
/// statistic).
struct DesignCandidate {
  std::string name;
  /// d channel / d parameter in the channel's unit per parameter's unit, row-major: channel i and
  /// parameter j at i * parameters + j. Rows with NaN (not computable) are ignored.
  std::vector<double> jacobian;
  std::vector<double> sd;  ///< Of each row, in the channel's unit, > 0.
};

/// Information in a set of measurements.
struct DesignWorth {
  std::string name;
  /// Number of independent combinations of parameters whose prior sd (without a prior: scale) the
  /// measurements at least halve: singular values >= sqrt(3) of the scaled Jacobian.
  int fixed = 0;
  /// log det (I + J^T J) / 2: information gain over the priors in nats (Bayesian D-optimality, eq.
  /// F.16).
  double information = 0;
  /// Posterior sd / prior sd (or scale) of each parameter, 0 to 1.
  std::vector<double> sd_ratio;
};

struct DesignRanking {
  std::vector<std::string> wrong;  ///< Errors of the input; if any, all else is empty.
  DesignWorth now;                 ///< Worth of `base`.
  std::vector<DesignWorth> alone;  ///< Each candidate with `base`, in the candidates' order.
  /// Greedy ranking, best first: each candidate adds the most information to `base` and the
  /// previous candidates (the first of equal ones). Each worth is cumulative.
  std::vector<DesignWorth> greedy;
  std::vector<std::size_t> order;  ///< Indices of the candidates in the order of `greedy`.
  std::vector<std::string> sentences;
};

/// Ranks candidate measurements. `base`: existing measurements; may be empty.
DesignRanking RankDesigns(const std::vector<FitParameter>& parameters, const DesignCandidate& base,
                          const std::vector<DesignCandidate>& candidates);

}  // namespace taut
