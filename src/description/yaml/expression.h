/// Arithmetic expressions in model and experiment files: `sqrt(3) / 2 * edge_m`.
///
/// Syntax: + - * / ^ ( ), unary minus, numbers, named parameters, pi, and the functions sqrt, sin,
/// cos, tan, asin, acos, atan, atan2, exp, log, abs, min, max, floor, ceil, round (half away from
/// zero), noise (seed, x, y: math/noise.h). `^` binds tightest and groups to the right: -2^2 is -4,
/// 2^3^2 is 512. Angles in rad. The same text gives the same bits on every machine
/// (math/elementary.h).
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace taut::description {

/// Values of named parameters. NaN means that the name exists, but its definition had an error.
/// Expressions that use such a name evaluate to NaN without another error message.
using NameTable = std::map<std::string, double, std::less<>>;

using NameSet = std::set<std::string, std::less<>>;

struct Evaluated {
  double value = 0.0;       ///< Finite on success, otherwise NaN.
  std::string error, hint;  ///< Empty on success, and for NaN that follows from an earlier error.
};

Evaluated Evaluate(std::string_view expression, const NameTable& names);

/// Parsed expression that can be evaluated repeatedly for different values of its names.
class Formula {
 public:
  /// Keeps references to the values in `names`. `names` must outlive the formula and keep all its
  /// entries.
  Formula(std::string_view expression, const NameTable& names);

  /// Evaluates with the current values of `names`. Same results and errors as `Evaluate`.
  Evaluated Value() const;
  /// Returns the number of steps of one evaluation.
  std::size_t size() const { return steps_.size(); }

  enum class Kind { kNumber, kName, kAdd, kSubtract, kMultiply, kDivide, kPower, kNegate, kCall };
  struct Step {
    Kind kind;
    double number = 0.0;
    const double* name = nullptr;
    std::string_view function = {};
    std::size_t arguments = 0;
  };

 private:
  std::vector<Step> steps_;  ///< In postfix order.
  Evaluated wrong_;          ///< Syntax error, if any.
};

/// Returns the parameters that an expression contains, each once. For an invalid expression,
/// returns all names in the text.
std::vector<std::string> NamesIn(std::string_view expression);

/// Returns whether `text` consists of letters, digits and `_` and does not start with a digit.
bool IsIdentifier(std::string_view text);

/// Returns whether `text` is `pi` or the name of a function. Parameters must not have such a name.
bool IsReservedName(std::string_view text);

}  // namespace taut::description
