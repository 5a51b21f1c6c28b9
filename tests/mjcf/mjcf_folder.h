/// Fixture that imports MJCF from text
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "taut/mjcf.h"
#include "unit/description/experiment_fixture.h"

namespace taut::test {

class MjcfFolder : public ExperimentFolder {
 protected:
  /// Imports the text, and writes the result as a model, which reads it back and reports an error
  /// if the robot differs.
  std::optional<ImportedMjcf> Import(const std::string& xml, MjcfImport options = {}) {
    Write("model.xml", xml);
    out_ = {};
    auto made = ImportMjcf(Path("model.xml"), options, out_);
    EXPECT_TRUE(made) << out_.Format();
    if (!made) return made;
    Diagnostics writing;
    yaml_ = ModelYaml(made->robot, "", writing).value_or("");
    EXPECT_TRUE(writing.ok()) << writing.Format();
    return made;
  }
  /// Returns the errors of the text, without the folder's name.
  std::string Refused(const std::string& xml, MjcfImport options = {}) {
    Write("model.xml", xml);
    out_ = {};
    EXPECT_FALSE(ImportMjcf(Path("model.xml"), options, out_));
    return Said();
  }
  std::string Said() const {
    std::string text = out_.Format();
    const std::string folder = Path("");
    for (std::size_t at = text.find(folder); at != text.npos; at = text.find(folder)) {
      text.erase(at, folder.size());
    }
    return text;
  }

  Diagnostics out_;
  std::string yaml_;
};

/// Returns MJCF of a rod below a site of the world, on one tendon with these attributes.
inline std::string Hung(const std::string& tendon, const std::string& more = "") {
  return "<mujoco model=\"rod\"><worldbody><site name=\"top\" pos=\"0 0 2\"/><body name=\"rod\" "
         "pos=\"0 0 1\">"
         "<freejoint/><geom type=\"capsule\" size=\"0.02 0.3\"/><site name=\"s\" pos=\"0 0 0.3\"/>"
         "</body></worldbody><tendon><spatial name=\"c\" " +
         tendon + "><site site=\"top\"/><site site=\"s\"/></spatial></tendon>" + more + "</mujoco>";
}
inline std::string Pulled(const std::string& tendon, const std::string& actuator,
                          const std::string& more = "") {
  return Hung(tendon, "<actuator>" + actuator + "</actuator>" + more);
}

}  // namespace taut::test
