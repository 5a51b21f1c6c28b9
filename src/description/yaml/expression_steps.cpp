#include "description/yaml/expression_steps.h"

#include <cmath>
#include <limits>
#include <span>

#include "math/elementary.h"
#include "math/noise.h"

namespace taut::description {
namespace {

double Checked(double value, std::string_view of) {
  if (std::isinf(value))
    throw ExpressionFailure{std::string(of) + " is too large for a number", ""};
  return value;
}

double NoiseAt(double seed, double x, double y) {
  if (!(seed >= 0.0 && seed <= 0x1p53 && std::floor(seed) == seed)) {
    throw ExpressionFailure{"the seed of noise is not a whole number", "expected 0, 1, 2, ..."};
  }
  if (!(std::fabs(x) < 1e9 && std::fabs(y) < 1e9)) {
    throw ExpressionFailure{"noise of a coordinate beyond 1e9", ""};
  }
  return math::Noise(static_cast<std::uint64_t>(seed), x, y);
}

double Apply(std::string_view name, std::span<const double> arguments) {
  const double x = arguments[0];
  if (name == "sqrt") {
    if (x < 0.0) throw ExpressionFailure{"sqrt of a negative number", ""};
    return std::sqrt(x);
  }
  if (name == "asin" || name == "acos") {
    if (std::fabs(x) > 1.0)
      throw ExpressionFailure{std::string(name) + " of a number outside -1..1", ""};
    return name == "asin" ? math::Asin(x) : math::Acos(x);
  }
  if (name == "log") {
    if (!(x > 0.0)) throw ExpressionFailure{"log of a number that is not positive", ""};
    return math::Log(x);
  }
  if (name == "sin" || name == "cos" || name == "tan") {
    if (std::fabs(x) > math::kMaxAngle) {
      throw ExpressionFailure{std::string(name) + " of an angle beyond 1e9 rad",
                              "angles are in rad"};
    }
    return name == "sin" ? math::Sin(x) : name == "cos" ? math::Cos(x) : math::Tan(x);
  }
  if (name == "atan") return math::Atan(x);
  if (name == "atan2") return math::Atan2(x, arguments[1]);
  if (name == "exp") return math::Exp(x);
  if (name == "abs") return std::fabs(x);
  if (name == "floor") return std::floor(x);
  if (name == "ceil") return std::ceil(x);
  if (name == "round") return std::round(x);
  if (name == "noise") return NoiseAt(x, arguments[1], arguments[2]);
  double best = x;  // min or max
  for (const double other : arguments) {
    if (name == "min" ? other < best : other > best) best = other;
  }
  return best;
}

double PowerOf(double base, double exponent) {
  if (base == 0.0 && exponent < 0.0)
    throw ExpressionFailure{"division by zero", "0 is raised to a negative power"};
  if (base < 0.0 && exponent != std::floor(exponent)) {
    throw ExpressionFailure{"a negative number to a fractional power",
                            "use a positive base, or a whole number as exponent"};
  }
  return Checked(math::Pow(base, exponent), "a power");
}

double CallOf(std::string_view name, std::span<const double> arguments) {
  for (const double argument : arguments) {
    if (std::isnan(argument)) return std::numeric_limits<double>::quiet_NaN();
  }
  return Checked(Apply(name, arguments), name);
}

/// Returns the result of a binary operation.
double Combined(Formula::Kind kind, double a, double b) {
  switch (kind) {
    case Formula::Kind::kAdd:
      return Checked(a + b, "a sum");
    case Formula::Kind::kSubtract:
      return Checked(a - b, "a difference");
    case Formula::Kind::kMultiply:
      return Checked(a * b, "a product");
    case Formula::Kind::kDivide:
      if (b == 0.0) throw ExpressionFailure{"division by zero", ""};
      return Checked(a / b, "a quotient");
    default:
      return PowerOf(a, b);
  }
}

}  // namespace

double ValueOf(const std::vector<Formula::Step>& steps) {
  std::vector<double> stack;
  stack.reserve(steps.size());
  for (const Formula::Step& step : steps) {
    if (step.kind == Formula::Kind::kNumber) {
      stack.push_back(step.number);
    } else if (step.kind == Formula::Kind::kName) {
      stack.push_back(*step.name);
    } else if (step.kind == Formula::Kind::kNegate) {
      stack.back() = -stack.back();
    } else if (step.kind == Formula::Kind::kCall) {
      const std::size_t first = stack.size() - step.arguments;
      const double value = CallOf(step.function, std::span(stack).subspan(first));
      stack.resize(first);
      stack.push_back(value);
    } else {
      const double right = stack.back();
      stack.pop_back();
      stack.back() = Combined(step.kind, stack.back(), right);
    }
  }
  return stack.back();
}

}  // namespace taut::description
