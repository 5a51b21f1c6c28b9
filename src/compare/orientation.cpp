#include "compare/orientation.h"

#include <cmath>
#include <unordered_map>

namespace taut::compare {
namespace {

constexpr std::array<char, 4> kLetters{'w', 'x', 'y', 'z'};
constexpr std::string_view kOrientation = "orientation_";

std::array<double, 4> RowOf(const QuaternionRows& rows, std::size_t row) {
  return {rows[0][row], rows[1][row], rows[2][row], rows[3][row]};
}

void TurnSigns(QuaternionRows& rows, std::size_t row) {
  for (auto& component : rows) component[row] = -component[row];
}

bool Complete(const std::array<double, 4>& q) {
  return std::isfinite(q[0]) && std::isfinite(q[1]) && std::isfinite(q[2]) && std::isfinite(q[3]);
}

/// Returns whether there are complete rows and all of them have unit length within 1 %.
bool HasUnitLength(const Trace& trace, const QuaternionChannels& at) {
  bool any = false;
  for (std::size_t row = 0; row < trace.time_s.size(); ++row) {
    double square = 0;
    for (const std::size_t c : at) square += trace.values[c][row] * trace.values[c][row];
    if (!std::isfinite(square)) continue;
    if (std::abs(square - 1.0) > 0.02) return false;
    any = true;
  }
  return any;
}

}  // namespace

std::vector<QuaternionChannels> FindQuaternions(const Trace& trace) {
  std::unordered_map<std::string, std::size_t> index;
  for (std::size_t c = 0; c < trace.channels.size(); ++c) {
    index.emplace(trace.channels[c].name, c);
  }
  std::vector<QuaternionChannels> found;
  for (std::size_t c = 0; c < trace.channels.size(); ++c) {
    std::string name = trace.channels[c].name;
    if (!name.ends_with('w')) continue;
    QuaternionChannels at{};
    bool all = true;
    for (std::size_t i = 0; i < 4 && all; ++i) {
      name.back() = kLetters[i];
      const auto known = index.find(name);
      all = known != index.end();
      if (all) at[i] = known->second;
    }
    name.pop_back();
    if (all && (name.ends_with(kOrientation) || HasUnitLength(trace, at))) found.push_back(at);
  }
  return found;
}

std::vector<std::string> QuaternionNames(const std::string& channel) {
  std::string stem = channel;
  if (stem.empty()) return {};
  const char letter = stem.back();
  stem.pop_back();
  if (!stem.ends_with(kOrientation)) return {};
  std::vector<std::string> names;
  bool known = false;
  for (const char each : kLetters) {
    names.push_back(stem + each);
    known = known || each == letter;
  }
  return known ? names : std::vector<std::string>{};
}

double NearerSign(const std::array<double, 4>& q, const std::array<double, 4>& to) {
  double dot = 0;
  for (std::size_t i = 0; i < 4; ++i) dot += q[i] * to[i];
  return dot < 0 ? -1.0 : 1.0;
}

void MakeContinuous(QuaternionRows& rows) {
  std::array<double, 4> last{};
  for (std::size_t row = 0; row < rows[0].size(); ++row) {
    if (!Complete(RowOf(rows, row))) continue;
    if (NearerSign(RowOf(rows, row), last) < 0) TurnSigns(rows, row);
    last = RowOf(rows, row);
  }
}

void AlignTo(const QuaternionRows& to, QuaternionRows& rows) {
  for (std::size_t row = 0; row < rows[0].size(); ++row) {
    if (NearerSign(RowOf(rows, row), RowOf(to, row)) < 0) TurnSigns(rows, row);
  }
}

void MakeOrientationsContinuous(Trace& trace) {
  for (const QuaternionChannels& at : FindQuaternions(trace)) {
    QuaternionRows rows;
    for (std::size_t i = 0; i < 4; ++i) rows[i] = std::move(trace.values[at[i]]);
    MakeContinuous(rows);
    for (std::size_t i = 0; i < 4; ++i) trace.values[at[i]] = std::move(rows[i]);
  }
}

}  // namespace taut::compare
