/// Folder with a small robot and an experiment, for tests of the experiment reader
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "taut/spec.h"
#include "unit/description/errors_of.h"

namespace taut::test {

/// Two rods, connected by two cables with actuators and one without
inline constexpr const char* kModel = R"(taut: 1
kind: model
name: pair
parameters: {stiffness_n_per_m: 100, height_m: 0.3}
nodes:
  a0: [0, 0, 0.1]
  a1: [1, 0, 0.1]
  b0: [0, 0, height_m]
  b1: [1, 0, height_m]
pairs:
  - {name: a, nodes: [a0, a1], tags: [rod]}
  - {name: b, nodes: [b0, b1], tags: [rod]}
  - {name: left, nodes: [a0, b0], tags: [driven, front]}
  - {name: right, nodes: [a1, b1], tags: [driven, back]}
  - {name: loose, nodes: [a0, b1], tags: [passive]}
builders:
  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1}}
  - {match: driven, cable: {stiffness_n_per_m: stiffness_n_per_m, rest_length_m: 0.15, actuator: {max_speed_m_per_s: 0.1}}}
  - {match: passive, cable: {stiffness_n_per_m: 50, rest_length_m: 0.9}}
)";

inline constexpr const char* kExperiment = R"(taut: 1
kind: experiment
name: trial
model: model.yaml
parameters: {push_n: 10}
terrain:
  - {name: ground, plane: {height_m: 0, friction: 0.5}}
duration_s: 10
controllers:
  - name: hold
    impedance:
      gains:
        - {cables: driven, position_gain_n_per_m: 500, velocity_gain_n_s_per_m: 150}
      set_points:
        - {cables: left, tension_n: 28, length_m: 0.19}
        - {cables: right, tension_n: 10, length_m: 0.18}
timeline:
  phases: {before: [1, 2]}
  events:
    - push: {name: tap, node: a1, direction: [0, 0, 2], force_n: [[3, 0], [4, push_n]]}
record: {rate_hz: 50}
)";

class ExperimentFolder : public testing::Test {
 protected:
  ExperimentFolder() : folder_(std::filesystem::path(testing::TempDir()) / TestName()) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    Write("model.yaml", kModel);
    Write("trial.yaml", kExperiment);
  }
  ~ExperimentFolder() override { std::filesystem::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }

  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  /// Writes the experiment with one text replaced by another.
  void Change(const std::string& old_text, const std::string& new_text) const {
    ChangeFile("trial.yaml", kExperiment, old_text, new_text);
  }
  void ChangeFile(const std::string& name, std::string text, const std::string& old_text,
                  const std::string& new_text) const {
    const std::size_t place = text.find(old_text);
    ASSERT_NE(place, std::string::npos) << old_text;
    Write(name, text.replace(place, old_text.size(), new_text));
  }

  /// Loads the experiment and expects no errors.
  ExperimentSpec Load(const std::string& name = "trial.yaml",
                      const Overrides& overrides = {}) const {
    Diagnostics out;
    const auto experiment = LoadExperiment(Path(name), overrides, out);
    EXPECT_TRUE(experiment) << out.Format();
    return experiment.value_or(ExperimentSpec{});
  }

  /// Returns the errors of the experiment, without the folder's name.
  std::string Complaints(const std::string& name = "trial.yaml",
                         const Overrides& overrides = {}) const {
    Diagnostics out;
    const bool loaded = LoadExperiment(Path(name), overrides, out).has_value();
    EXPECT_EQ(loaded, out.ok()) << out.Format();
    return Without(folder_.string() + "/", ErrorsOf(out));
  }

  static std::string Without(const std::string& word, std::string text) {
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word)) {
      text.erase(at, word.size());
    }
    return text;
  }

 private:
  static std::string TestName() {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    return std::string("taut_") + test->test_suite_name() + "_" + test->name();
  }
  std::filesystem::path folder_;
};

/// For errors in the experiment file only
class ExperimentErrors : public ExperimentFolder {
 protected:
  /// Expects that the errors after a change equal `expected`, in lines without the file's name.
  void Expect(const std::string& old_text, const std::string& new_text,
              const std::string& expected) {
    Change(old_text, new_text);
    EXPECT_EQ(Without("trial.yaml:", Complaints()), expected + "\n")
        << "with \"" << new_text << "\" for \"" << old_text << "\"";
  }
};

}  // namespace taut::test
