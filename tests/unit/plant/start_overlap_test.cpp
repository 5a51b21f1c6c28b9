// Robots that penetrate the ground or themselves at the start
#include "taut/run.h"
#include "unit/description/experiment_fixture.h"

namespace taut::test {
namespace {

class StartOverlap : public ExperimentFolder {
 protected:
  /// Returns the messages of `CheckStart` for the experiment with a ground at this height [m]; the
  /// lower rod's underside is at 0.09 m.
  std::string Found(const std::string& ground_m, const std::string& more = "") {
    std::string text = kExperiment;
    const std::string ground = "height_m: 0,";
    text.replace(text.find(ground), ground.size(), "height_m: " + ground_m + ",");
    Write("trial.yaml", text + more);
    Diagnostics out;
    const ExperimentSpec experiment = Load();
    const bool good = CheckStart(experiment.robot, experiment.start, out);
    EXPECT_EQ(good, out.ok());
    return Without(Path(""), out.Format());
  }
  /// Returns the messages of a run without a previous check.
  std::string RunFound() {
    ExperimentSpec experiment = Load();
    experiment.duration_s = 0.001;
    Diagnostics out;
    const bool ran = RunExperiment(experiment, {}, out).has_value();
    EXPECT_EQ(ran, out.ok());
    return Without(Path(""), out.Format());
  }
};

TEST_F(StartOverlap, TouchingAndAHundredthOfTheRadiusAreNothing) {
  EXPECT_EQ(Found("0.09"), "");
  EXPECT_EQ(Found("0.09 + 0.00009"), "");
}

TEST_F(StartOverlap, LessThanTheRadiusIsAWarningWithPairAndDepth) {
  EXPECT_EQ(
      Found("0.096"),
      "trial.yaml:7:5: warning: the rod \"a\" is 0.006 m deep in the terrain \"ground\" at the "
      "start (the contact solver separates them without adding velocity)\n");
  EXPECT_EQ(RunFound(), "");
  // If it settles first, the described pose is not its start.
  EXPECT_EQ(Found("0.096", "start: settled\n"), "");
}

TEST_F(StartOverlap, MoreThanTheRadiusIsAnErrorWithPairAndDepth) {
  const std::string error =
      "trial.yaml:7:5: error: the rod \"a\" is 0.011 m deep in the terrain \"ground\" at the "
      "start, "
      "more than half the thickness of the thinner one, 0.01 m (move the robot with `place`)\n";
  EXPECT_EQ(Found("0.101"), error);
  EXPECT_EQ(RunFound(), error);
  EXPECT_EQ(Found("0.101", "start: settled\n"), error);
}

TEST_F(StartOverlap, ASettledFloatingStartIsJudgedWhereItEnds) {
  EXPECT_EQ(Found("0.5", "start: settled_floating\n"), "");
  EXPECT_NE(RunFound().find("deep in the terrain \"ground\" at the start"), std::string::npos);
}

TEST_F(StartOverlap, BodiesInEachOtherAreNamedBoth) {
  ChangeFile("model.yaml", kModel, "height_m: 0.3", "height_m: 0.119");
  EXPECT_EQ(Found("0").substr(0, 26), "model.yaml:11:5: warning: ");
  ChangeFile("model.yaml", kModel, "height_m: 0.3", "height_m: 0.109");
  EXPECT_EQ(Found("0"),
            "model.yaml:11:5: error: the rod \"a\" and the rod \"b\" overlap by 0.011 m at "
            "the start, more than half the thickness of the thinner one, 0.01 m (move one of them, "
            "write `collides: false`, or list both bodies in `apart` of the model)\n");
}

TEST_F(StartOverlap, BoxesOfTerrainAreTerrain) {
  EXPECT_EQ(Found("0", "place: {at_m: [0, 0, 0.1]}\n"), "");
  std::string text = kExperiment;
  const std::string ground = "plane: {height_m: 0, friction: 0.5}";
  text.replace(text.find(ground), ground.size(),
               "box: {center_m: [0.5, 0, 0], size_m: [4, 4, 0.208]}");
  Write("trial.yaml", text);
  Diagnostics out;
  const ExperimentSpec experiment = Load();
  EXPECT_FALSE(CheckStart(experiment.robot, experiment.start, out));
  EXPECT_NE(out.Format().find("trial.yaml:7:5: error: the rod \"a\" is 0.014 m deep in the terrain "
                              "\"ground\" at the start"),
            std::string::npos)
      << out.Format();
}

}  // namespace
}  // namespace taut::test
