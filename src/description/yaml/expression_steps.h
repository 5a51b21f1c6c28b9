/// Stack machine for the steps of a parsed expression.
#pragma once

#include <string>
#include <vector>

#include "description/yaml/expression.h"

namespace taut::description {

/// Leaves parsing or evaluation at the first error; `Formula` catches it.
struct ExpressionFailure {
  std::string error, hint;
};

/// Throws ExpressionFailure.
double ValueOf(const std::vector<Formula::Step>& steps);

}  // namespace taut::description
