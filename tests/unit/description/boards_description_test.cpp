// The key `boards` of experiment files: values, errors, resolved files
#include "unit/description/experiment_fixture.h"

namespace taut::test {
namespace {

const std::string kShipped = std::string(TAUT_SOURCE_DIR) + "/share/experiments/";

struct BoardsFile : ExperimentFolder {
  std::optional<ExperimentSpec> Read(const std::string& text) {
    Write("boards.yaml", text);
    out = Diagnostics();
    return LoadExperiment(Path("boards.yaml"), {}, out);
  }
  /// Reads an experiment with this base and line of boards.
  std::optional<ExperimentSpec> Read(const std::string& base, const std::string& lines) {
    return Read("taut: 1\nkind: experiment\nname: b\nbase: " + kShipped + base + "\n" + lines +
                "\n");
  }
  std::string Ids() const {
    std::string ids;
    for (const auto& item : out.items()) ids += (ids.empty() ? "" : " ") + std::string(item.id);
    return ids;
  }

  Diagnostics out;
};

TEST_F(BoardsFile, BecomeTheLastController) {
  const auto experiment =
      Read("push_20n_motors.yaml",
           "boards: {velocity_input_scale: 0.2, hold_s: 3 s, capture: true, encoder_lines: 12, "
           "force_p_per_n: 0.0133, load_cell: {noise_counts: 0}}");
  ASSERT_TRUE(experiment) << out.Format();
  ASSERT_EQ(experiment->controllers.size(), 2u);
  const BoardsSpec* const boards = BoardsOf(experiment->controllers);
  ASSERT_TRUE(boards);
  EXPECT_EQ(experiment->controllers[1].name, "boards");
  EXPECT_EQ(boards->velocity_input_scale, 0.2);
  EXPECT_EQ(boards->hold_s, 3);
  EXPECT_TRUE(boards->capture);
  EXPECT_EQ(boards->encoder_lines, 12);
  EXPECT_EQ(boards->force_p_per_n, 0.0133);
  EXPECT_EQ(boards->force_i_per_n_s, 0.6);
  EXPECT_EQ(boards->load_cell.noise_counts, 0);
  const auto again = Read(ResolvedYaml(*experiment));
  ASSERT_TRUE(again) << out.Format();
  EXPECT_EQ(ResolvedYaml(*again).substr(ResolvedYaml(*again).find("taut: 1")),
            ResolvedYaml(*experiment).substr(ResolvedYaml(*experiment).find("taut: 1")));
}

TEST_F(BoardsFile, AllMistakesAreNamed) {
  EXPECT_FALSE(Read("push_20n.yaml",
                    "sensors: {period_s: 0.001}\nboards: {force_p_per_n: -1, winding_limits: 3}"));
  EXPECT_EQ(Ids(),
            "value.out_of_range key.unknown boards.sensors_given_twice "
            "boards.not_a_motor");
  EXPECT_FALSE(
      Read("push_20n_motors.yaml", "boards: {broadcast_s: 0.0105, broadcast_delay_s: 0.02}"));
  EXPECT_EQ(Ids(), "boards.time_not_whole boards.delay_too_long");
  EXPECT_FALSE(Read("push_20n_motors.yaml", "controllers: []\nboards: {capture: true}"));
  EXPECT_EQ(Ids(), "boards.capture_without_effect");
  EXPECT_FALSE(
      Read("push_20n_motors.yaml",
           "controllers:\n  - name: boards\n    impedance:\n      gains: [{cables: "
           "outer_top_1, position_gain_n_per_m: 1, velocity_gain_n_s_per_m: 1}]\n      "
           "set_points: [{cables: outer_top_1, tension_n: 5, length_m: 0.2}]\nboards: {}"));
  EXPECT_EQ(Ids(), "boards.name_taken boards.mixed_modes");
  EXPECT_FALSE(Read("hang.yaml", "boards: {}"));
  EXPECT_EQ(Ids(), "boards.no_motors");
}

}  // namespace
}  // namespace taut::test
