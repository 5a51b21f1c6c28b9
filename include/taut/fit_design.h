/// What to measure next: candidates for measurements, ranked by what they would tell about
/// parameters. Docs: docs/theory/identification.md, section 7. Pure functions; any thread.
#pragma once

#include <string>
#include <vector>

#include "taut/fit.h"

namespace taut {

/// Channels, an experiment, a statistic: what would be measured together.
struct DesignCandidate {
  std::string name;
  /// d channel / d parameter in the channel's unit a parameter's unit, row by row: channel i of
  /// parameter j stands at i * parameters + j. NaN where it could not be computed: the row is left
  /// out.
  std::vector<double> jacobian;
  std::vector<double> sd;  ///< Of each row, in the channel's unit, > 0.
};

/// What a set of measurements tells.
struct DesignWorth {
  std::string name;
  /// Independent combinations of parameters whose prior sd (without a prior: scale) the
  /// measurements at least halve: singular values of the scaled Jacobian of sqrt(3) and more.
  int fixed = 0;
  /// log det (I + J^T J) / 2: the information in nats over the priors (Bayesian D-optimality).
  double information = 0;
  /// Of each parameter, posterior sd over prior sd (or scale), 0 to 1.
  std::vector<double> sd_ratio;
};

struct DesignRanking {
  std::vector<std::string> wrong;  ///< Mistakes of the input; then all else is empty.
  DesignWorth now;                 ///< What is measured already, `base`.
  std::vector<DesignWorth> alone;  ///< Each candidate with `base`, in the candidates' order.
  /// Best first: each the one that adds most information to those before it and to `base`; its
  /// worth is that of all together. Of equal ones the first.
  std::vector<DesignWorth> greedy;
  std::vector<std::size_t> order;  ///< The candidates' numbers in that order.
  std::vector<std::string> sentences;
};

/// `base`: what is measured anyhow; may be empty.
DesignRanking RankDesigns(const std::vector<FitParameter>& parameters, const DesignCandidate& base,
                          const std::vector<DesignCandidate>& candidates);

}  // namespace taut
