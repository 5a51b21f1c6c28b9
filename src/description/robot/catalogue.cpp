// Loader of catalogue files.
#include "taut/catalogue.h"

#include "description/robot/catalogue_keys.h"
#include "description/robot/robot_file.h"
#include "description/yaml/read_keys.h"

namespace taut {
namespace description {
namespace {

Catalogue ReadCatalogue(const Value& root, const Scope& scope) {
  CatalogueFileText text;
  ReadMapping(root, "", scope, text);
  Catalogue catalogue;
  catalogue.name = text.name;
  catalogue.description = text.description;
  catalogue.factor = text.factor;
  catalogue.stiffness_tolerance = text.stiffness_tolerance;
  for (auto& item : text.motors.items) {
    item.value.values.name = item.name;
    catalogue.motors.push_back(item.value.values);
  }
  for (auto& item : text.springs.items) {
    item.value.values.name = item.name;
    catalogue.springs.push_back(item.value.values);
  }
  return catalogue;
}

}  // namespace

void Check(const MapReader& map, CatalogueMotorText& motor) {
  if (motor.values.peak_torque_n_m < motor.values.rated_torque_n_m) {
    map.Error("catalogue.peak_below_rated_torque", "peak_torque_n_m",
              "the peak torque is below the rated torque");
  }
  if (motor.values.rated_power_w && motor.values.peak_power_w &&
      *motor.values.peak_power_w < *motor.values.rated_power_w) {
    map.Error("catalogue.peak_below_rated_power", "peak_power_w",
              "the peak power is below the rated power");
  }
}

void Check(const MapReader& map, CatalogueFileText& catalogue) {
  if (catalogue.motors.items.empty() && catalogue.springs.items.empty()) {
    map.scope().out.Error("catalogue.empty", map.at(),
                          "the catalogue has neither motors nor springs");
  }
}

}  // namespace description

std::optional<Catalogue> LoadCatalogue(const std::string& path, Diagnostics& out) {
  return description::LoadRobotFile(
      path, "catalogue", out, [&](const description::Value& root, const description::Scope& scope) {
        return description::ReadCatalogue(root, scope);
      });
}

}  // namespace taut
