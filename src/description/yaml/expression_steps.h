/// Stack machine that evaluates an expression in postfix order.
#pragma once

#include <string>
#include <vector>

#include "description/yaml/expression.h"

namespace taut::description {

/// Thrown at the first parsing or evaluation error; caught by `Formula`.
struct ExpressionFailure {
  std::string error, hint;
};

/// Returns the value of the expression. Throws ExpressionFailure.
double ValueOf(const std::vector<Formula::Step>& steps);

}  // namespace taut::description
