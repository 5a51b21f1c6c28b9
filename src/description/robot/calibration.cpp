// Loader of calibration files.
#include "taut/calibration.h"

#include <set>
#include <utility>

#include "base/number_text.h"
#include "description/robot/calibration_keys.h"
#include "description/robot/robot_file.h"
#include "description/yaml/read_keys.h"
#include "description/yaml/write_keys.h"

namespace taut {
namespace description {
namespace {

bool IsDay(const std::string& text) {
  if (text.size() != 10 || text[4] != '-' || text[7] != '-') return false;
  const auto number = [&](std::size_t at, std::size_t size) {
    int value = -1;
    const char* const end = text.data() + at + size;
    return base::FromChars(text.data() + at, end, value).ptr == end ? value : -1;
  };
  const int year = number(0, 4), month = number(5, 2), day = number(8, 2);
  return year >= 1900 && month >= 1 && month <= 12 && day >= 1 && day <= 31;
}

Calibration ReadCalibration(const Value& root, const std::vector<std::string>& cables,
                            const Scope& scope) {
  CalibrationFileText text;
  ReadMapping(root, "", scope, text);
  Calibration calibration{text.name, text.description, {}};
  std::set<std::string> known;
  for (CableCalibrationText& one : text.cables) {
    const std::string& name = one.cable.text;
    if (!name.empty() && !known.insert(name).second) {
      scope.out.Error("calibration.duplicate_cable", one.cable.at,
                      "the cable \"" + name + "\" has two entries");
    }
    if (!name.empty() && !cables.empty()) FindActuatedCable(one.cable, cables, scope);
    one.values.cable = name;
    one.values.measured = one.measured.text;
    calibration.cables.push_back(std::move(one.values));
  }
  return calibration;
}

}  // namespace

void Check(const MapReader& map, CableCalibrationText& cable) {
  if (map.Has("measured") && !IsDay(cable.measured.text)) {
    map.Error("calibration.bad_day", "measured", "\"" + cable.measured.text + "\" is not a date",
              "expected year, month and day, such as 2026-11-23");
  }
  const CableCalibration& values = cable.values;
  if (!values.load_cell_n_per_count && !values.load_cell_counts_at_zero &&
      !values.encoder_m_per_count && !values.rest_length_at_reference_m &&
      !values.stiffness_n_per_m) {
    map.scope().out.Error("calibration.empty", map.at(), map.what() + " has no measured value");
  }
}

}  // namespace description

std::optional<Calibration> LoadCalibration(const std::string& path,
                                           const std::vector<std::string>& cables,
                                           Diagnostics& out) {
  return description::LoadRobotFile(
      path, "calibration", out,
      [&](const description::Value& root, const description::Scope& scope) {
        return description::ReadCalibration(root, cables, scope);
      });
}

std::string CalibrationYaml(const Calibration& calibration) {
  using description::PlainOrQuoted, description::Quoted;
  std::string out =
      "# yaml-language-server: $schema=../schema/calibration.schema.json\n"
      "taut: 1\nkind: calibration\nname: " +
      PlainOrQuoted(calibration.name) + "\n";
  if (!calibration.description.empty()) {
    out += "description: " + Quoted(calibration.description) + "\n";
  }
  out += "cables:\n";
  for (const CableCalibration& cable : calibration.cables) {
    out += "  - cable: " + PlainOrQuoted(cable.cable) +
           "\n    measured: " + Quoted(cable.measured) + "\n";
    if (!cable.how.empty()) out += "    how: " + Quoted(cable.how) + "\n";
    const std::pair<const char*, const std::optional<double>&> values[] = {
        {"load_cell_n_per_count", cable.load_cell_n_per_count},
        {"load_cell_counts_at_zero", cable.load_cell_counts_at_zero},
        {"encoder_m_per_count", cable.encoder_m_per_count},
        {"rest_length_at_reference_m", cable.rest_length_at_reference_m},
        {"stiffness_n_per_m", cable.stiffness_n_per_m}};
    for (const auto& [key, value] : values) {
      if (!value) continue;
      char text[32];
      const auto end = base::ToChars(text, text + sizeof text, *value).ptr;
      out += std::string("    ") + key + ": " + std::string(text, end) + "\n";
    }
  }
  return out;
}

}  // namespace taut
