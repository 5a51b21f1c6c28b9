// Import of NTRT's controllers with feedback: a .json file and the networks that it names
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "taut/gait.h"

namespace taut {
namespace {

class NtrtFeedback : public testing::Test {
 protected:
  NtrtFeedback() : folder_(std::filesystem::path(testing::TempDir()) / "taut_ntrt_feedback") {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_ / "logs");
  }
  ~NtrtFeedback() override { std::filesystem::remove_all(folder_); }
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  /// Writes a controller whose edge i has the weight i / 100; all have the phase 0.75.
  void WriteController(const std::string& more, int edges = 100) const {
    std::string text = "{\"edgeVals\": {\"params\": [";
    for (int i = 0; i < edges; ++i) {
      text += (i > 0 ? "," : "") + std::string("[0.") + (i < 10 ? "0" : "") + std::to_string(i) +
              ", 0.75]";
    }
    Write("c.json",
          text + "]},\n\"nodeVals\": {\"params\": [[0.5, 0.25, 0.5, 1, 0.5]]}" + more + "}");
  }
  static std::string Network(const std::string& key, int said) {
    return ",\n\"" + key + "\": {\"params\": {\"neuralFilename\": \"logs/" + key +
           ".nnw\", \"numStates\": 2, \"numHidden\": 1, \"numActions\": " + std::to_string(said) +
           "}}";
  }
  std::optional<GaitSpec> Import(Diagnostics& out) const {
    return ImportNtrtGait((folder_ / "c.json").string(), NtrtCableOrder::kPaper2015, out);
  }
  std::string Complaints() const {
    Diagnostics out;
    EXPECT_FALSE(Import(out));
    std::string text = out.Format();
    const std::string head = folder_.string();
    for (std::size_t at; (at = text.find(head)) != text.npos;) text.erase(at, head.size());
    return text;
  }
  std::filesystem::path folder_;
};

TEST_F(NtrtFeedback, NumbersAreScaledAndPlaced) {
  WriteController(Network("feedbackVals", 3) + Network("goalVals", 24));
  Write("logs/feedbackVals.nnw", "1,2,3,4,5,6,7,8,9");
  std::string goal = "1,2,3";
  for (int i = 0; i < 48; ++i) goal += "," + std::to_string(i);
  Write("logs/goalVals.nnw", goal);
  Diagnostics out;
  const auto gait = Import(out);
  ASSERT_TRUE(gait) << out.Format();
  const FeedbackCpgGait& cpg = *gait->feedback_cpg;
  EXPECT_NEAR(cpg.frequency_hz, 15 / (2 * std::numbers::pi), 1e-12);         // half of 30 rad/s
  EXPECT_NEAR(cpg.oscillators[0].amplitude, 0.01 * std::sqrt(75.0), 1e-12);  // a quarter of 300
  EXPECT_NEAR(cpg.convergence_per_s, 75.0, 1e-12);
  EXPECT_NEAR(cpg.frequency_gain_hz_per_s, 4.75 / (2 * std::numbers::pi), 1e-12);  // -0.5..10
  EXPECT_NEAR(cpg.amplitude_gain, 200.0 / 75.0, 1e-12);
  EXPECT_NEAR(cpg.phase_gain_rad_per_s, 2.89, 1e-12);  // -0.5..6.28
  EXPECT_EQ(cpg.groups.front().name, "rp0.0.0");       // this group has the weight of the last edge
  EXPECT_NEAR(cpg.groups.front().weight, 99.0, 1e-12);
  EXPECT_NEAR(cpg.groups[99].phase_rad, std::numbers::pi / 2, 1e-12);
  // A bias is a neuron with the output -1.
  const NetworkSpec& cable = *cpg.cable_network;
  ASSERT_EQ(cable.hidden.size(), 1u);
  EXPECT_EQ(cable.hidden[0].weights, (std::vector<double>{1, 2}));
  EXPECT_EQ(cable.hidden[0].bias, -3);
  ASSERT_EQ(cable.outputs.size(), 3u);
  EXPECT_EQ(cable.outputs[2].name, "phase");
  EXPECT_EQ(cable.outputs[2].weights, (std::vector<double>{6}));
  EXPECT_EQ(cable.outputs[2].bias, -9);
  // NTRT's x is taut's y, its z is taut's x.
  const NetworkSpec& heading = *cpg.goal_network;
  EXPECT_EQ(heading.hidden[0].weights, (std::vector<double>{2, 1}));
  ASSERT_EQ(heading.outputs.size(), 24u);
  EXPECT_EQ(heading.outputs[4].name, "outer_right_amplitude");
  EXPECT_EQ(heading.outputs[4].weights, (std::vector<double>{4}));
  EXPECT_EQ(heading.outputs[4].bias, -28);
}

TEST_F(NtrtFeedback, WhatIsWrongIsSaidWithItsPlace) {
  WriteController("", 99);
  EXPECT_EQ(Complaints(),
            "/c.json:1:14: error: edgeVals.params must have 100 rows, as in NTRT's controllers of "
            "spines with eight cables per joint\n");
  WriteController(Network("feedbackVals", 3));
  Write("logs/feedbackVals.nnw", "1,2,3");
  EXPECT_EQ(Complaints(),
            "/logs/feedbackVals.nnw:1:1: error: the file must contain 9 numbers, for a network "
            "with 2, 1 and 3 neurons\n");
  WriteController(Network("goalVals", 1));
  EXPECT_EQ(
      Complaints(),
      "/c.json:3:24: error: goalVals: a network with 2 inputs and 1 outputs cannot be imported "
      "(expected 2 inputs and 24 outputs; gaits have no networks that set tensions)\n");
}

}  // namespace
}  // namespace taut
