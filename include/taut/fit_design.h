/// Optimal experimental design: ranks candidate measurements by their information about the
/// parameters (docs/theory/identification.md, section 7). Pure functions, thread safe.
#pragma once

#include <string>
#include <vector>

#include "taut/fit.h"

namespace taut {

/// Candidate: values measured together, such as channels, an experiment or a statistic.
struct DesignCandidate {
  std::string name;
  /// d channel / d parameter in their units, row-major: channel i and parameter j at i * parameters
  /// + j. Rows with NaN (not computable) are ignored.
  std::vector<double> jacobian;
  std::vector<double> sd;  ///< Standard deviation of each row, in the unit of the channel, > 0.
};

/// Information content of a set of measurements.
struct DesignWorth {
  std::string name;
  /// Number of independent parameter combinations whose prior sd (without a prior: scale) the
  /// measurements at least halve. Criterion: singular value of the scaled Jacobian >= sqrt(3).
  int fixed = 0;
  /// Information gain over the priors in nats: log det (I + J^T J) / 2 (Bayesian D-optimality, eq.
  /// F.16).
  double information = 0;
  /// Posterior sd / prior sd (without a prior: / scale) of each parameter, 0 to 1.
  std::vector<double> sd_ratio;
};

struct DesignRanking {
  std::vector<std::string> wrong;  ///< Errors of the input; if any, everything else is empty.
  DesignWorth now;                 ///< Worth of `base`.
  /// Worth of each candidate together with `base`, in order of the candidates.
  std::vector<DesignWorth> alone;
  /// Greedy ranking, best first: each next candidate adds the most information to `base` and the
  /// previous candidates; the first one if equal. Each worth is cumulative.
  std::vector<DesignWorth> greedy;
  std::vector<std::size_t> order;  ///< Indices of the candidates in the order of `greedy`.
  std::vector<std::string> sentences;
};

/// Ranks candidate measurements. `base`: existing measurements, may be empty.
DesignRanking RankDesigns(const std::vector<FitParameter>& parameters, const DesignCandidate& base,
                          const std::vector<DesignCandidate>& candidates);

}  // namespace taut
