#include "plant/finite_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace taut::plant {
namespace {

/// Returns the numeric rows of commands, with names.
std::array<std::pair<const char*, double*>, 5> RowsOf(const Commands& commands) {
  return {{{"rest_length_m", commands.rest_length_m},
           {"set_point_n", commands.set_point_n},
           {"velocity_input_m_per_s", commands.velocity_input_m_per_s},
           {"signal", commands.signal},
           {"duty", commands.duty}}};
}

/// Uses integers, so that the compiler can vectorize the loop.
bool AllFinite(const double* row, std::size_t count) {
  if (row == nullptr) return true;
  constexpr std::uint64_t kExponent = 0x7ff0'0000'0000'0000;
  std::uint64_t bad = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto bits = __builtin_bit_cast(std::uint64_t, row[i]);
    bad |= static_cast<std::uint64_t>((bits & kExponent) == kExponent);
  }
  return bad == 0;
}

const char* TextOf(double value) { return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf"; }

}  // namespace

FiniteCheck::FiniteCheck(const std::vector<CableDef>& cables, int lanes)
    : cables_(cables), lanes_(lanes), refused_(static_cast<std::size_t>(lanes)) {}

void FiniteCheck::Keep(const Commands& commands) {
  const std::size_t count = cables_.size() * static_cast<std::size_t>(lanes_);
  kept_.resize(RowsOf(commands).size() * count);
  double* to = kept_.data();
  for (const auto& [name, row] : RowsOf(commands)) {
    if (row != nullptr) std::copy_n(row, count, to);
    to += count;
  }
}

void FiniteCheck::PutBack(const Commands& commands, Lanes among,
                          const std::function<double(int)>& time_s, std::string_view who) {
  const std::size_t count = cables_.size() * static_cast<std::size_t>(lanes_);
  const double* kept = kept_.data();
  for (const auto& [name, row] : RowsOf(commands)) {
    const bool good = AllFinite(row, count);
    for (std::size_t i = 0; i < count && !good; ++i) {
      const int lane = static_cast<int>(i) % lanes_;
      if (!Has(among, lane) || std::isfinite(row[i])) continue;
      Refuse(lane, time_s(lane), who, "cable", CableAt(i), {name, row[i]});
      row[i] = kept[i];
    }
    kept += count;
  }
}

Lanes FiniteCheck::WithReadings(const Observation& seen, Lanes among) {
  const std::size_t count = cables_.size() * static_cast<std::size_t>(lanes_);
  const std::pair<const char*, const double*> rows[] = {
      {"rest_length_m", seen.cables.rest_length_m},
      {"length_m", seen.cables.length_m},
      {"rate_m_per_s", seen.cables.rate_m_per_s},
      {"tension_n", seen.cables.tension_n},
      {"elastic_n", seen.cables.elastic_n},
      {"stiffness_n_per_m", seen.cables.stiffness_n_per_m}};
  for (const auto& [name, row] : rows) {
    if (AllFinite(row, count)) continue;
    for (std::size_t i = 0; i < count; ++i) {
      const int lane = static_cast<int>(i) % lanes_;
      const bool fault = seen.faults != nullptr && seen.faults[i] != kFaultNone;
      if (!Has(among, lane) || fault || std::isfinite(row[i])) continue;
      Refuse(lane, seen.time_s[lane], "the plant returns", "cable", CableAt(i), {name, row[i]});
      among &= ~(Lanes{1} << lane);
    }
  }
  return among;
}

bool FiniteCheck::Accepts(int lane, double time_s, const char* kind, const std::string& name,
                          std::span<const Named> numbers) {
  for (const Named& number : numbers) {
    if (std::isfinite(number.second)) continue;
    Refuse(lane, time_s, "the program sets", kind, name, number);
    return false;
  }
  return true;
}

void FiniteCheck::Refuse(int lane, double time_s, std::string_view who, const char* kind,
                         const std::string& name, const Named& number) {
  std::string& text = refused_[static_cast<std::size_t>(lane)];
  if (!text.empty()) return;
  text = std::string(who) + " " + number.first + " of " + kind + " " + name + " to " +
         TextOf(number.second) + " at t = " + std::to_string(time_s) +
         " s, expected a finite number";
}

}  // namespace taut::plant
