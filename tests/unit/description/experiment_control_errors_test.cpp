// Errors of controllers, of their cables, and of the timeline
#include "unit/description/experiment_fixture.h"

namespace taut::test {
namespace {

TEST_F(ExperimentErrors, SelectorsMustMatch) {
  const std::string left = "cables: left,";
  Expect(left, "cables: lefty,",
         "15:20: error: set_points.cables: no cable matches lefty (no cable is called or tagged "
         "\"lefty\"; did you mean \"left\"?)");
  Expect(left, "cables: [driven, passive],",
         "15:20: error: set_points.cables: no cable matches [driven, passive] (no cable has all of "
         "these tags)");
  Expect(left, "cables: [[driven, frnt], [passive, frnt]],",
         "15:20: error: set_points.cables: no cable matches [[driven, frnt], [passive, frnt]] (no "
         "cable is called or tagged \"frnt\"; did you mean \"front\"?)");
  Expect(left, "cables: [],",
         "15:20: error: set_points.cables must not be empty (name the tags to match)");
  Expect(left, "cables: {left: 1},",
         "15:20: error: set_points.cables must be a name or a list of names, got a map");
  Expect("{cables: left, ", "{", "15:11: error: set_points needs the key \"cables\"");
}

TEST_F(ExperimentErrors, SensorsAreLateBy10000PeriodsAtMost) {
  Change("duration_s: 10\n",
         "duration_s: 10\nsensors: {period_s: 0.001, load_cell: {delay_s: 10.001}}\n");
  EXPECT_NE(Complaints().find("error: sensors.load_cell.delay_s must not be longer than 10000 "
                              "sensor periods (the period is 0.001 s)\n"),
            std::string::npos)
      << Complaints();
}

TEST_F(ExperimentErrors, ARobotWithoutCablesHasNoneToDrive) {
  Write("model.yaml",
        "taut: 1\nkind: model\nname: rod\nnodes: {a: [0, 0, 0], b: [1, 0, 0], a1: {at_m: [0, 1, "
        "0], fixed_to: a}}\n"
        "pairs: [{nodes: [a, b], tags: [rod]}]\n"
        "builders: [{match: rod, rod: {radius_m: 0.01, mass_kg: 1}}]\n");
  EXPECT_EQ(
      Complaints(),
      "trial.yaml:13:20: error: gains.cables: no cable matches driven (the robot has no cables)\n"
      "trial.yaml:15:20: error: set_points.cables: no cable matches left (the robot has no "
      "cables)\n"
      "trial.yaml:16:20: error: set_points.cables: no cable matches right (the robot has no "
      "cables)\n");
}

TEST_F(ExperimentErrors, GainsAndSetPointsBelongTogether) {
  Expect("cables: driven,", "cables: left,",
         "16:20: error: there are no gains for right (add a selector to `gains`)");
  Expect("        - {cables: right, tension_n: 10, length_m: 0.18}\n", "",
         "13:20: error: there are no set points for right (add a selector to `set_points`, or "
         "narrow this one)");
  Expect("cables: left, tension", "cables: driven, tension",
         "16:20: error: there are two set points for right (the first are in line 15)");
  Expect("      set_points",
         "        - {cables: [[left], [right]], position_gain_n_per_m: 1, velocity_gain_n_s_per_m: "
         "1}\n      set_points",
         "14:20: error: there are two gains for left, right (the first are in line 13)");
  Expect("500", "-500", "13:51: error: gains.position_gain_n_per_m must not be negative, got -500");
  Expect("150}", "-150}",
         "13:81: error: gains.velocity_gain_n_s_per_m must not be negative, got -150");
  Expect(", velocity_gain_n_s_per_m: 150", "",
         "13:11: error: gains needs the key \"velocity_gain_n_s_per_m\"");
  Expect("tension_n: 28", "tension_n: -28",
         "15:37: error: set_points.tension_n must not be negative, got -28");
  Expect("length_m: 0.19", "length_m: -0.19",
         "15:51: error: set_points.length_m must not be negative, got -0.19");
  Expect("length_m: 0.19", "length_m: 0.19, speed_m_per_s: 1",
         "15:57: error: unknown key \"speed_m_per_s\" in set_points (one of: cables, tension_n, "
         "length_m, velocity_m_per_s)");
  Expect("impedance:\n      gains:", "impedance:\n      gain:",
         "12:7: error: unknown key \"gain\" in impedance (did you mean \"gains\"?)");
}

TEST_F(ExperimentErrors, ConversionAndRateAreChoices) {
  Expect("gains:\n", "conversion: stiff\n      gains:\n",
         "12:19: error: impedance.conversion cannot be \"stiff\" (one of: stiffness, pid)");
  Expect("gains:\n", "conversion: pid\n      gains:\n",
         "12:7: error: conversion: pid needs the key \"pid\" as well (write `pid: "
         "{proportional_m_per_s_n: 0.01}`)");
  Expect("gains:\n", "pid: {proportional_m_per_s_n: 1}\n      gains:\n",
         "12:7: error: impedance.pid has no effect (add `conversion: pid`)");
  Expect("gains:\n", "conversion: pid\n      pid: {proportional_m_per_s_n: -1}\n      gains:\n",
         "13:37: error: impedance.pid.proportional_m_per_s_n must not be negative, got -1");
  Expect("gains:\n",
         "conversion: pid\n      pid: {integral_m_per_s2_n: -1, derivative_m_per_n: -2}\n      "
         "gains:\n",
         "13:12: error: impedance.pid needs the key \"proportional_m_per_s_n\"\n13:34: error: "
         "impedance.pid.integral_m_per_s2_n must not be negative, got -1\n13:58: error: "
         "impedance.pid.derivative_m_per_n must not be negative, got -2");
  Expect("gains:\n", "rate: difference\n      gains:\n",
         "12:13: error: impedance.rate cannot be \"difference\" (did you mean \"differenced\"?)");
}

TEST_F(ExperimentErrors, ACableObeysOneController) {
  Expect("name: hold", "name: hold\n    period_s: 0",
         "11:15: error: controller.period_s must be positive, got 0");
  Expect("name: hold", "name: hold\n    phase_s: -1",
         "11:14: error: controller.phase_s must not be negative, got -1");
  Expect(
      "name: hold", "name: hold on",
      "10:11: error: controller.name: \"hold on\" cannot be a name (use letters, digits, _ and -)");
  Expect("- name: hold\n    impedance", "- impedance",
         "10:5: error: controller needs the key \"name\"");
  Expect("name: hold", "name: hold\n    position: {programs: []}",
         "11:5: error: controller has both impedance and position (give only one of them)");
  Expect(
      "    impedance:", "    cpg:",
      "10:5: error: controller needs one of impedance, position, rest_length_input\n11:5: error: "
      "unknown key \"cpg\" in controller (one of: name, period_s, phase_s, impedance, position, "
      "velocity_input, rest_length_input)");
  const std::string second =
      "  - {name: second, position: {programs: [{cables: back, rest_length_m: 0.1}]}}\n";
  Expect("timeline:", second + "timeline:",
         "17:6: error: controller second drives right, which controller hold already drives (a "
         "cable can have only one controller)");
  Expect("timeline:",
         "  - {name: hold, position: {programs: [{cables: loose, rest_length_m: 0.1}]}}\ntimeline:",
         "17:6: error: controller hold drives cables without an actuator: loose (give the cable's "
         "builder in the model an `actuator:`)\n"
         "17:6: error: two controllers are called hold (the first is in line 10)");
}

TEST_F(ExperimentErrors, ProgramsKeepRestLengthsPositive) {
  std::string text = kExperiment;
  const std::size_t from = text.find("    impedance:"), to = text.find("timeline:");
  const auto expect = [&](const std::string& programs, const std::string& expected) {
    std::string changed = text;
    Write("trial.yaml", changed.replace(from, to - from, "    position: {" + programs + "}\n"));
    EXPECT_EQ(Complaints(), expected) << programs;
  };
  expect("programs: [{cables: driven, rest_length_m: 0.1}]", "");
  expect("programs: [{cables: driven, rest_length_m: 0}]",
         "trial.yaml:11:59: error: programs.rest_length_m must be positive, got 0\n");
  expect("programs: [{cables: driven, rest_length_m: [[0, 0.1], [1, -0.1]]}]",
         "trial.yaml:11:74: error: programs.rest_length_m must be positive, got -0.1\n");
  expect("programs: [{cables: driven, rest_length_m: [[0, 0.1], [0, 0.2]]}]",
         "trial.yaml:11:71: error: programs.rest_length_m: times must increase, but 0 s follows 0 "
         "s\n");
  expect("programs: [{cables: driven, rest_length_m: [[-1, 0.1]]}]",
         "trial.yaml:11:61: error: programs.rest_length_m: time_s must not be negative, got -1\n");
  expect("programs: [{cables: driven, rest_length_m: []}]",
         "trial.yaml:11:59: error: programs.rest_length_m must be a list of [time_s, value] (such "
         "as [[0, 1], [5, 2]])\n");
  expect(
      "programs: [{cables: driven, rest_length_m: [1, 2]}]",
      "trial.yaml:11:60: error: programs.rest_length_m: a point must be [time_s, "
      "value]\ntrial.yaml:11:63: error: programs.rest_length_m: a point must be [time_s, value]\n");
  expect("programs: [{cables: driven, rest_length_m: {from_m: 1}}]",
         "trial.yaml:11:59: error: programs.rest_length_m must be a number or a list of [time_s, "
         "value], got a map\n");
  expect("programs: [{cables: driven, change_m: [[0, 0], [2, -0.2]]}]",
         "trial.yaml:11:54: error: programs.change_m: a change of -0.2 m at t = 2 s leaves left "
         "without a positive rest length (its initial rest length is 0.15 m)\n");
  expect("programs: [{cables: driven, change_m: 0, rest_length_m: 1}]",
         "trial.yaml:11:44: error: programs has both rest_length_m and change_m (give only one of "
         "them)\n");
  expect("programs: [{cables: driven}]",
         "trial.yaml:11:27: error: programs needs one of rest_length_m, change_m\n");
  expect("programs: [{cables: driven, change_m: 0}, {cables: left, change_m: 0}]",
         "trial.yaml:11:67: error: there are two programs for left (the first are in line 11)\n");
  expect("programs: [{cables: passive, change_m: 0}]",
         "trial.yaml:10:5: error: controller hold drives cables without an actuator: loose (give "
         "the cable's builder in the model an `actuator:`)\n");
  expect("programs: all",
         "trial.yaml:11:26: error: position.programs must be a list, got a text\n");
  expect("program: []",
         "trial.yaml:11:16: error: unknown key \"program\" in position (did you mean "
         "\"programs\"?)\n");
}

TEST_F(ExperimentErrors, PushesNeedRisingTimes) {
  Expect("node: a1", "node: a2", "20:31: error: there is no node \"a2\" (did you mean \"a0\"?)");
  Expect("node: a1, ", "", "20:13: error: push needs the key \"node\"");
  Expect("direction: [0, 0, 2]", "direction: [0, 0, 0]",
         "20:46: error: push.direction must not be zero (it is a direction)");
  Expect("direction: [0, 0, 2], ", "", "20:13: error: push needs the key \"direction\"");
  Expect("[[3, 0], [4, push_n]]", "[[3, 0], [3, push_n]]",
         "20:76: error: push.force_n: times must increase, but 3 s follows 3 s");
  Expect("[[3, 0], [4, push_n]]", "[[3, 0], [2, push_n]]",
         "20:76: error: push.force_n: times must increase, but 2 s follows 3 s");
  Expect("[[3, 0], [4, push_n]]", "[[3, 0]]",
         "20:66: error: push.force_n needs two points or more (the force is zero before the first "
         "and after the last one)");
  Expect("[[3, 0], [4, push_n]]", "[[-3, 0], [4, push_n]]",
         "20:68: error: push.force_n: time_s must not be negative, got -3");
  Expect("[[3, 0], [4, push_n]]", "push_n",
         "20:66: error: push.force_n must be a list of [time_s, value] (such as [[0, 1], [5, 2]])");
  Expect("[[3, 0], [4, push_n]]", "[[3, 0, 1], [4, push_n]]",
         "20:67: error: push.force_n: a point must be [time_s, value]");
  Expect("name: tap", "name: tap, scale: big",
         "20:32: error: push.scale: unknown name \"big\" (one of: push_n)");
  Expect("- push:", "- pull:",
         "20:7: error: unknown key \"pull\" in event "
         "(did you mean \"push\"?)");
  Expect("    - push: {name: tap,",
         "    - push: {name: tap, node: a1, direction: [1, 0, 0], force_n: [[0, 0], [1, 1]]}\n    "
         "- push: {name: tap,",
         "21:20: error: two events are called tap (the first is in line 20)");
}

TEST_F(ExperimentErrors, DragsMove) {
  std::string text = kExperiment;
  const std::size_t from = text.find("    - push:"), to = text.find("record:");
  const auto expect = [&](const std::string& drag, const std::string& expected) {
    std::string changed = text;
    Write("trial.yaml", changed.replace(from, to - from, "    - drag: {" + drag + "}\n"));
    EXPECT_EQ(Complaints(), expected) << drag;
  };
  const std::string rest = ", stiffness_n_per_m: 10, from_s: 1, to_s: 2";
  expect("name: pull, node: a1, velocity_m_per_s: [1, 0, 0]" + rest, "");
  expect("name: pull, node: a1, velocity_m_per_s: [0, 0, 0]" + rest,
         "trial.yaml:20:36: error: drag.velocity_m_per_s must not be zero (the force is measured "
         "along the velocity)\n");
  expect("name: pull, node: c, velocity_m_per_s: [1, 0, 0]" + rest,
         "trial.yaml:20:32: error: there is no node \"c\" (one of: a0, a1, b0, b1)\n");
  expect(
      "name: pull, node: a1, velocity_m_per_s: [1, 0, 0], stiffness_n_per_m: 0, from_s: 1, to_s: 2",
      "trial.yaml:20:84: error: drag.stiffness_n_per_m must be positive, got 0\n");
  expect(
      "name: pull, node: a1, velocity_m_per_s: [1, 0, 0], stiffness_n_per_m: 1, damping_n_s_per_m: "
      "-1, from_s: 1, to_s: 2",
      "trial.yaml:20:106: error: drag.damping_n_s_per_m must not be negative, got -1\n");
  expect(
      "name: pull, node: a1, velocity_m_per_s: [1, 0, 0], stiffness_n_per_m: 1, from_s: 2, to_s: 2",
      "trial.yaml:20:98: error: drag.to_s must be after from_s, got 2..2\n");
  expect(
      "name: pull, node: a1, velocity_m_per_s: [1, 0, 0], stiffness_n_per_m: 1, from_s: -1, to_s: "
      "2",
      "trial.yaml:20:95: error: drag.from_s must not be negative, got -1\n");
  expect("name: pull",
         "trial.yaml:20:13: error: drag needs the key \"from_s\"\ntrial.yaml:20:13: error: drag "
         "needs the key \"node\"\ntrial.yaml:20:13: error: drag needs the key "
         "\"stiffness_n_per_m\"\ntrial.yaml:20:13: error: drag needs the key "
         "\"to_s\"\ntrial.yaml:20:13: error: drag needs the key \"velocity_m_per_s\"\n");
}

TEST_F(ExperimentErrors, PhasesLieWithinTheExperiment) {
  Expect("before: [1, 2]", "before: [2, 1]",
         "18:20: error: phase before must end after it begins, got 2..1 s");
  Expect("before: [1, 2]", "before: [1, 1]",
         "18:20: error: phase before must end after it begins, got 1..1 s");
  Expect("before: [1, 2]", "before: [1, 12]",
         "18:20: error: phase before must be within the experiment, 0..10 s, got 1..12 s");
  Expect("before: [1, 2]", "before: [-1, 2]",
         "18:20: error: phase before must be within the experiment, 0..10 s, got -1..2 s");
  Expect("before: [1, 2]", "before: [1, 2, 3]",
         "18:20: error: phase before must have 2 numbers, got 3");
  Expect(
      "before: [1, 2]", "not yet: [1, 2]",
      "18:12: error: timeline.phases: \"not yet\" cannot be a name (use letters, digits, _ and -)");
  Expect("phases: {before: [1, 2]}", "phases: [before]",
         "18:11: error: timeline.phases must be a map, got a list");
}

}  // namespace
}  // namespace taut::test
