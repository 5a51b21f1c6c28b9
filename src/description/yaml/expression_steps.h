/// Stack machine that evaluates the postfix steps of a parsed expression.
#pragma once

#include <string>
#include <vector>

#include "description/yaml/expression.h"

namespace taut::description {

/// Thrown at the first error of parsing or evaluation; `Formula` catches it.
struct ExpressionFailure {
  std::string error, hint;
};

/// Returns the value of the expression. Throws ExpressionFailure.
double ValueOf(const std::vector<Formula::Step>& steps);

}  // namespace taut::description
