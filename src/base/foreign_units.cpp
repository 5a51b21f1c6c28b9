#include "base/foreign_units.h"

#include <numbers>

namespace taut::base {
namespace {

constexpr double kPound_kg = 0.45359237, kGravity_m_per_s2 = 9.80665, kInch_m = 0.0254;
constexpr double kPoundForce_n = kPound_kg * kGravity_m_per_s2;

}  // namespace

/// Exact by definition (The International System of Units, 9th edition; international yard and
/// pound of 1959).
const std::vector<ForeignUnit>& Units() {
  static const std::vector<ForeignUnit> units{
      {"s", "s", 1},
      {"ms", "s", 1e-3},
      {"us", "s", 1e-6},
      {"ns", "s", 1e-9},
      {"min", "s", 60},
      {"h", "s", 3600},
      {"m", "m", 1},
      {"cm", "m", 1e-2},
      {"mm", "m", 1e-3},
      {"um", "m", 1e-6},
      {"in", "m", kInch_m},
      {"ft", "m", 12 * kInch_m},
      {"m^2", "m^2", 1},
      {"cm^2", "m^2", 1e-4},
      {"mm^2", "m^2", 1e-6},
      {"m^4", "m^4", 1},
      {"cm^4", "m^4", 1e-8},
      {"mm^4", "m^4", 1e-12},
      {"m/s", "m/s", 1},
      {"cm/s", "m/s", 1e-2},
      {"mm/s", "m/s", 1e-3},
      {"rad", "rad", 1},
      {"deg", "rad", std::numbers::pi / 180},
      {"turn", "rad", 2 * std::numbers::pi},
      {"rad/s", "rad/s", 1},
      {"deg/s", "rad/s", std::numbers::pi / 180},
      {"rpm", "rad/s", std::numbers::pi / 30},
      {"N", "N", 1},
      {"kN", "N", 1e3},
      {"mN", "N", 1e-3},
      {"lbf", "N", kPoundForce_n},
      {"kgf", "N", kGravity_m_per_s2},
      {"gf", "N", 1e-3 * kGravity_m_per_s2},
      {"N m", "N m", 1},
      {"N mm", "N m", 1e-3},
      {"N cm", "N m", 1e-2},
      {"N/m", "N/m", 1},
      {"N/mm", "N/m", 1e3},
      {"N/cm", "N/m", 1e2},
      {"kN/m", "N/m", 1e3},
      {"N s/m", "N s/m", 1},
      {"N s/mm", "N s/m", 1e3},
      {"lbf/in", "N/m", kPoundForce_n / kInch_m},
      {"kg", "kg", 1},
      {"g", "kg", 1e-3},
      {"lb", "kg", kPound_kg},
      {"kg/m", "kg/m", 1},
      {"g/m", "kg/m", 1e-3},
      {"kg/m^3", "kg/m^3", 1},
      {"g/cm^3", "kg/m^3", 1e3},
      {"kg m^2", "kg m^2", 1},
      {"kg mm^2", "kg m^2", 1e-6},
      {"g cm^2", "kg m^2", 1e-7},
      {"Pa", "Pa", 1},
      {"kPa", "Pa", 1e3},
      {"MPa", "Pa", 1e6},
      {"GPa", "Pa", 1e9},
      {"Hz", "Hz", 1},
      {"kHz", "Hz", 1e3},
      {"J", "J", 1},
      {"W", "W", 1},
      {"V", "V", 1},
      {"mV", "V", 1e-3},
      {"A", "A", 1},
      {"mA", "A", 1e-3},
  };
  return units;
}

std::optional<ForeignUnit> FindUnit(std::string_view name) {
  for (const ForeignUnit& unit : Units()) {
    if (unit.name == name) return unit;
  }
  return std::nullopt;
}

std::vector<std::string> UnitNames() {
  std::vector<std::string> names;
  for (const ForeignUnit& unit : Units()) names.push_back(unit.name);
  return names;
}

}  // namespace taut::base
