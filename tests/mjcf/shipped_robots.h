/// Models shipped with taut, for tests of MJCF
#pragma once

#include <stdexcept>
#include <string>

#include "taut/mjcf.h"

namespace taut::test {

/// Shipped models that MJCF can represent, with all kinds of elements that it has
inline constexpr const char* kExportable[] = {"hanging_mass",
                                              "prism3",
                                              "rod",
                                              "six_strut",
                                              "superball",
                                              "superball_payload",
                                              "superball_probe",
                                              "tetrahedral_complex",
                                              "tetraspine12",
                                              "tetraspine3",
                                              "tetraspine6_long"};

inline RobotSpec Shipped(const std::string& name) {
  Diagnostics out;
  auto robot = LoadRobot(TAUT_SOURCE_DIR "/share/models/" + name + ".yaml", {}, out);
  if (!robot) throw std::runtime_error(out.Format());
  return std::move(*robot);
}

inline std::string Exported(const ModelDef& def, const MjcfExport& options = {}) {
  Diagnostics out;
  auto text = ExportMjcf(def, options, out);
  if (!text) throw std::runtime_error(out.Format());
  return std::move(*text);
}

}  // namespace taut::test
