// Gaits as inputs of controllers in experiment files
#include <set>

#include "taut/gait.h"
#include "taut/study.h"
#include "unit/description/experiment_fixture.h"
#include "unit/description/gait_texts.h"

namespace taut::test {
namespace {

class VelocityInput : public ExperimentErrors {};

TEST_F(VelocityInput, GoesWithImpedanceAndNamesAGait) {
  Write("g.yaml", kSine);
  const std::string hold = "  - name: hold\n";
  Expect(hold, hold + "    velocity_input: {gait: h.yaml}\n",
         "11:28: error: velocity_input.gait: there is no file \"h.yaml\" (paths are relative to "
         "the folder of the file that contains them)");
  Expect(hold, hold + "    velocity_input: {gait: g.yaml, period_s: 0}\n",
         "11:46: error: velocity_input.period_s must be positive, got 0");
  Expect(hold, hold + "    velocity_input: {period: 1}\n",
         "11:21: error: velocity_input needs the key \"gait\"\n"
         "11:22: error: unknown key \"period\" in velocity_input (did you mean \"period_s\"?)");
  Change(hold, hold + "    velocity_input: {gait: model.yaml}\n");
  EXPECT_EQ(Complaints(),
            "model.yaml:2:7: error: kind must be gait, got model (use `taut check` for files of "
            "this kind)\n");
  Change("controllers:\n",
         "controllers:\n  - {name: p, velocity_input: {gait: g.yaml}, position: {programs: []}}\n");
  EXPECT_EQ(
      Without("trial.yaml:", Complaints()),
      "10:15: error: velocity_input has no effect with position (it sets V0 of `impedance`)\n");
}

TEST_F(VelocityInput, TheResolvedExperimentHoldsTheGaitItself) {
  for (const char* text : {kSine, kCpg, kTable}) {
    Write("g.yaml", text);
    Change("  - name: hold\n",
           "  - name: hold\n    velocity_input: {gait: g.yaml, period_s: 0.02, phase_s: 1}\n");
    const ExperimentSpec experiment = Load();
    ASSERT_EQ(experiment.files.size(), 3u);
    Write("resolved.yaml", ResolvedYaml(experiment));
    std::filesystem::remove(Path("g.yaml"));
    const ExperimentSpec back = Load("resolved.yaml");
    ASSERT_TRUE(back.controllers.at(0).velocity_input);
    const GaitInputSpec& input = *back.controllers[0].velocity_input;
    EXPECT_EQ(input.clock.period_s, 0.02);
    EXPECT_EQ(input.clock.phase_s, 1.0);
    EXPECT_EQ(GaitYaml(input.gait), GaitYaml(experiment.controllers[0].velocity_input->gait));
  }
}

TEST_F(VelocityInput, TheGaitIsPartOfTheHash) {
  Write("g.yaml", kSine);
  Change("  - name: hold\n", "  - name: hold\n    velocity_input: {gait: g.yaml}\n");
  const auto before = Load().input_hash;
  Write("g.yaml", std::string(kSine) + "# faster\n");
  EXPECT_NE(Load().input_hash, before);
}

class RestLengthInput : public ExperimentErrors {
 protected:
  /// Writes the experiment with a controller that has these lines instead of its impedance.
  void WriteWith(const std::string& lines) {
    std::string text = kExperiment;
    const std::size_t from = text.find("    impedance:"), to = text.find("timeline:");
    Write("trial.yaml", text.replace(from, to - from, lines));
  }
  void ExpectWith(const std::string& lines, const std::string& expected) {
    WriteWith(lines);
    EXPECT_EQ(Without("trial.yaml:", Complaints()), expected) << lines;
  }
};

TEST_F(RestLengthInput, StandsAloneOrBesideAProgram) {
  Write("g.yaml", WithLengths(kSine));
  WriteWith("    rest_length_input: {gait: g.yaml, period_s: 0.02, phase_s: 0.5}\n");
  const ExperimentSpec alone = Load();
  const ControllerSpec& controller = alone.controllers.at(0);
  EXPECT_FALSE(controller.impedance);
  EXPECT_FALSE(controller.velocity_input);
  EXPECT_TRUE(controller.position.empty());
  ASSERT_TRUE(controller.rest_length_input);
  EXPECT_EQ(controller.rest_length_input->clock.period_s, 0.02);
  EXPECT_EQ(controller.rest_length_input->clock.phase_s, 0.5);
  EXPECT_EQ(controller.rest_length_input->gait.drives, GaitDrives::kRestLength);
  EXPECT_EQ(GaitInputOf(controller), &*controller.rest_length_input);

  WriteWith(
      "    rest_length_input: {gait: g.yaml}\n"
      "    position: {programs: [{cables: left, rest_length_m: 0.2}]}\n");
  const ExperimentSpec both = Load();
  EXPECT_EQ(both.controllers.at(0).position.size(), 1u);
  EXPECT_TRUE(both.controllers.at(0).rest_length_input);
}

TEST_F(RestLengthInput, DoesNotGoWithImpedance) {
  Write("g.yaml", WithLengths(kSine));
  const std::string hold = "  - name: hold\n", input = "    rest_length_input: {gait: g.yaml}\n";
  Expect(
      hold, hold + input,
      "11:5: error: controller has both impedance and rest_length_input (give only one of them)");
  ExpectWith(input + "    velocity_input: {gait: g.yaml}\n",
             "12:5: error: velocity_input has no effect with rest_length_input (it sets V0 of "
             "`impedance`)\n"
             "12:28: error: velocity_input: gait waves drives rest lengths (use it as "
             "`rest_length_input`)\n");
  ExpectWith("", "10:5: error: controller needs one of impedance, position, rest_length_input\n");
}

TEST_F(RestLengthInput, TakesGaitsThatDriveRestLengths) {
  Write("g.yaml", kSine);
  ExpectWith("    rest_length_input: {gait: g.yaml}\n",
             "11:31: error: rest_length_input: gait waves drives velocities (use it as "
             "`velocity_input`)\n");
  Write("g.yaml", WithLengths(kSine));
  const std::string hold = "  - name: hold\n";
  Expect(hold, hold + "    velocity_input: {gait: g.yaml}\n",
         "11:28: error: velocity_input: gait waves drives rest lengths (use it as "
         "`rest_length_input`)");
}

TEST_F(RestLengthInput, ItsCablesAreDriven) {
  std::string text = WithLengths(kSine);
  text.replace(text.find("cables: left"), 12, "cables: loose");
  Write("g.yaml", text);
  const std::string input = "    rest_length_input: {gait: g.yaml}\n";
  ExpectWith(input,
             "10:5: error: controller hold drives cables without an actuator: loose (give the "
             "cable's builder in the model an `actuator:`)\n");
  Write("g.yaml", WithLengths(kSine));
  ExpectWith(input + "  - {name: second, position: {programs: [{cables: back, change_m: 0.1}]}}\n",
             "12:6: error: controller second drives right, which controller hold already drives (a "
             "cable can have only one controller)\n");
}

TEST_F(RestLengthInput, TheResolvedExperimentHoldsTheGaitItself) {
  for (const char* text : {kSine, kCpg, kTable}) {
    Write("g.yaml", WithLengths(text));
    WriteWith("    rest_length_input: {gait: g.yaml, period_s: 0.02}\n");
    const ExperimentSpec experiment = Load();
    Write("resolved.yaml", ResolvedYaml(experiment));
    const ExperimentSpec back = Load("resolved.yaml");
    ASSERT_TRUE(back.controllers.at(0).rest_length_input);
    const GaitInputSpec& input = *back.controllers[0].rest_length_input;
    EXPECT_EQ(input.clock.period_s, 0.02);
    EXPECT_EQ(GaitYaml(input.gait), GaitYaml(experiment.controllers[0].rest_length_input->gait));
  }
}

class GaitChanges : public RestLengthInput {
 protected:
  GaitChanges() {
    for (const char* name : {"a", "b", "c"}) Write(std::string(name) + ".yaml", Called(name));
  }
  /// Returns a gait with this name for left and right.
  static std::string Called(const std::string& name) {
    std::string text = WithLengths(kTable);
    return text.replace(text.find("name: table"), 11, "name: " + name);
  }
  static std::string Input(const std::string& more) {
    return "    rest_length_input:\n      gait: a.yaml\n" + more;
  }
};

TEST_F(GaitChanges, EveryFileIsOneGait) {
  WriteWith(
      Input("      changes: [{at_s: 0, gait: b.yaml}, {at_s: 2, gait: ./a.yaml}, {at_s: 3, gait: "
            "./b.yaml}]\n      more_gaits: [c.yaml, b.yaml]\n      blend_s: 0.25\n"));
  const ExperimentSpec experiment = Load();
  const auto check = [](const ExperimentSpec& spec) {
    ASSERT_TRUE(spec.controllers.at(0).rest_length_input);
    const GaitInputSpec& input = *spec.controllers[0].rest_length_input;
    EXPECT_EQ(input.gait.name, "a");
    ASSERT_EQ(input.others.size(), 2u);
    EXPECT_EQ(input.others[0].name, "b");
    EXPECT_EQ(input.others[1].name, "c");
    ASSERT_EQ(input.changes.size(), 3u);
    EXPECT_EQ(input.changes[0].at_s, 0.0);
    EXPECT_EQ(input.changes[0].gait, 1);
    EXPECT_EQ(input.changes[1].at_s, 2.0);
    EXPECT_EQ(input.changes[1].gait, 0);
    EXPECT_EQ(input.changes[2].gait, 1);
    EXPECT_EQ(input.blend_s, 0.25);
  };
  check(experiment);
  EXPECT_EQ(experiment.files,
            (std::vector<std::string>{Path("trial.yaml"), Path("a.yaml"), Path("b.yaml"),
                                      Path("c.yaml"), Path("model.yaml")}));
  Write("resolved.yaml", ResolvedYaml(experiment));
  check(Load("resolved.yaml"));
  Write("b.yaml", Called("b") + "# other\n");
  EXPECT_NE(Load().input_hash, experiment.input_hash);
}

TEST_F(GaitChanges, WhatEarlierVersionsDidNotWriteIsNotThere) {
  WriteWith(Input(""));
  const std::string resolved = ResolvedYaml(Load());
  for (const char* key : {"others", "changes", "blend_s"}) {
    EXPECT_EQ(resolved.find(key), resolved.npos) << key;
  }
  Write("a.yaml", kSine);
  Change("  - name: hold\n", "  - name: hold\n    velocity_input: {gait: a.yaml}\n");
  EXPECT_EQ(ResolvedYaml(Load()).find("drives"), std::string::npos);
}

TEST_F(GaitChanges, NumbersOfFurtherGaitsAreCalledAfterThem) {
  for (const char* name : {"a", "b"}) {
    std::string text = WithLengths(kSine);
    Write(std::string(name) + ".yaml",
          text.replace(text.find("name: waves"), 11, std::string("name: ") + name));
  }
  WriteWith(Input("      changes: [{at_s: 1, gait: b.yaml}]\n"));
  ExperimentSpec experiment = Load();
  std::vector<ScaleSpec> scales;
  std::set<std::string> names;
  for (const Tunable& tunable : FindTunables(experiment.controllers, scales, experiment.robot)) {
    EXPECT_TRUE(names.insert(tunable.name).second) << tunable.name;
  }
  EXPECT_EQ(names.count("hold.sine.a.amplitude_m"), 1u);
  EXPECT_EQ(names.count("hold.b.sine.a.amplitude_m"), 1u);
}

TEST_F(GaitChanges, MustBeInOrder) {
  ExpectWith(Input("      changes: [{at_s: 2, gait: b.yaml}, {at_s: 2, gait: a.yaml}]\n"),
             "13:42: error: changes: times must increase, but 2 s follows 2 s\n");
  ExpectWith(Input("      changes: [{at_s: -1, gait: b.yaml}, {gait: a.yaml}]\n"),
             "13:24: error: changes.at_s must not be negative, got -1\n"
             "13:43: error: changes needs the key \"at_s\"\n");
  ExpectWith(Input("      changes: [{at_s: 2, gait: d.yaml}]\n      more_gaits: [e.yaml]\n"),
             "13:33: error: rest_length_input.changes.gait: there is no file \"d.yaml\" (paths are "
             "relative to the folder of the file that contains them)\n"
             "14:20: error: rest_length_input.more_gaits: there is no file \"e.yaml\" (paths are "
             "relative to the folder of the file that contains them)\n");
  ExpectWith(Input("      blend_s: -1\n      more_gaits: b.yaml\n"),
             "13:16: error: rest_length_input.blend_s must not be negative, got -1\n"
             "14:19: error: rest_length_input.more_gaits must be a list, got a text\n");
}

TEST_F(GaitChanges, MoveTheSameCablesInTheSameQuantity) {
  const std::string change = Input("      changes: [{at_s: 2, gait: b.yaml}]\n");
  std::string text = Called("b");
  text.replace(text.find("[left, right]"), 13, "[left]");
  text.replace(text.find("rows:"), text.npos, "rows: [[0, 0.1]]\n");
  Write("b.yaml", text);
  ExpectWith(change,
             "13:33: error: rest_length_input: gait b does not drive right, which gait a drives "
             "(all gaits of an input must drive the same cables)\n");
  Write("b.yaml", Called("b"));
  Write("a.yaml", text.replace(text.find("name: b"), 7, "name: a"));
  ExpectWith(change,
             "13:33: error: rest_length_input: gait a does not drive right, which gait b drives "
             "(all gaits of an input must drive the same cables)\n");
  Write("a.yaml", Called("a"));
  Write("b.yaml", kSine);
  ExpectWith(change,
             "13:33: error: rest_length_input: gait waves drives velocities (use it as "
             "`velocity_input`)\n");
  Write("b.yaml", Called("a"));
  ExpectWith(change,
             "13:33: error: rest_length_input: two gaits are called a (give one of them another "
             "name: the names of its parameters begin with it)\n");
  // the order of cables has no effect
  text = Called("b");
  Write("b.yaml", text.replace(text.find("[left, right]"), 13, "[right, left]"));
  ExpectWith(change, "");
}

TEST_F(GaitChanges, ResolvedOnesAreChecked) {
  WriteWith(Input("      changes: [{at_s: 2, gait: b.yaml}, {at_s: 3, gait: a.yaml}]\n"));
  const std::string good = ResolvedYaml(Load());
  const auto expect = [&](const std::string& old_text, const std::string& new_text,
                          const std::string& expected) {
    ChangeFile("resolved.yaml", good, old_text, new_text);
    EXPECT_EQ(Without("resolved.yaml:3:1: error: ", Complaints("resolved.yaml")), expected + "\n");
  };
  expect("at_s: 3", "at_s: 2", "rest_length_input.changes: times must increase");
  expect("at_s: 2, gait: 1", "at_s: 2, gait: 2",
         "rest_length_input.changes refers to a gait that does not exist");
  expect("changes: [", "blend_s: -1, changes: [", "rest_length_input.blend_s must not be negative");
  expect("drives: rest_length", "drives: velocity",
         "rest_length_input: gait a drives velocities (use it as `velocity_input`)");
  expect("0.2, -0.2]", "0.2]", "a table's row needs a signal for each cable");

  Write("a.yaml", kSine);
  Change("  - name: hold\n", "  - name: hold\n    velocity_input: {gait: a.yaml}\n");
  const std::string of_impedance = ResolvedYaml(Load());
  ChangeFile("resolved.yaml", of_impedance, "velocity_input:", "rest_length_input:");
  EXPECT_EQ(Without("resolved.yaml:3:1: error: ", Complaints("resolved.yaml")),
            "rest_length_input cannot be combined with impedance\n"
            "rest_length_input: gait waves drives velocities (use it as `velocity_input`)\n");
}

}  // namespace
}  // namespace taut::test
