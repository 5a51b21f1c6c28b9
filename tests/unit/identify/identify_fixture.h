/// Fixture with a fit of a mass that hangs on a cable, and its files
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "taut/identify.h"
#include "unit/description/hanging_model.h"

namespace taut::test {

namespace fs = std::filesystem;

inline const std::string kExperiment = R"(taut: 1
kind: experiment
name: pull
model: model.yaml
parameters: {up_m: 0.1}
gravity_m_per_s2: [0, 0, -10]
duration_s: 6
controllers:
  - {name: play, period_s: 0.01, position: {programs: [{cables: c, change_m: [[0, 0], [1, 0], [1.1, -up_m], [3.5, -up_m], [3.6, -2 * up_m]]}]}}
)";
inline const std::string kFit = R"(taut: 1
kind: fit
name: f
experiments: [{name: a, experiment: experiment.yaml, data: a.csv, forward: static}]
estimate: [{parameter: k_n_per_m, prior: {sd: 5}}, {channel: node/*/position_z_m, offset: {sd: 0.01}}]
residuals: [{channel: node/ball/position_z_m, sd: 0.001, window: {after_setpoint_s: [1, 2]}}]
)";

/// Returns the height of the mass at rest: 1 - (L + m g / k).
inline double Height(double rest_length_m, double k_n_per_m) {
  return 1 - (rest_length_m + 0.5 * 10 / k_n_per_m);
}

class IdentifyTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("taut_identify_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    Write("model.yaml", kHangingModel);
    Write("experiment.yaml", kExperiment);
    WriteData("node/ball/position_z_m", 110, 0);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  }
  /// Writes data at rest for this k, with a delayed clock: rest lengths 0.8 from 1.1 s on, 0.7 from
  /// 3.6 s.
  void WriteData(const std::string& channel, double k_n_per_m, double late_s) {
    std::ofstream file(folder_ / "a.csv");
    file.precision(17);
    file << "time_s," << channel << "\n";
    for (int i = 0; i <= 120; ++i) {
      const double t = 0.05 * i, rest_m = t < 1.1 ? 0.9 : t < 3.6 ? 0.8 : 0.7;
      file << t + late_s << "," << Height(rest_m, k_n_per_m) << "\n";
    }
  }
  static std::string Replaced(std::string text, const std::string& old, const std::string& by) {
    const std::size_t at = text.find(old);
    EXPECT_NE(at, text.npos) << old;
    return text.replace(at, old.size(), by);
  }
  std::unique_ptr<Identification> Make(const std::string& text, const std::string& memory = {}) {
    Write("fit.yaml", text);
    out_ = {};
    const auto spec = LoadFit((folder_ / "fit.yaml").string(), {}, out_);
    if (!spec) return nullptr;
    IdentifyOptions options;
    options.threads = 2;
    if (!memory.empty()) options.memory_file = (folder_ / memory).string();
    return Identification::Make(*spec, options, out_);
  }
  std::string Wrong(const std::string& text) {
    EXPECT_FALSE(Make(text));
    std::string messages;
    for (const Diagnostic& d : Sorted(out_.items())) {
      messages += d.what + (d.hint.empty() ? "" : " (" + d.hint + ")") + "\n";
    }
    return messages;
  }
  static Residuals At(const Identification& fit, const std::vector<double>& values) {
    const std::vector<std::vector<double>> points{values};
    return fit.train().forward(points).at(0);
  }
  fs::path folder_;
  Diagnostics out_;
};

}  // namespace taut::test
