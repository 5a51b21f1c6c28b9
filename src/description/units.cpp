#include "description/units.h"

#include <utility>
#include <vector>

namespace taut::description {
namespace {

/// "s^2" of "s2". Empty if the word is no unit.
std::string Unit(std::string_view word) {
  std::string power;
  if (word.size() > 1 && word.back() >= '2' && word.back() <= '9') {
    power = std::string("^") + word.back();
    word.remove_suffix(1);
  }
  constexpr std::pair<std::string_view, const char*> kUnits[] = {
      {"m", "m"}, {"s", "s"}, {"kg", "kg"}, {"n", "N"}, {"rad", "rad"}, {"hz", "Hz"}};
  for (const auto& [name, shown] : kUnits) {
    if (word == name) return shown + power;
  }
  return {};
}

}  // namespace

std::string UnitOf(std::string_view key) {
  // From the end, as long as words are units or "per"; what comes first is what is measured.
  std::vector<std::string> above, below;
  std::size_t bar = key.rfind('_');
  for (; bar != key.npos; bar = key.rfind('_')) {
    const std::string_view word = key.substr(bar + 1);
    const std::string unit = Unit(word);
    if (word == "per") {
      below = std::exchange(above, {});
    } else if (!unit.empty()) {
      above.insert(above.begin(), unit);
    } else {
      break;
    }
    key = key.substr(0, bar);
  }
  const auto product = [](const std::vector<std::string>& units) {
    std::string out;
    for (const std::string& unit : units) out += (out.empty() ? "" : " ") + unit;
    return out;
  };
  if (below.empty()) return product(above);
  const std::string divisor = below.size() > 1 ? "(" + product(below) + ")" : product(below);
  return (above.empty() ? "1" : product(above)) + "/" + divisor;
}

}  // namespace taut::description
