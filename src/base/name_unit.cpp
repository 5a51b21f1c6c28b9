#include "base/name_unit.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

namespace taut::base {
namespace {

/// Returns the unit of a word, such as "s^2" for "s2"; empty if it is not a unit.
std::string UnitOfWord(std::string_view word) {
  constexpr std::pair<std::string_view, std::string_view> kUnits[] = {
      {"m", "m"},   {"s", "s"},     {"kg", "kg"}, {"n", "N"},     {"j", "J"},
      {"hz", "Hz"}, {"rad", "rad"}, {"pa", "Pa"}, {"ohm", "ohm"}, {"a", "A"},
      {"v", "V"},   {"w", "W"},     {"k", "K"},   {"c", "degC"},
  };
  std::string power;
  if (word.size() > 1 && word.back() >= '2' && word.back() <= '9') {
    power = std::string("^") + word.back();
    word.remove_suffix(1);
  }
  for (const auto& [written, unit] : kUnits) {
    if (word == written) return std::string(unit) + power;
  }
  return {};
}

/// Returns whether the last letter of a name is an index or component (body_a, orientation_w)
/// instead of a unit. Such a letter is a unit only after the name of its quantity.
bool IsOnlyLetter(std::string_view word, std::string_view before) {
  constexpr std::string_view kLetters[] = {"a", "v", "w", "k", "c"};
  constexpr std::string_view kQuantities[] = {"current", "voltage", "power", "temperature"};
  return std::find(std::begin(kLetters), std::end(kLetters), word) != std::end(kLetters) &&
         std::find(std::begin(kQuantities), std::end(kQuantities), before) == std::end(kQuantities);
}

}  // namespace

std::string NameUnit::Text() const {
  if (under.empty()) return over;
  const bool several = under.find(' ') != under.npos;
  return (over.empty() ? "1" : over) + "/" + (several ? "(" + under + ")" : under);
}

NameUnit UnitAtEnd(std::string_view name) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; (at = name.find('_')) != name.npos; name.remove_prefix(at + 1)) {
    words.push_back(name.substr(0, at));
  }
  words.push_back(name);
  std::size_t from = words.size();
  while (from > 1 && (words[from - 1] == "per" || !UnitOfWord(words[from - 1]).empty())) --from;
  if (from + 1 == words.size() && IsOnlyLetter(words[from], words[from - 1])) return {};
  const auto begin = words.begin() + static_cast<std::ptrdiff_t>(from);
  const auto per = std::find(begin, words.end(), "per");
  const auto join = [](auto first, auto last) {
    std::string text;
    for (; first != last; ++first) text += (text.empty() ? "" : " ") + UnitOfWord(*first);
    return text;
  };
  if (per == words.end()) return {join(begin, per), {}};
  if (std::find(per + 1, words.end(), "per") != words.end() || per + 1 == words.end()) return {};
  return {join(begin, per), join(per + 1, words.end())};
}

}  // namespace taut::base
