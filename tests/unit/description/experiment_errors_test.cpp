// All errors of the experiment reader, with places and hints
#include "unit/description/experiment_fixture.h"

namespace taut::test {
namespace {

TEST_F(ExperimentErrors, TheFixtureIsRight) { EXPECT_EQ(Complaints(), ""); }

TEST_F(ExperimentErrors, HeaderAndKeysAreStrict) {
  Expect("taut: 1", "taut: 2",
         "1:7: error: taut must be 1, got 2 (it is the version of the file format; this program "
         "reads version 1)");
  Expect(
      "kind: experiment", "kind: model",
      "2:7: error: kind must be experiment, got model (use `taut check` for files of this kind)");
  Expect("record:", "recrod:", "21:1: error: unknown key \"recrod\" (did you mean \"record\"?)");
  Expect("record:", "duration_s: 3\nrecord:",
         "21:1: error: duplicate key \"duration_s\" (first in line 8)");
  Expect("record: {rate_hz: 50}", "record: {rate: 50}",
         "21:10: error: unknown key \"rate\" in record (did you mean \"rate_hz\"?)");
  Expect("record: {rate_hz: 50}", "record: 50", "21:9: error: record must be a map, got a text");
  Expect("record: {rate_hz: 50}", "record: {rate_hz: -1}",
         "21:19: error: record.rate_hz must not be negative, got -1");
  Expect("record: {rate_hz: 50}", "record: {channels: all}",
         "21:20: error: record.channels must be a list, got a text");
  Expect("name: trial", "name: trial 1",
         "3:7: error: name: \"trial 1\" cannot be a name (use letters, digits, _ and -)");
}

TEST_F(ExperimentErrors, MissingKeysAreNamed) {
  Expect("name: trial\n", "", "1:1: error: the file needs the key \"name\"");
  Expect("model: model.yaml\n", "", "1:1: error: the file needs the key \"model\"");
  Expect("duration_s: 10\n", "", "1:1: error: the file needs the key \"duration_s\"");
}

TEST_F(ExperimentErrors, TimesHaveLimits) {
  Expect("duration_s: 10", "duration_s: -1",
         "8:13: error: duration_s must be within 0..1e9, got -1");
  Expect("duration_s: 10", "duration_s: 10\nstep_s: 0",
         "9:9: error: step_s must be positive, got 0");
  Expect("duration_s: 10", "duration_s: 10\nstep_s: 2",
         "9:9: error: step_s must be within 1e-9..1, got 2");
  Expect("duration_s: 10", "duration_s: 10\nstep_s: 1e-10",
         "9:9: error: step_s must be within 1e-9..1, got 1e-10");
  Expect("duration_s: 10", "duration_s: .inf",
         "8:13: error: duration_s must be a finite number, got .inf");
  Expect("duration_s: 10", "duration_s: 10\nseed: 1.5",
         "9:7: error: seed must be a whole number within 0..2147483647, got 1.5");
  Expect("duration_s: 10", "duration_s: 10\nstart: setled",
         "9:8: error: start cannot be \"setled\" (did you mean \"settled\"?)");
}

TEST_F(ExperimentErrors, FilesMustBeThere) {
  Expect("model: model.yaml", "model: modle.yaml",
         "4:8: error: model: there is no file \"modle.yaml\" (paths are relative to the folder of "
         "the file that contains them)");
  Expect("model: model.yaml", "model: [model.yaml]",
         "4:8: error: model must be a text, got a list");
  Expect("record:", "compare_with: run.h5\nrecord:",
         "21:15: error: compare_with: there is no file \"run.h5\" (paths are relative to the "
         "folder of the file that contains them)");
  Expect("name: trial", "name: trial\nbase: other.yaml",
         "4:7: error: base: there is no file other.yaml (paths are relative to the folder of this "
         "file)");
  Expect("name: trial", "name: trial\nbase: trial.yaml",
         "4:7: error: base files refer to each other in a circle: trial.yaml");
  Expect("name: trial", "name: trial\nbase: [a]",
         "4:7: error: base must be the name of a file of kind experiment");
  Expect("name: trial", "name: trial\nbase: model.yaml",
         "model.yaml:2:7: error: kind must be experiment, got model (use `taut check` for files of "
         "this kind)");
}

TEST_F(ExperimentErrors, ReferencesNameWhatThereIs) {
  const auto expect = [&](const std::string& keys, const std::string& complaint) {
    Expect("record:", "reference:\n  - {source: a book, " + keys + "}\nrecord:", complaint);
  };
  expect("cables_n: {lift: 1}",
         "22:33: error: there is no cable \"lift\" (did you mean \"left\"?)");
  expect("phase: befor, cables_n: {left: 1}",
         "22:29: error: there is no phase \"befor\" (did you mean \"before\"?)");
  expect("statistic: mean, cables_n: {left: 1}",
         "22:22: error: reference.statistic must be max for the whole run (for another "
         "statistic, name a phase of the timeline, such as `phase: before`)");
  expect("cables_n: {}",
         "22:32: error: reference.cables_n has no values (such as `inner_top_1: 34.4`)");
  expect("cables_n: {left: much}",
         "22:39: error: reference.cables_n.left: unknown name \"much\" (one of: push_n)");
  Expect("record:", "reference:\n  - {quantity: force}\nrecord:",
         "22:5: error: reference needs the key \"cables_n\"\n"
         "22:5: error: reference needs the key \"source\"\n"
         "22:16: error: reference.quantity cannot be \"force\" (one of: tension, elastic)");
}

TEST_F(ExperimentErrors, ParametersMustExist) {
  Expect("push_n: 10", "push_n: 10 *",
         "5:22: error: parameters.push_n: the expression is incomplete");
  Expect("[4, push_n]", "[4, pull_n]",
         "20:79: error: push.force_n: unknown name \"pull_n\" (did you mean \"push_n\"?)");
  Expect("duration_s: 10", "set: {stiffness: 3}\nduration_s: 10",
         "8:7: error: there is no parameter \"stiffness\" (did you mean \"stiffness_n_per_m\"?)");
  Expect("duration_s: 10", "set: {push_n: 3}\nduration_s: 10",
         "8:7: error: there is no parameter \"push_n\" (one of: height_m, stiffness_n_per_m)");
  Expect("duration_s: 10", "set: {height_m: puhs_n}\nduration_s: 10",
         "8:17: error: set.height_m: unknown name \"puhs_n\" (did you mean \"push_n\"?)");
  Expect("duration_s: 10", "set: 3\nduration_s: 10", "8:6: error: set must be a map, got a text");
}

TEST_F(ExperimentErrors, OverridesOfUnknownParametersHintAtBothFiles) {
  EXPECT_EQ(
      Complaints("trial.yaml", {{"hight_m", "1"}}),
      "--set hight_m=1: error: there is no parameter \"hight_m\" (did you mean \"height_m\"?)\n");
  EXPECT_EQ(Complaints("trial.yaml", {{"push", "1"}}),
            "--set push=1: error: there is no parameter \"push\" (did you mean \"push_n\"?)\n");
}

TEST_F(ExperimentErrors, ModelOptionsAreChoices) {
  const auto with = [](const std::string& options) {
    return "model_options: {" + options + "}\nduration_s: 10";
  };
  Expect("duration_s: 10", with("inertia: box"),
         "8:26: error: model_options.inertia cannot be \"box\" (one of: exact, bounding_box)");
  Expect("duration_s: 10", with("damping_law: clampd"),
         "8:30: error: model_options.damping_law cannot be \"clampd\" (did you mean \"clamped\"?)");
  Expect("duration_s: 10", with("friction_law: none"),
         "8:31: error: model_options.friction_law cannot be \"none\" (did you mean \"cone\"?)");
  Expect("duration_s: 10", with("friction_combine: sum"),
         "8:35: error: model_options.friction_combine cannot be \"sum\" (one of: product, "
         "geometric_mean, minimum, maximum)");
  Expect("duration_s: 10", with("restitution_combine: max"),
         "8:38: error: model_options.restitution_combine cannot be \"max\" (one of: product, "
         "geometric_mean, minimum, maximum)");
  Expect("duration_s: 10", with("gravity: 1"),
         "8:17: error: unknown key \"gravity\" in model_options (one of: inertia, damping_law, "
         "friction_combine, restitution_combine, friction_law)");
  Expect("duration_s: 10", "gravity_m_per_s2: 9.81\nduration_s: 10",
         "8:19: error: gravity_m_per_s2 must be a list of 3 numbers, got a text");
}

TEST_F(ExperimentErrors, PlanesLieInOneWay) {
  const std::string plane = "{height_m: 0, friction: 0.5}";
  Expect(plane, "{friction: 0.5}", "7:27: error: plane needs one of height_m, normal, slope_rad");
  Expect(plane, "{height_m: 0, normal: [0, 0, 1]}",
         "7:41: error: plane has both height_m and normal (give only one of them)");
  Expect(plane, "{height_m: 0, point_m: [0, 0, 1]}",
         "7:41: error: plane has both height_m and point_m (give only one of them)");
  Expect(plane, "{normal: [0, 0, 0]}",
         "7:36: error: plane.normal must not be zero (it is a direction)");
  Expect(plane, "{normal: [0, 0]}", "7:36: error: plane.normal must have 3 numbers, got 2");
  Expect(plane, "{slope_rad: 0.1}", "7:27: error: plane needs the key \"slope_direction\"");
  Expect(plane, "{slope_rad: -0.1, slope_direction: [1, 0, 0]}",
         "7:39: error: plane.slope_rad must not be negative, got -0.1");
  Expect(plane, "{slope_rad: pi / 2, slope_direction: [1, 0, 0]}",
         "7:39: error: plane.slope_rad must be below pi / 2, got 1.5707963267948966 (give a "
         "`normal` instead)");
  Expect(plane, "{slope_rad: 0.1, slope_direction: [1, 0, 1]}",
         "7:61: error: plane.slope_direction must be horizontal (its last number must be 0)");
  Expect(plane, "{height_m: 0, slope_direction: [1, 0, 0]}",
         "7:41: error: plane.slope_direction needs slope_rad");
  Expect(plane, "{height_m: 0, friction: -0.5}",
         "7:51: error: plane.friction must not be negative, got -0.5");
  Expect(plane, "{height_m: 0, static_friction: 0.1, kinetic_friction: 0.2}",
         "7:41: error: plane.static_friction is below kinetic_friction (static friction must be at "
         "least the kinetic friction)");
  Expect(plane, "{height_m: 0, restitution: 2}",
         "7:54: error: plane.restitution must be within 0..1, got 2");
}

TEST_F(ExperimentErrors, TerrainIsPlanesAndBoxes) {
  const std::string ground = "- {name: ground, plane: {height_m: 0, friction: 0.5}}";
  Expect(ground, "- {name: ground}",
         "7:5: error: terrain needs one of plane, box, scatter, stairs, height_field, "
         "mesh");
  Expect(ground, "- {name: ground, hills: {}}",
         "7:5: error: terrain needs one of plane, box, scatter, stairs, height_field, "
         "mesh\n7:20: error: unknown key "
         "\"hills\" in "
         "terrain (one of: name, plane, box, scatter, stairs, height_field, mesh)");
  Expect(ground, "- {plane: {height_m: 0}}", "7:5: error: terrain needs the key \"name\"");
  Expect(ground, ground + "\n  " + ground,
         "8:6: error: two terrain elements are called ground (the first is in line 7)");
  Expect(ground, "- {name: step, box: {center_m: [0, 0, 0], size_m: [1, 0, 1]}}",
         "7:53: error: box.size_m must be three positive numbers");
  Expect(ground, "- {name: step, box: {center_m: [0, 0, 0]}}",
         "7:23: error: box needs the key \"size_m\"");
  Expect(ground, "- {name: step, box: {center_m: 0, size_m: [1, 1, 1]}}",
         "7:34: error: box.center_m must be a list of 3 numbers, got a text");
  Expect(ground,
         "- {name: step, box: {center_m: [0, 0, 0], size_m: [1, 1, 1], rotate: {axis: w, "
         "angle_rad: 1}}}",
         "7:79: error: box.rotate.axis cannot be \"w\" (did you mean \"x\"?)");
  Expect("terrain:\n  " + ground, "terrain: flat",
         "6:10: error: terrain must be a list, got a text");
}

TEST_F(ExperimentErrors, PlaceMustHaveAnEffect) {
  Expect("duration_s: 10", "place: {to_m: [0, 0, 1]}\nduration_s: 10",
         "8:9: error: unknown key \"to_m\" in place (did you mean \"at_m\"?)");
  Expect("duration_s: 10", "place: {at_m: 1}\nduration_s: 10",
         "8:15: error: place.at_m must be a list of 3 numbers, got a text");
  Expect("duration_s: 10", "place: {rotate: {axis: x}}\nduration_s: 10",
         "8:17: error: place.rotate needs the key \"angle_rad\"");
  Expect("duration_s: 10", "place: {velocity_m_per_s: [1, 0, 0]}\nstart: settled\nduration_s: 10",
         "8:9: error: place.velocity_m_per_s has no effect: settling ends at rest (write `start: "
         "as_described`)");
  Expect("duration_s: 10",
         "place: {angular_velocity_rad_per_s: [1, 0, 0]}\nstart: settled_floating\nduration_s: 10",
         "8:9: error: place.angular_velocity_rad_per_s has no effect: settling ends at rest (write "
         "`start: as_described`)");
}

TEST_F(ExperimentErrors, OneCallFindsThemAllInBothFiles) {
  ChangeFile("model.yaml", kModel, "mass_kg: 1", "mass_kg: -1");
  std::string text = kExperiment;
  text.replace(text.find("rate_hz: 50"), 11, "rate_hz: -5");
  text.replace(text.find("node: a1"), 8, "node: a9");
  text.replace(text.find("cables: left"), 12, "cables: l");
  text.replace(text.find("friction: 0.5"), 13, "friction: -1");
  Write("trial.yaml", text);
  // A mass is invalid, but the nodes and cables are known: references to them are checked.
  EXPECT_EQ(
      Complaints(),
      "model.yaml:17:49: error: rod.mass_kg must not be negative, got -1\ntrial.yaml:7:51: error: "
      "plane.friction must not be negative, got -1\ntrial.yaml:15:20: error: set_points.cables: no "
      "cable matches l (no cable is called or tagged \"l\"; one of: back, driven, front, left, "
      "loose, passive, right)\ntrial.yaml:20:31: error: there is no node \"a9\" (did you mean "
      "\"a0\"?)\ntrial.yaml:21:19: error: record.rate_hz must not be negative, got -5\n");
}

TEST_F(ExperimentErrors, ARobotThatCouldNotBeReadIsNotReferredTo) {
  ChangeFile("model.yaml", kModel, "a1: [1, 0, 0.1]", "a1: [1, 0]");
  std::string text = kExperiment;
  Write("trial.yaml", text.replace(text.find("node: a1"), 8, "node: a9"));
  EXPECT_EQ(Complaints(), "model.yaml:7:7: error: nodes.a1 must have 3 numbers, got 2\n");
}

}  // namespace
}  // namespace taut::test
