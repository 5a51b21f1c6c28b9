/// Arithmetic in model and experiment files: `sqrt(3) / 2 * edge_m`.
///
/// + - * / ^ ( ), unary minus, numbers, named parameters, pi, and the functions sqrt, sin, cos,
/// tan, asin, acos, atan, atan2, exp, log, abs, min, max, floor, ceil, round (half away from
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

/// Named numbers. A value of NaN says: the name exists, but what it stands for was already
/// complained about, so whatever uses it must stay silent.
using NameTable = std::map<std::string, double, std::less<>>;

using NameSet = std::set<std::string, std::less<>>;

struct Evaluated {
  double value = 0.0;       ///< Finite if all went well, else NaN.
  std::string error, hint;  ///< Empty error and NaN: uses a name that was complained about.
};

Evaluated Evaluate(std::string_view expression, const NameTable& names);

/// An expression that is parsed once and evaluated for many values of its names.
class Formula {
 public:
  /// Refers to the values in `names`, which must outlive it and keep its names.
  Formula(std::string_view expression, const NameTable& names);

  /// With the values that `names` has now; the same bits and errors as `Evaluate`.
  Evaluated Value() const;
  /// Steps of one evaluation.
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
  std::vector<Step> steps_;  ///< Postfix.
  Evaluated wrong_;          ///< Why it cannot be parsed.
};

/// The parameters that an expression refers to, each once. Never fails: what is no expression
/// has whatever names are in it.
std::vector<std::string> NamesIn(std::string_view expression);

/// Letters, digits and `_`, not starting with a digit.
bool IsIdentifier(std::string_view text);

/// `pi` and the functions: no parameter may be called so.
bool IsReservedName(std::string_view text);

}  // namespace taut::description
