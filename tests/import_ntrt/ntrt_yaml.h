/// Fixture that imports NTRT structures from text
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "taut/import_ntrt.h"
#include "taut/spec.h"

namespace taut {

namespace fs = std::filesystem;

inline const std::string kTwoRods =
    "nodes:\n"
    "  a: [0, 0, 0]\n"
    "  b: [0, 4, 0]\n"
    "  c: [3, 0, 0]\n"
    "  d: [3, 4, 0]\n"
    "pair_groups:\n"
    "  rod: [[a, b], [c, d]]\n"
    "  string: [[a, c], [b, d]]\n";
inline const std::string kBuilders =
    "builders:\n"
    "  rod: {class: tgRodInfo, parameters: {radius: 0.2, density: 2}}\n"
    "  string: {class: tgBasicActuatorInfo, parameters: {stiffness: 100, pretension: 50}}\n";

class NtrtYaml : public testing::Test {
 protected:
  NtrtYaml() : folder_(fs::path(testing::TempDir()) / Name()) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~NtrtYaml() override { fs::remove_all(folder_); }

  static std::string Name() {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    return std::string("taut_") + test.test_suite_name() + test.name();
  }
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  std::string Shown(const Diagnostics& found) const {
    std::string text = found.Format();
    const std::string head = (folder_ / "").string();
    for (std::size_t at; (at = text.find(head)) != text.npos;) text.erase(at, head.size());
    return text;
  }
  std::optional<NtrtImport> Import(const std::string& yaml, Diagnostics& out,
                                   NtrtOptions options = {0.1, false, ""}) const {
    Write("s.yaml", yaml);
    return ImportNtrt((folder_ / "s.yaml").string(), options, out);
  }
  std::string Complaints(const std::string& yaml) const {
    Diagnostics out;
    const auto import = Import(yaml, out);
    EXPECT_EQ(import.has_value(), out.ok());
    return Shown(out);
  }
  /// Imports the text. Returns the robot of the resulting model.
  RobotSpec Robot(const std::string& yaml, const NtrtOptions& options = {0.1, false, ""}) {
    Diagnostics out;
    const auto import = Import(yaml, out, options);
    EXPECT_TRUE(import) << Shown(out);
    if (!import) return {};
    text_ = import->model_yaml;
    counts_ = import->counts;
    dropped_ = import->dropped;
    warnings_ = Shown(out);
    Write("model.yaml", text_);
    Diagnostics found;
    const auto robot = LoadRobot((folder_ / "model.yaml").string(), {}, found);
    EXPECT_TRUE(robot) << found.Format() << text_;
    EXPECT_EQ(found.Format(), "");  // no warnings either
    return robot.value_or(RobotSpec{});
  }

  fs::path folder_;
  std::string text_, warnings_;
  std::vector<std::string> dropped_;
  NtrtCounts counts_;
};

}  // namespace taut
