/// Small problems for the tests of fitting
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "math/random.h"
#include "taut/fit.h"

namespace taut::test {

using Model = std::function<Residuals(const std::vector<double>&)>;

/// Evaluates points one after the other.
inline Forward Each(Model model) {
  return [model = std::move(model)](std::span<const std::vector<double>> points) {
    std::vector<Residuals> answers;
    for (const auto& point : points) answers.push_back(model(point));
    return answers;
  };
}

inline FitParameter Parameter(const std::string& name, double start, double scale = 1.0) {
  FitParameter p;
  p.name = name;
  p.start = start;
  p.scale = scale;
  return p;
}

inline FitProblem MakeProblem(std::vector<FitParameter> parameters, std::size_t rows, Model model) {
  FitProblem problem;
  problem.parameters = std::move(parameters);
  problem.rows.resize(rows);
  problem.forward = Each(std::move(model));
  return problem;
}

/// r = A x - b
struct Linear {
  std::vector<std::vector<double>> A;
  std::vector<double> b;
  Residuals operator()(const std::vector<double>& x) const {
    Residuals answer;
    for (std::size_t i = 0; i < A.size(); ++i) {
      double sum = -b[i];
      for (std::size_t j = 0; j < x.size(); ++j) sum += A[i][j] * x[j];
      answer.value.push_back(sum);
    }
    return answer;
  }
};

/// Returns matrix and right-hand side with normally distributed entries.
inline Linear RandomLinear(std::size_t rows, std::size_t columns, std::uint64_t seed) {
  math::Random random(seed, 7, 0);
  Linear linear;
  for (std::size_t i = 0; i < rows; ++i) {
    linear.A.emplace_back();
    for (std::size_t j = 0; j < columns; ++j) linear.A.back().push_back(random.Normal());
    linear.b.push_back(random.Normal());
  }
  return linear;
}

}  // namespace taut::test
