#include "description/yaml/expression.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/number_text.h"
#include "description/yaml/expression_steps.h"
#include "taut/diagnostics.h"

namespace taut::description {
namespace {

constexpr int kMaxNesting = 100;  ///< Limit of nested parentheses, signs and powers, which limits
                                  ///< the recursion depth.
constexpr std::size_t kMaxLength = 10'000;  ///< Limits the time to find names.
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Function {
  std::string_view name;
  int arguments;  ///< Number of arguments; -2: two or more.
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

// Letters must not depend on the locale, so <cctype> is not used.
bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }
bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// Returns the length of the identifier at `start`; 0 if there is none.
std::size_t IdentifierLength(std::string_view text, std::size_t start) {
  if (start >= text.size() || !IsLetter(text[start])) return 0;
  std::size_t end = start + 1;
  while (end < text.size() && (IsLetter(text[end]) || IsDigit(text[end]))) ++end;
  return end - start;
}

using Step = Formula::Step;
using Kind = Formula::Kind;
using Failure = ExpressionFailure;

/// Recursive-descent parser of the grammar
///   sum     = product {("+" | "-") product}
///   product = sign {("*" | "/") sign}
///   sign    = ("-" | "+") sign | power
///   power   = atom ["^" sign]
///   atom    = number | name | function "(" sum {"," sum} ")" | "(" sum ")"
class Parser {
 public:
  Parser(std::string_view text, const NameTable& names, std::vector<Step>& steps)
      : text_(text), names_(names), steps_(steps) {}

  void Run() {
    SkipSpace();
    if (at_ == text_.size()) throw Failure{"the expression is empty", ""};
    Sum();
    if (at_ < text_.size()) Unexpected();
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

  void Emit(Kind kind) { steps_.push_back({kind}); }

  void Sum() {
    Product();
    for (;;) {
      if (Take('+')) {
        Product(), Emit(Kind::kAdd);
      } else if (Take('-')) {
        Product(), Emit(Kind::kSubtract);
      } else {
        return;
      }
    }
  }

  void Product() {
    Sign();
    for (;;) {
      if (Take('*')) {
        Sign(), Emit(Kind::kMultiply);
      } else if (Take('/')) {
        Sign(), Emit(Kind::kDivide);
      } else {
        return;
      }
    }
  }

  void Sign() {
    const Deeper deeper(depth_);
    if (Take('-')) {
      Sign(), Emit(Kind::kNegate);
    } else if (Take('+')) {
      Sign();
    } else {
      Power();
    }
  }

  void Power() {
    Atom();
    if (!Take('^')) return;
    Sign(), Emit(Kind::kPower);
  }

  void Atom() {
    if (Take('(')) {
      Sum();
      Expect(')');
      return;
    }
    if (at_ < text_.size() && (IsDigit(text_[at_]) || text_[at_] == '.')) {
      steps_.push_back({Kind::kNumber, Number()});
      return;
    }
    const std::size_t length = IdentifierLength(text_, at_);
    if (length == 0) Unexpected();
    const std::string_view name = text_.substr(at_, length);
    at_ += length;
    SkipSpace();
    if (at_ < text_.size() && text_[at_] == '(') {
      Call(name);
    } else if (name == "pi") {
      steps_.push_back({Kind::kNumber, std::numbers::pi});
    } else {
      steps_.push_back({.kind = Kind::kName, .name = &Named(name)});
    }
  }

  double Number() {
    double value = 0.0;
    const char* const begin = text_.data() + at_;
    const auto [end, status] = base::FromChars(begin, text_.data() + text_.size(), value);
    if (status == std::errc::invalid_argument) Unexpected();
    const std::string digits(begin, end);
    if (status != std::errc()) throw Failure{"the number " + digits + " is out of range", ""};
    at_ += digits.size();
    if (const std::size_t length = IdentifierLength(text_, at_); length > 0) {
      const std::string word(text_.substr(at_, length));
      throw Failure{"\"" + word + "\" directly follows the number " + digits,
                    "write products with `*`, and values without units"};
    }
    SkipSpace();
    return value;
  }

  const double& Named(std::string_view name) {
    const auto found = names_.find(name);
    if (found != names_.end()) return found->second;  // may be NaN, which propagates
    if (FindFunction(name)) {
      throw Failure{std::string(name) + " is a function and needs arguments",
                    "write " + std::string(name) + "(...)"};
    }
    throw Failure{"unknown name \"" + std::string(name) + "\"", NameHint(name)};
  }

  std::string NameHint(std::string_view name) const {
    if (names_.empty()) return "no parameters are defined";
    if (names_.size() > 300 || name.size() > 60) return {};  // limits the search time
    std::vector<std::string> known;
    for (const auto& entry : names_) known.push_back(entry.first);
    return DidYouMean(name, known);
  }

  void Call(std::string_view name) {
    const Deeper deeper(depth_);
    const Function* function = FindFunction(name);
    if (!function) {
      std::vector<std::string> known;
      for (const Function& f : kFunctions) known.emplace_back(f.name);
      throw Failure{"unknown function \"" + std::string(name) + "\"", DidYouMean(name, known)};
    }
    Expect('(');
    Sum();
    int count = 1;
    for (; Take(','); ++count) Sum();
    Expect(')');
    if (function->arguments > 0 ? count != function->arguments : count < -function->arguments) {
      const std::string wanted = function->arguments == 1 ? "1 argument"
                                 : function->arguments == -2
                                     ? "2 or more arguments"
                                     : std::to_string(function->arguments) + " arguments";
      throw Failure{std::string(name) + " takes " + wanted + ", got " + std::to_string(count), ""};
    }
    steps_.push_back({.kind = Kind::kCall,
                      .function = function->name,
                      .arguments = static_cast<std::size_t>(count)});
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
    if (at_ >= text_.size()) throw Failure{"the expression is incomplete", ""};
    // Include all bytes of a UTF-8 character.
    std::size_t length = 1;
    while (at_ + length < text_.size() && (text_[at_ + length] & 0xC0) == 0x80) ++length;
    const std::string found(text_.substr(at_, length));
    const bool star = found == "*" && at_ > 0 && text_[at_ - 1] == '*';
    const bool comma = found == "," && at_ > 0 && IsDigit(text_[at_ - 1]) &&
                       at_ + 1 < text_.size() && IsDigit(text_[at_ + 1]);
    throw Failure{"unexpected \"" + found + "\" in \"" + std::string(text_.substr(0, 60)) + "\"",
                  star    ? "write powers with ^"
                  : comma ? "write decimal fractions with a point"
                          : ""};
  }

  void SkipSpace() {
    while (at_ < text_.size() && IsSpace(text_[at_])) ++at_;
  }

  std::string_view text_;
  const NameTable& names_;
  std::vector<Step>& steps_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

Formula::Formula(std::string_view expression, const NameTable& names) {
  if (expression.size() > kMaxLength) {
    wrong_ = {kNan, "the expression is too long", ""};
    return;
  }
  try {
    Parser(expression, names, steps_).Run();
  } catch (const Failure& failure) {
    wrong_ = {kNan, failure.error, failure.hint};
  }
}

Evaluated Formula::Value() const {
  if (!wrong_.error.empty()) return wrong_;
  try {
    return {ValueOf(steps_), "", ""};
  } catch (const Failure& failure) {
    return {kNan, failure.error, failure.hint};
  }
}

Evaluated Evaluate(std::string_view expression, const NameTable& names) {
  return Formula(expression, names).Value();
}

std::vector<std::string> NamesIn(std::string_view expression) {
  std::vector<std::string> names;
  if (expression.size() > kMaxLength) return names;
  for (std::size_t at = 0; at < expression.size();) {
    const std::size_t length = IdentifierLength(expression, at);
    if (length == 0) {
      ++at;
      // In 1e-3, the e is not a name: skip all letters and digits of a number.
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
