#include "fit/format.h"

#include <cmath>

#include "base/brief.h"

namespace taut::fit {

std::string Brief(double x, const std::string& unit) {
  if (std::isinf(x)) return x > 0 ? "infinite" : "minus infinite";
  return unit.empty() ? base::Brief(x) : base::Brief(x) + " " + unit;
}

std::string Change(double x, const std::string& unit) {
  return (x < 0 ? "" : "+") + Brief(x, unit);
}

std::string List(const std::vector<std::string>& names) {
  std::string all;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) all += i + 1 == names.size() ? " and " : ", ";
    all += names[i];
  }
  return all;
}

}  // namespace taut::fit
