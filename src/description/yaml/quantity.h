/// Expressions that may end with a unit: `4 mm`, `30 deg`, `0.4 N/mm`.
#pragma once

#include <string_view>

#include "description/yaml/expression.h"

namespace taut::description {

/// Evaluates an expression, or an expression and a unit, converted to the SI unit of the quantity.
/// This unit is `unit` or, if `unit` is empty, the unit at the end of `path`, the name of a key or
/// parameter: N/m for cable.stiffness_n_per_m. The value is bit-identical to the number in SI:
/// `4 mm` to 0.004.
Evaluated EvaluateQuantity(std::string_view text, const NameTable& names, std::string_view path,
                           std::string_view unit = {});

}  // namespace taut::description
