#include "description/yaml/quantity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/foreign_units.h"
#include "base/name_unit.h"

namespace taut::description {
namespace {

using base::ForeignUnit;

constexpr double kNoQuantity = std::numeric_limits<double>::quiet_NaN();

/// Divides where the unit is a whole fraction of the SI unit: 4 / 1000 is the double nearest to
/// 0.004, 4 * 0.001 may not be.
double Converted(double value, double factor) {
  const double inverse = std::round(1.0 / factor);
  const bool whole = factor < 1.0 && std::fabs(factor * inverse - 1.0) < 1e-15;
  return whole ? value / inverse : value * factor;
}

/// Returns the text before a unit; empty if the text does not end with it.
std::string_view Before(std::string_view text, std::string_view unit) {
  if (text.size() <= unit.size() || !text.ends_with(unit)) return {};
  text.remove_suffix(unit.size());
  const char last = text.back();
  if (last != ' ' && last != ')' && last != '.' && !(last >= '0' && last <= '9')) return {};
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// Returns whether a text is a sum or difference outside of parentheses, to which a unit at its end
/// would apply as a whole: "1 + 300 mm".
bool IsSum(std::string_view text) {
  int depth = 0;
  char before = 0;  // last character that is not a blank
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '(') ++depth;
    if (c == ')') --depth;
    const bool binary = before != 0 && before != '*' && before != '/' && before != '^' &&
                        before != '(' && before != ',' && before != '+' && before != '-';
    const bool exponent = i > 1 && (text[i - 1] == 'e' || text[i - 1] == 'E') &&
                          (text[i - 2] == '.' || (text[i - 2] >= '0' && text[i - 2] <= '9'));
    if (depth == 0 && (c == '+' || c == '-') && binary && !exponent) return true;
    if (c != ' ') before = c;
  }
  return false;
}

std::string UnitsOf(std::string_view si) {
  std::string list;
  for (const ForeignUnit& unit : base::Units()) {
    if (unit.si == si) list += (list.empty() ? "" : ", ") + unit.name;
  }
  return list;
}

std::string UnitOfKey(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  return base::UnitAtEnd(dot == path.npos ? path : path.substr(dot + 1)).Text();
}

}  // namespace

Evaluated EvaluateQuantity(std::string_view text, const NameTable& names, std::string_view path,
                           std::string_view unit) {
  Evaluated plain = Evaluate(text, names);
  if (plain.error.empty()) return plain;
  const std::string of_key = unit.empty() ? UnitOfKey(path) : std::string(unit);
  const ForeignUnit* found = nullptr;
  Evaluated number;
  for (const ForeignUnit& one : base::Units()) {
    const std::string_view rest = Before(text, one.name);
    if (rest.empty() || (found != nullptr && found->name.size() > one.name.size())) continue;
    Evaluated result = Evaluate(rest, names);
    if (!result.error.empty()) continue;
    number = result;
    found = &one;
  }
  if (found == nullptr) return plain;
  const std::string shown = "\"" + std::string(text) + "\"";
  if (IsSum(Before(text, found->name))) {
    return {kNoQuantity, "the unit in " + shown + " follows a sum",
            "put the sum in parentheses, or write all numbers in SI units"};
  }
  if (found->si == of_key) {
    number.value = Converted(number.value, found->factor);
    return number;
  }
  if (of_key.empty()) {
    return {kNoQuantity, shown + " has a unit, but this quantity has none", "leave out the unit"};
  }
  const std::string known = UnitsOf(of_key);
  return {kNoQuantity, shown + " is in " + found->si + ", but this quantity is in " + of_key,
          known.empty() ? "leave out the unit" : "its units: " + known};
}

}  // namespace taut::description
