#include "description/expression.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/number_text.h"
#include "math/elementary.h"
#include "math/noise.h"
#include "taut/diagnostics.h"

namespace taut::description {
namespace {

constexpr int kMaxNesting = 100;  ///< Of parentheses, signs and powers: bounds the recursion.
constexpr std::size_t kMaxLength = 10'000;  ///< Bounds the time that names take.
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Function {
  std::string_view name;
  int arguments;  ///< -2: two or more.
};
constexpr std::array kFunctions{Function{"sqrt", 1},  Function{"sin", 1},   Function{"cos", 1},
                                Function{"tan", 1},   Function{"asin", 1},  Function{"acos", 1},
                                Function{"atan", 1},  Function{"atan2", 2}, Function{"exp", 1},
                                Function{"log", 1},   Function{"abs", 1},   Function{"min", -2},
                                Function{"max", -2},  Function{"floor", 1}, Function{"ceil", 1},
                                Function{"round", 1}, Function{"noise", 3}};

const Function* FindFunction(std::string_view name) {
  for (const Function& function : kFunctions) {
    if (function.name == name) return &function;
  }
  return nullptr;
}

// Not <cctype>: what is a letter must not depend on the locale.
bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }
bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// Characters from `start` that belong to an identifier starting there.
std::size_t IdentifierLength(std::string_view text, std::size_t start) {
  if (start >= text.size() || !IsLetter(text[start])) return 0;
  std::size_t end = start + 1;
  while (end < text.size() && (IsLetter(text[end]) || IsDigit(text[end]))) ++end;
  return end - start;
}

/// Leaves the recursive descent at the first error; never leaves this file.
struct Failure {
  std::string error, hint;
};

/// Recursive descent:
///   sum     = product {("+" | "-") product}
///   product = sign {("*" | "/") sign}
///   sign    = ("-" | "+") sign | power
///   power   = atom ["^" sign]
///   atom    = number | name | function "(" sum {"," sum} ")" | "(" sum ")"
class Evaluator {
 public:
  Evaluator(std::string_view text, const NameTable& names) : text_(text), names_(names) {}

  double Run() {
    SkipSpace();
    if (at_ == text_.size()) throw Failure{"an expression is missing", ""};
    const double value = Sum();
    if (at_ < text_.size()) Unexpected();
    return value;
  }

 private:
  struct Deeper {
    explicit Deeper(int& depth) : depth_(depth) {
      if (++depth_ > kMaxNesting) throw Failure{"the expression is nested too deeply", ""};
    }
    ~Deeper() { --depth_; }
    Deeper(const Deeper&) = delete;
    Deeper& operator=(const Deeper&) = delete;
    int& depth_;
  };

  double Sum() {
    double value = Product();
    for (;;) {
      if (Take('+')) {
        value = Checked(value + Product(), "a sum");
      } else if (Take('-')) {
        value = Checked(value - Product(), "a difference");
      } else {
        return value;
      }
    }
  }

  double Product() {
    double value = Sign();
    for (;;) {
      if (Take('*')) {
        value = Checked(value * Sign(), "a product");
      } else if (Take('/')) {
        const double divisor = Sign();
        if (divisor == 0.0) throw Failure{"division by zero", ""};
        value = Checked(value / divisor, "a quotient");
      } else {
        return value;
      }
    }
  }

  double Sign() {
    const Deeper deeper(depth_);
    if (Take('-')) return -Sign();
    if (Take('+')) return Sign();
    return Power();
  }

  double Power() {
    const double base = Atom();
    if (!Take('^')) return base;
    const double exponent = Sign();
    if (base == 0.0 && exponent < 0.0) throw Failure{"division by zero", "0 ^ a negative number"};
    if (base < 0.0 && exponent != std::floor(exponent)) {
      throw Failure{"a negative number to a broken power", "write (-x)^y for a whole y"};
    }
    return Checked(math::Pow(base, exponent), "a power");
  }

  double Atom() {
    if (Take('(')) {
      const double value = Sum();
      Expect(')');
      return value;
    }
    if (at_ < text_.size() && (IsDigit(text_[at_]) || text_[at_] == '.')) return Number();
    const std::size_t length = IdentifierLength(text_, at_);
    if (length == 0) Unexpected();
    const std::string_view name = text_.substr(at_, length);
    at_ += length;
    SkipSpace();
    if (at_ < text_.size() && text_[at_] == '(') return Call(name);
    if (name == "pi") return std::numbers::pi;
    return Named(name);
  }

  double Number() {
    double value = 0.0;
    const char* const begin = text_.data() + at_;
    const auto [end, status] = base::FromChars(begin, text_.data() + text_.size(), value);
    if (status == std::errc::invalid_argument) Unexpected();
    const std::string digits(begin, end);
    if (status != std::errc()) throw Failure{"number out of range: " + digits, ""};
    at_ += digits.size();
    if (const std::size_t length = IdentifierLength(text_, at_); length > 0) {
      const std::string word(text_.substr(at_, length));
      throw Failure{"\"" + word + "\" right after the number " + digits,
                    "a product needs `*`; units belong to the key, not to the value"};
    }
    SkipSpace();
    return value;
  }

  double Named(std::string_view name) {
    const auto found = names_.find(name);
    if (found != names_.end()) return found->second;  // NaN spreads, silently, as intended
    if (FindFunction(name)) {
      throw Failure{std::string(name) + " is a function", "write " + std::string(name) + "(...)"};
    }
    throw Failure{"unknown name \"" + std::string(name) + "\"", NameHint(name)};
  }

  std::string NameHint(std::string_view name) const {
    if (names_.empty()) return "there are no parameters";
    if (names_.size() > 300 || name.size() > 60) return {};  // the search would take long
    std::vector<std::string> known;
    for (const auto& entry : names_) known.push_back(entry.first);
    return DidYouMean(name, known);
  }

  double Call(std::string_view name) {
    const Deeper deeper(depth_);
    const Function* function = FindFunction(name);
    if (!function) {
      std::vector<std::string> known;
      for (const Function& f : kFunctions) known.emplace_back(f.name);
      throw Failure{"unknown function \"" + std::string(name) + "\"", DidYouMean(name, known)};
    }
    Expect('(');
    std::vector<double> arguments{Sum()};
    while (Take(',')) arguments.push_back(Sum());
    Expect(')');
    const int count = static_cast<int>(arguments.size());
    if (function->arguments > 0 ? count != function->arguments : count < -function->arguments) {
      const std::string wanted = function->arguments == 1 ? "1 argument"
                                 : function->arguments == -2
                                     ? "2 or more arguments"
                                     : std::to_string(function->arguments) + " arguments";
      throw Failure{std::string(name) + " takes " + wanted + ", got " + std::to_string(count), ""};
    }
    for (const double argument : arguments) {
      if (std::isnan(argument)) return kNan;
    }
    return Checked(Apply(name, arguments), name);
  }

  static double Apply(std::string_view name, const std::vector<double>& arguments) {
    const double x = arguments[0];
    if (name == "sqrt") {
      if (x < 0.0) throw Failure{"sqrt of a negative number", ""};
      return std::sqrt(x);
    }
    if (name == "asin" || name == "acos") {
      if (std::fabs(x) > 1.0) throw Failure{std::string(name) + " of a number outside -1..1", ""};
      return name == "asin" ? math::Asin(x) : math::Acos(x);
    }
    if (name == "log") {
      if (!(x > 0.0)) throw Failure{"log of a number that is not positive", ""};
      return math::Log(x);
    }
    if (name == "sin" || name == "cos" || name == "tan") {
      if (std::fabs(x) > math::kMaxAngle) {
        throw Failure{std::string(name) + " of an angle beyond 1e9 rad", "angles are in rad"};
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
    if (name == "noise") return Noise(x, arguments[1], arguments[2]);
    double best = x;  // min and max
    for (const double other : arguments) {
      if (name == "min" ? other < best : other > best) best = other;
    }
    return best;
  }

  static double Noise(double seed, double x, double y) {
    if (!(seed >= 0.0 && seed <= 0x1p53 && std::floor(seed) == seed)) {
      throw Failure{"the seed of noise is not a whole number", "0, 1, 2, ..."};
    }
    if (!(std::fabs(x) < 1e9 && std::fabs(y) < 1e9)) {
      throw Failure{"noise of a place beyond 1e9", ""};
    }
    return math::Noise(static_cast<std::uint64_t>(seed), x, y);
  }

  static double Checked(double value, std::string_view of) {
    if (std::isinf(value)) throw Failure{std::string(of) + " that is too large for a number", ""};
    return value;
  }

  bool Take(char wanted) {
    if (at_ >= text_.size() || text_[at_] != wanted) return false;
    ++at_;
    SkipSpace();
    return true;
  }

  void Expect(char wanted) {
    if (Take(wanted)) return;
    if (at_ == text_.size()) throw Failure{std::string("\"") + wanted + "\" is missing", ""};
    Unexpected();
  }

  [[noreturn]] void Unexpected() const {
    if (at_ >= text_.size()) throw Failure{"the expression ends too early", ""};
    // The whole UTF-8 character, not its first byte.
    std::size_t length = 1;
    while (at_ + length < text_.size() && (text_[at_ + length] & 0xC0) == 0x80) ++length;
    const std::string found(text_.substr(at_, length));
    const bool star = found == "*" && at_ > 0 && text_[at_ - 1] == '*';
    throw Failure{"unexpected \"" + found + "\" in \"" + std::string(text_.substr(0, 60)) + "\"",
                  star ? "powers are written with ^" : ""};
  }

  void SkipSpace() {
    while (at_ < text_.size() && IsSpace(text_[at_])) ++at_;
  }

  std::string_view text_;
  const NameTable& names_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

Evaluated Evaluate(std::string_view expression, const NameTable& names) {
  if (expression.size() > kMaxLength) return {kNan, "the expression is too long", ""};
  try {
    return {Evaluator(expression, names).Run(), "", ""};
  } catch (const Failure& failure) {
    return {kNan, failure.error, failure.hint};
  }
}

std::vector<std::string> NamesIn(std::string_view expression) {
  std::vector<std::string> names;
  if (expression.size() > kMaxLength) return names;
  for (std::size_t at = 0; at < expression.size();) {
    const std::size_t length = IdentifierLength(expression, at);
    if (length == 0) {
      ++at;
      // The e of 1e-3 is no name: a number is skipped with all its letters.
      if (IsDigit(expression[at - 1])) {
        while (at < expression.size() && (IsLetter(expression[at]) || IsDigit(expression[at])))
          ++at;
      }
      continue;
    }
    std::string name(expression.substr(at, length));
    at += length;
    bool fresh = !IsReservedName(name);
    for (const std::string& known : names) fresh = fresh && known != name;
    if (fresh) names.push_back(std::move(name));
  }
  return names;
}

bool IsIdentifier(std::string_view text) {
  return !text.empty() && IdentifierLength(text, 0) == text.size();
}

bool IsReservedName(std::string_view text) { return text == "pi" || FindFunction(text) != nullptr; }

}  // namespace taut::description
