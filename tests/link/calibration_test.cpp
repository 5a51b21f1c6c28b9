// Calibration files: contents, errors and their places, and a round trip of written numbers.
#include "taut/calibration.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace taut {
namespace {

const std::vector<std::string> kCalibratedCables{"front", "back", "left"};

class CalibrationFile : public testing::Test {
 protected:
  std::optional<Calibration> Load(const std::string& text) {
    const auto path = std::filesystem::temp_directory_path() /
                      ("taut_calibration_" + std::to_string(getpid()) + ".yaml");
    std::ofstream(path) << text;
    out_ = {};
    auto calibration = LoadCalibration(path.string(), kCalibratedCables, out_);
    std::filesystem::remove(path);
    return calibration;
  }
  std::optional<Calibration> LoadCables(const std::string& cables) {
    return Load("taut: 1\nkind: calibration\nname: c\nparameters: {gain: 0.15}\ncables:\n" +
                cables);
  }
  /// Returns the diagnostics of one entry, which begins on line 6: "LINE: message (hint)".
  std::string Wrong(const std::string& entry) {
    EXPECT_FALSE(LoadCables("  - " + entry + "\n")) << entry;
    std::string messages;
    for (const Diagnostic& d : out_.items()) {
      messages += std::to_string(d.at.line) + ": " + d.what +
                  (d.hint.empty() ? "" : " (" + d.hint + ")") + "\n";
    }
    return messages;
  }
  Diagnostics out_;
};

TEST_F(CalibrationFile, IsRead) {
  const auto read = LoadCables(
      "  - {cable: back, measured: \"2026-11-23\", how: by hand, load_cell_n_per_count: 2 * gain}\n"
      "  - {cable: left, measured: \"2026-01-02\", load_cell_counts_at_zero: 30,\n"
      "     encoder_m_per_count: 1.3e-5, rest_length_at_reference_m: 0.21, stiffness_n_per_m: "
      "230}\n");
  ASSERT_TRUE(read) << out_.Format();
  EXPECT_EQ(read->name, "c");
  ASSERT_EQ(read->cables.size(), 2u);
  EXPECT_EQ(read->cables[0].cable, "back");
  EXPECT_EQ(read->cables[0].measured, "2026-11-23");
  EXPECT_EQ(read->cables[0].how, "by hand");
  EXPECT_EQ(read->cables[0].load_cell_n_per_count, 0.3);
  EXPECT_FALSE(read->cables[0].load_cell_counts_at_zero);
  EXPECT_FALSE(read->cables[0].stiffness_n_per_m);
  EXPECT_EQ(read->cables[1].load_cell_counts_at_zero, 30);
  EXPECT_EQ(read->cables[1].encoder_m_per_count, 1.3e-5);
  EXPECT_EQ(read->cables[1].rest_length_at_reference_m, 0.21);
  EXPECT_EQ(read->cables[1].stiffness_n_per_m, 230);
}

TEST_F(CalibrationFile, WhatIsWrongIsNamedWithItsLine) {
  const std::string day = "measured: \"2026-11-23\"";
  EXPECT_EQ(Wrong("{cable: bak, " + day + ", stiffness_n_per_m: 1}")
                .rfind("6: there is no actuated cable \"bak\" (", 0),
            0u)
      << Wrong("{cable: bak, " + day + ", stiffness_n_per_m: 1}");
  EXPECT_EQ(Wrong("{cable: back, " + day + "}"), "6: cable has no measured value\n");
  for (const char* text : {"yesterday", "2026-13-01", "2026-00-01", "2026-11-32", "2026-11-00",
                           "26-11-23", "2026/11/23", "2026-11-2x", "1066-11-23", "2026-11-023"}) {
    EXPECT_EQ(Wrong(std::string("{cable: back, measured: \"") + text + "\", stiffness_n_per_m: 1}"),
              std::string("6: \"") + text +
                  "\" is not a date (expected year, month and day, such as 2026-11-23)\n");
  }
  for (const char* value :
       {"load_cell_n_per_count: 0", "load_cell_n_per_count: 11", "load_cell_counts_at_zero: -1",
        "load_cell_counts_at_zero: 1024", "encoder_m_per_count: 0", "encoder_m_per_count: 0.01",
        "rest_length_at_reference_m: -0.1", "rest_length_at_reference_m: 3",
        "stiffness_n_per_m: 0.5", "stiffness_n_per_m: 2e6", "stiffness_n_per_m: soft",
        "colour: red"}) {
    const std::string said = Wrong("{cable: back, " + day + ", " + value + "}");
    const std::string key = std::string(value).substr(0, std::string(value).find(':'));
    EXPECT_EQ(said.rfind("6: ", 0), 0u) << value << " " << said;
    EXPECT_TRUE(said.find(key) != std::string::npos || said.find("soft") != std::string::npos)
        << value << " " << said;
  }
  EXPECT_NE(Wrong("{cable: back, stiffness_n_per_m: 1}").find("measured"), std::string::npos);
  EXPECT_NE(Wrong("{" + day + ", stiffness_n_per_m: 1}").find("cable"), std::string::npos);
  EXPECT_EQ(Wrong("{cable: back, " + day + ", stiffness_n_per_m: 1}\n  - {cable: back, " + day +
                  ", stiffness_n_per_m: 2}"),
            "7: the cable \"back\" has two entries\n");
}

TEST_F(CalibrationFile, AllMistakesAreSaidAtOnce) {
  EXPECT_FALSE(
      LoadCables("  - {cable: bak, measured: monday, stiffness_n_per_m: 1}\n"
                 "  - {cable: back, measured: \"2026-11-23\"}\n"));
  EXPECT_EQ(out_.items().size(), 3u) << out_.Format();
  EXPECT_FALSE(Load("taut: 1\nkind: faults\nname: c\ncables: []\n"));
  EXPECT_FALSE(Load("taut: 1\nkind: calibration\nname: c\n"));
  EXPECT_FALSE(LoadCalibration("/nowhere.yaml", kCalibratedCables, out_));
}

TEST_F(CalibrationFile, IsReadAsItWasWritten) {
  Calibration written;
  written.name = "bench_2";
  written.description = "Two cables, \"by hand\";\n5 kg at C:\\lab.";
  written.cables = {{"front",
                     "2026-11-23",
                     "Weights: 1, 2 and 5 kg # in air",
                     0.1 + 0.2,
                     31.4999999999999,
                     {},
                     {},
                     {}},
                    {"left", "2025-02-28", "", {}, {}, 1.0 / 74627, 0.2, 227.3}};
  const auto read = Load(CalibrationYaml(written));
  ASSERT_TRUE(read) << out_.Format() << CalibrationYaml(written);
  EXPECT_EQ(read->name, written.name);
  EXPECT_EQ(read->description, written.description);
  ASSERT_EQ(read->cables.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read->cables[i].cable, written.cables[i].cable);
    EXPECT_EQ(read->cables[i].measured, written.cables[i].measured);
    EXPECT_EQ(read->cables[i].how, written.cables[i].how);
    EXPECT_EQ(read->cables[i].load_cell_n_per_count, written.cables[i].load_cell_n_per_count);
    EXPECT_EQ(read->cables[i].load_cell_counts_at_zero, written.cables[i].load_cell_counts_at_zero);
    EXPECT_EQ(read->cables[i].encoder_m_per_count, written.cables[i].encoder_m_per_count);
    EXPECT_EQ(read->cables[i].rest_length_at_reference_m,
              written.cables[i].rest_length_at_reference_m);
    EXPECT_EQ(read->cables[i].stiffness_n_per_m, written.cables[i].stiffness_n_per_m);
  }
  EXPECT_EQ(CalibrationYaml(*read), CalibrationYaml(written));
}

TEST_F(CalibrationFile, ThatIsShippedIsRead) {
  Diagnostics out;
  const auto read =
      LoadCalibration(TAUT_SOURCE_DIR "/share/calibrations/as_assumed.yaml", {"outer_top_1"}, out);
  ASSERT_TRUE(read) << out.Format();
  EXPECT_NEAR(*read->cables[0].encoder_m_per_count, 1.34e-5, 1e-7);
}

}  // namespace
}  // namespace taut
