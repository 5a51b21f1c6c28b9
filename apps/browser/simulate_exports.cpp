// C interface of `Simulate` for web/src/demo/simulate.ts. Returned memory is valid until the next
// call.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include "simulate.h"

namespace {

taut::browser::SimulateResult result;

/// Parses lines of the form NAME=VALUE.
taut::Overrides ParseLines(std::string_view lines) {
  taut::Overrides overrides;
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    const std::string_view line = lines.substr(0, end);
    const std::size_t equals = line.find('=');
    if (equals != line.npos) {
      overrides.emplace_back(line.substr(0, equals), line.substr(equals + 1));
    }
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  return overrides;
}

}  // namespace

extern "C" {

/// `overrides`: a line NAME=VALUE per parameter. `duration_s`: NaN for the experiment's duration.
const char* taut_simulate(const char* path, const char* overrides, double duration_s) {
  taut::browser::SimulateInputs inputs{path, ParseLines(overrides), {}};
  if (!std::isnan(duration_s)) inputs.duration_s = duration_s;
  result = taut::browser::Simulate(inputs);
  return result.json.c_str();
}

const double* taut_rows() { return result.rows.data(); }
}
