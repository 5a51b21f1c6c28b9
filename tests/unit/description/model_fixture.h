/// Small models as texts, read like files
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>

#include "coded.h"
#include "taut/spec.h"
#include "unit/description/errors_of.h"

namespace taut {

struct Read {
  std::optional<RobotSpec> robot;
  std::string found;   ///< Errors and warnings as printed, with the file name robot.yaml.
  std::string coded;   ///< The errors as place, identifier and values (coded.h).
  std::string errors;  ///< The errors only.
};

/// Reads a model that starts with these three lines; `yaml` starts in line 4.
inline Read ReadModel(const std::string& yaml, const Overrides& overrides = {}) {
  const ::testing::TestInfo& test = *::testing::UnitTest::GetInstance()->current_test_info();
  const std::string path =
      ::testing::TempDir() + test.test_suite_name() + "." + test.name() + ".yaml";
  std::ofstream(path) << "taut: 1\nkind: model\nname: robot\n" << yaml;
  Diagnostics out;
  auto robot = LoadRobot(path, overrides, out);
  EXPECT_EQ(robot.has_value(), out.ok());
  const auto shown = [&](std::string text) {
    for (std::size_t at; (at = text.find(path)) != std::string::npos;) {
      text.replace(at, path.size(), "robot.yaml");
    }
    return text;
  };
  std::remove(path.c_str());
  return {std::move(robot), shown(out.Format()), shown(test::CodedErrors(out)),
          shown(ErrorsOf(out))};
}

inline RobotSpec Good(const std::string& yaml, const Overrides& overrides = {}) {
  const Read read = ReadModel(yaml, overrides);
  EXPECT_EQ(read.errors, "");
  return read.robot.value_or(RobotSpec{});
}

inline std::string Errors(const std::string& yaml) { return ReadModel(yaml).errors; }

/// Returns the errors without their sentences: `robot.yaml:6:41: error: value.out_of_range
/// rod.radius_m -0.1`.
inline std::string CodedErrors(const std::string& yaml) { return ReadModel(yaml).coded; }

/// A small valid model: two rods, 10 cm apart, and a cable between them
inline std::string TwoRods(const std::string& cable_keys = "rest_length_m: 0.05",
                           const std::string& more = "") {
  return "nodes: {a: [0, 0, 0], b: [1, 0, 0], c: [0, 0.1, 0], d: [1, 0.1, 0]}\n"  // line 4
         "pairs:\n"
         "  - {nodes: [a, b], tags: [rod]}\n"
         "  - {nodes: [c, d], tags: [rod]}\n"
         "  - {nodes: [a, c], tags: [cable]}\n"
         "builders:\n"
         "  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1}}\n"  // line 10
         "  - {match: cable, cable: {stiffness_n_per_m: 100, " +
         cable_keys + "}}\n" + more;
}

/// A model with one rod; the text `rod` is in line 6, column 24.
inline std::string OneRod(const std::string& rod) {
  return "nodes: {a: [0, 0, 0], b: [1, 0, 0]}\npairs: [{nodes: [a, b], tags: [rod]}]\n"
         "builders: [{match: rod, rod: " +
         rod + "}]\n";
}

inline bool Has(const Tags& tags, const char* tag) {
  return std::find(tags.begin(), tags.end(), tag) != tags.end();
}

/// A part with a rod, and its builder; a structure must follow
inline const char* const kBars =
    "parts: {bar: {nodes: {a: [0, 0, 0], b: {at_m: [1, 0, 0], tags: [far]}}, pairs: [{nodes: [a, "
    "b], tags: [rod]}]}}\n"
    "builders:\n"
    "  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1}}\n";

}  // namespace taut
