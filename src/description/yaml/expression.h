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

/// Named numbers. NaN marks a name that exists but whose definition had an error, which is already
/// reported: expressions that use the name evaluate to NaN without a second message.
using NameTable = std::map<std::string, double, std::less<>>;

using NameSet = std::set<std::string, std::less<>>;

struct Evaluated {
  double value = 0.0;       ///< Finite on success, else NaN.
  std::string error, hint;  ///< Empty error and NaN: uses a name with a reported error.
};

Evaluated Evaluate(std::string_view expression, const NameTable& names);

/// Expression that is parsed once and evaluated for many values of its names.
class Formula {
 public:
  /// Refers to the values in `names`, which must outlive it and keep its names.
  Formula(std::string_view expression, const NameTable& names);

  /// Evaluates with the present values of `names`; same bits and errors as `Evaluate`.
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

/// Returns the parameters that an expression refers to, each once. Never fails: for an invalid
/// expression, returns all names in the text.
std::vector<std::string> NamesIn(std::string_view expression);

/// Returns whether `text` consists of letters, digits and `_` and does not start with a digit.
bool IsIdentifier(std::string_view text);

/// Returns whether `text` is `pi` or a function, which no parameter may be named after.
bool IsReservedName(std::string_view text);

}  // namespace taut::description
