// Gait files: reading, writing, errors
#include <bit>
#include <cmath>

#include "taut/gait.h"
#include "unit/description/experiment_fixture.h"
#include "unit/description/gait_texts.h"

namespace taut::test {
namespace {

std::string Replaced(std::string text, const std::string& old_text, const std::string& new_text) {
  return text.replace(text.find(old_text), old_text.size(), new_text);
}

class Gait : public ExperimentFolder {
 protected:
  std::string GaitComplaints(const std::string& text) {
    Write("g.yaml", text);
    Diagnostics out;
    EXPECT_FALSE(LoadGait(Path("g.yaml"), out));
    return Without("g.yaml:", Without(Path(""), out.Format()));
  }
  void Expect(std::string text, const std::string& old_text, const std::string& new_text,
              const std::string& expected) {
    const std::size_t place = text.find(old_text);
    ASSERT_NE(place, std::string::npos) << old_text;
    EXPECT_EQ(GaitComplaints(text.replace(place, old_text.size(), new_text)), expected + "\n");
  }
  GaitSpec LoadText(const std::string& text) {
    Write("g.yaml", text);
    Diagnostics out;
    const auto gait = LoadGait(Path("g.yaml"), out);
    EXPECT_TRUE(gait) << out.Format();
    return gait.value_or(GaitSpec{});
  }
  /// Returns the errors of the experiment with a controller that plays the gait.
  std::string PlayedComplaints(const std::string& text) {
    Write("g.yaml", text);
    Change("  - name: hold\n", "  - name: hold\n    velocity_input: {gait: g.yaml}\n");
    return Complaints();
  }
};

TEST_F(Gait, AParameterThatNothingReadsIsAWarning) {
  Write("g.yaml", Replaced(kSine, "{slow_hz: 0.5}", "{slow_hz: 0.5, idle: 2 * slow_hz}"));
  Diagnostics out;
  EXPECT_TRUE(LoadGait(Path("g.yaml"), out));
  EXPECT_EQ(Without(Path(""), out.Format()),
            "g.yaml:4:34: warning: the parameter \"idle\" is not used (remove it, or use it in an "
            "expression)\n");
}

TEST_F(Gait, ASineIsReadWithItsExpressionsAndDefaults) {
  const GaitSpec gait = LoadText(kSine);
  ASSERT_TRUE(gait.sine);
  EXPECT_EQ(gait.sine->frequency_hz, 0.5);
  ASSERT_EQ(gait.sine->waves.size(), 2u);
  EXPECT_EQ(gait.sine->waves[0].amplitude, -0.08);
  EXPECT_EQ(gait.sine->waves[0].phase_rad, std::acos(0.0));
  EXPECT_EQ(gait.sine->waves[0].offset, 0.01);
  EXPECT_FALSE(gait.sine->waves[0].frequency_hz);
  EXPECT_EQ(gait.sine->waves[1].frequency_hz, 1.0);
  EXPECT_EQ(gait.sine->waves[1].cables, (CableMatch{{"driven", "back"}}));
}

/// Returns every number by its bits, and the texts.
std::string Everything(GaitSpec gait) {
  std::string out = gait.name + "|" + gait.description + "|";
  out += gait.drives == GaitDrives::kRestLength ? "lengths|" : "velocities|";
  for (const GaitValue& value : GaitValues(gait)) {
    out += value.name + " " + value.unit + " " +
           std::to_string(std::bit_cast<std::uint64_t>(*value.value)) + "\n";
  }
  if (gait.cpg) {
    out += std::to_string(static_cast<int>(gait.cpg->symmetry)) + "/" +
           std::to_string(std::bit_cast<std::uint64_t>(gait.cpg->integrator_step_s));
    for (const auto& name : gait.cpg->order) out += "," + name;
    for (const auto& set : gait.cpg->inverted) {
      for (const auto& tag : set) out += ";" + tag;
    }
  }
  if (gait.sine) {
    for (const SineWave& wave : gait.sine->waves) {
      for (const auto& set : wave.cables) {
        for (const auto& tag : set) out += ";" + tag;
      }
    }
  }
  if (gait.table) {
    for (std::size_t i = 0; i < gait.table->rows.size(); ++i) {
      out += "\n" + std::to_string(std::bit_cast<std::uint64_t>(gait.table->time_s[i]));
      for (const double v : gait.table->rows[i]) {
        out += " " + std::to_string(std::bit_cast<std::uint64_t>(v));
      }
    }
    out += gait.table->linear ? "linear" : "hold";
    if (gait.table->repeat_from_s) out += std::to_string(*gait.table->repeat_from_s);
  }
  return out;
}

TEST_F(Gait, WhatIsWrittenReadsBackToTheSameBits) {
  std::string cpg = kCpg;
  cpg.replace(cpg.find("  symmetry"), 0,
              "  convergence_per_s: 20 / 3\n  integrator_step_s: 0.1 / 3\n"
              "  order: [right, left]\n  inverted: [[left], [driven, back]]\n"
              "  feedback: {gain_rad_per_n_s: 1 / 3, reference_n: sqrt(2)}\n");
  std::string table = kTable;
  table.replace(table.find("  cables"), 0, "  interpolation: linear\n  repeat_from_s: 0.1\n");
  table.replace(table.find("0.2, -0.2"), 3, "1 / 3");
  const std::string lengths = WithLengths(kSine), length_cpg = WithLengths(cpg),
                    length_table = WithLengths(table);
  std::string sine = kSine;
  sine.replace(sine.find("name: waves"), 11, "name: waves\ndescription: 'a \"b\" \\ c'");
  sine.replace(sine.find("offset_m_per_s"), 0, "phase_per_segment_rad: 1 / 3, ");
  for (const std::string& text : {sine, cpg, table, lengths, length_cpg, length_table}) {
    GaitSpec gait = LoadText(text);
    Diagnostics out;
    ASSERT_TRUE(SaveGait(gait, Path("saved.yaml"), out));
    const auto back = LoadGait(Path("saved.yaml"), out);
    ASSERT_TRUE(back) << out.Format();
    EXPECT_EQ(Everything(*back), Everything(gait));
    EXPECT_EQ(GaitYaml(*back), GaitYaml(gait));
  }
}

TEST_F(Gait, AFileThatCannotBeWrittenIsSaid) {
  Diagnostics out;
  EXPECT_FALSE(SaveGait(LoadText(kSine), "/nowhere/g.yaml", out));
  EXPECT_EQ(out.Format(), "/nowhere/g.yaml: error: cannot write: No such file or directory\n");
}

TEST_F(Gait, ValuesAreNamedAndPointIntoTheGait) {
  GaitSpec gait = LoadText(kCpg);
  std::string names;
  for (const GaitValue& value : GaitValues(gait)) {
    names += value.name + " [" + value.unit + "]\n";
    *value.value += 1.0;
  }
  EXPECT_EQ(names,
            "cpg.frequency_hz [Hz]\ncpg.amplitude_m_per_s [m/s]\ncpg.convergence_per_s [1/s]\n"
            "cpg.left.right.weight_per_m [1/m]\ncpg.left.right.phase_rad [rad]\n"
            "cpg.right.left.weight_per_m [1/m]\ncpg.right.left.phase_rad [rad]\n");
  EXPECT_EQ(gait.cpg->frequency_hz, 1.75);
  EXPECT_EQ(gait.cpg->groups[1].weight, 11.0);

  GaitSpec sine = LoadText(kSine);
  names.clear();
  for (const GaitValue& value : GaitValues(sine)) names += value.name + " ";
  EXPECT_EQ(names,
            "sine.frequency_hz sine.a.amplitude_m_per_s sine.a.phase_rad sine.a.offset_m_per_s "
            "sine.a.phase_per_segment_rad sine.b.amplitude_m_per_s sine.b.phase_rad "
            "sine.b.offset_m_per_s sine.b.phase_per_segment_rad sine.b.frequency_hz ");
  GaitSpec table = LoadText(kTable);
  EXPECT_TRUE(GaitValues(table).empty());
}

TEST_F(Gait, ValuesHaveTheNamesAndUnitsOfWhatIsDriven) {
  std::string names;
  for (const char* text : {kSine, kCpg}) {
    GaitSpec gait = LoadText(WithLengths(text));
    EXPECT_EQ(gait.drives, GaitDrives::kRestLength);
    for (const GaitValue& value : GaitValues(gait)) {
      if (value.unit.find('m') != value.unit.npos) names += value.name + " [" + value.unit + "]\n";
    }
  }
  EXPECT_EQ(names,
            "sine.a.amplitude_m [m]\nsine.a.offset_m [m]\nsine.b.amplitude_m [m]\n"
            "sine.b.offset_m [m]\ncpg.amplitude_m [m]\ncpg.left.right.weight_per_m_s [1/(m s)]\n"
            "cpg.right.left.weight_per_m_s [1/(m s)]\n");
  EXPECT_EQ(LoadText(WithLengths(kSine)).sine->waves[0].amplitude, -0.08);
  EXPECT_EQ(LoadText(WithLengths(kCpg)).cpg->groups[0].weight, 20.0);
  EXPECT_EQ(LoadText(kSine).drives, GaitDrives::kVelocity);
}

TEST_F(Gait, AKeyOfTheOtherQuantityIsAnsweredWithTheRightOne) {
  Expect(WithLengths(kSine), "amplitude_m: -0.08", "amplitude_m_per_s: -0.08",
         "9:31: error: waves.amplitude_m_per_s has the wrong unit (a gait that drives rest "
         "lengths needs amplitude_m)");
  Expect(kSine, "offset_m_per_s: 0.01", "offset_m: 0.01",
         "8:76: error: waves.offset_m has the wrong unit (a gait that drives velocities needs "
         "offset_m_per_s)");
  Expect(WithLengths(kCpg), "amplitude_m: 0.1", "amplitude_m_per_s: 0.1\n  amplitude_m: 0.1",
         "7:3: error: cpg.amplitude_m_per_s has the wrong unit (a gait that drives rest "
         "lengths needs amplitude_m)");
  Expect(kCpg, "weight_per_m: 20", "weight_per_m_s: 20",
         "9:26: error: groups.weight_per_m_s has the wrong unit (a gait that drives "
         "velocities needs weight_per_m)");
  Expect(WithLengths(kSine), "amplitude_m: -0.08", "amplitude: -0.08",
         "9:31: error: unknown key \"amplitude\" in waves (did you mean \"amplitude_m\"?)");
  // if the driven quantity is unknown, the names of keys cause no errors
  Expect(WithLengths(kSine), "drives: rest_length", "drives: rest_lenght",
         "3:9: error: drives cannot be \"rest_lenght\" (did you mean \"rest_length\"?)");
}

TEST_F(Gait, WrongKeysAndValuesAreErrors) {
  Expect(kSine, "amplitude_m_per_s: -0.08", "amplitude: -0.08",
         "8:31: error: unknown key \"amplitude\" in waves (did you mean \"amplitude_m_per_s\"?)");
  Expect(kSine, "name: b", "name: a",
         "9:7: error: two waves are called a (the first is in line 8)");
  Expect(kSine, "cables: left", "cables: []",
         "8:25: error: waves.cables must not be empty (name the tags to match)");
  Expect(kSine, "frequency_hz: slow_hz", "frequency_hz: -1",
         "6:17: error: sine.frequency_hz must not be negative, got -1");
  Expect(kCpg, "symmetry: none", "symmetry: some",
         "7:13: error: cpg.symmetry cannot be \"some\" (did you mean \"none\"?)");
  Expect(kCpg, "amplitude_m_per_s: 0.1", "amplitude_m_per_s: -0.1\n  convergence_per_s: 0",
         "6:22: error: cpg.amplitude_m_per_s must not be negative, got -0.1\n"
         "7:22: error: cpg.convergence_per_s must be positive, got 0");
  Expect(kCpg, "right.left,", "left.right,",
         "10:7: error: two groups are called left.right (the first is in line 9)");
  Expect(kCpg, "cpg:", "cgp:", "4:1: error: unknown key \"cgp\" (did you mean \"cpg\"?)");
}

TEST_F(Gait, ATableMustBeOne) {
  const std::string rows = "rows: [[0, 0.1, -0.1], [0.5, 0.2, -0.2]]";
  Expect(kTable, rows, "rows: [[0, 0.1], [0.5, 0.2, -0.2]]",
         "6:10: error: table.rows: a row must have 3 numbers, got 2");
  Expect(kTable, rows, "rows: [[1, 0.1, -0.1], [1, 0.2, -0.2]]",
         "5:3: error: the first row of a table must be at 0 s, got 1 s\n"
         "5:3: error: the times of a table must increase, but 1 s follows 1 s");
  Expect(kTable, rows, "rows: []",
         "5:3: error: a table needs at least one column for a cable and one row");
  Expect(kTable, rows, rows + "\n  repeat_from_s: 0.5",
         "5:3: error: table.repeat_from_s must be before the last row, which is at 0.5 s");
  Expect(kTable, rows, "file: none.csv",
         "5:3: error: table.cables has no effect (the headings of the file name the cables)\n"
         "6:9: error: table.file: there is no file \"none.csv\" (paths are relative to the folder "
         "of the file that contains them)");
}

TEST_F(Gait, ATableInPlainTextIsReadOrItsErrorsAreSaid) {
  const std::string gait = "taut: 1\nkind: gait\nname: t\ntable: {file: t.csv}\n";
  Write("t.csv", "# commands\ntime_s,left_m_per_s,right_m_per_s\n0,0.1,-0.25\n0.5, 1e-3 ,0\r\n");
  const GaitSpec good = LoadText(gait);
  ASSERT_TRUE(good.table);
  EXPECT_EQ(good.table->cables, (std::vector<std::string>{"left", "right"}));
  EXPECT_EQ(good.table->rows, (std::vector<std::vector<double>>{{0.1, -0.25}, {0.001, 0.0}}));
  EXPECT_EQ(good.files, (std::vector<std::string>{Path("g.yaml"), Path("t.csv")}));

  Write("t.csv", "t,left,right_m_per_s\n");
  EXPECT_EQ(GaitComplaints(gait),
            "t.csv:1:1: error: column 2 has the unknown heading \"left\" (expected a cable's name "
            "with its unit, such as outer_top_1_m_per_s)\n"
            "t.csv:1:1: error: the first column must be time_s, got \"t\"\n");
  Write("t.csv", "time_s,left_m,_m_per_s\n");
  EXPECT_EQ(GaitComplaints(gait),
            "t.csv:1:1: error: column 2 has the unknown heading \"left_m\" (a gait that drives "
            "velocities needs left_m_per_s)\n"
            "t.csv:1:1: error: column 3 has the unknown heading \"_m_per_s\" (expected a cable's "
            "name with its unit, such as outer_top_1_m_per_s)\n");
  Write("t.csv", "time_s,left_m_per_s\n0,0.1,3\n1,nan\n2,\n3,4\n");
  EXPECT_EQ(GaitComplaints(gait),
            "t.csv:2:1: error: the row has 3 cells, but the header has 2\n"
            "t.csv:3:1: error: \"nan\" is not a finite number (column 2)\n"
            "t.csv:4:1: error: \"\" is not a finite number (column 2)\n");
  Write("t.csv", "");
  EXPECT_EQ(
      GaitComplaints(gait),
      "t.csv:1:1: error: the table has no header line (such as time_s,outer_top_1_m_per_s)\n");
}

TEST_F(Gait, ATableOfRestLengthsHasColumnsInMetres) {
  const std::string gait =
      "taut: 1\nkind: gait\nname: t\ndrives: rest_length\ntable: {file: t.csv}\n";
  Write("t.csv", "time_s,left_m,right_m\n0,0.1,-0.25\n");
  const GaitSpec good = LoadText(gait);
  ASSERT_TRUE(good.table);
  EXPECT_EQ(good.table->cables, (std::vector<std::string>{"left", "right"}));
  EXPECT_EQ(GaitTableText(*good.table, good.drives), "time_s,left_m,right_m\n0,0.1,-0.25\n");
  Write("t.csv", "time_s,left_m_per_s,right\n0,0.1,-0.25\n");
  EXPECT_EQ(GaitComplaints(gait),
            "t.csv:1:1: error: column 2 has the unknown heading \"left_m_per_s\" (a gait that "
            "drives rest lengths needs left_m)\n"
            "t.csv:1:1: error: column 3 has the unknown heading \"right\" (expected a cable's name "
            "with its unit, such as outer_top_1_m)\n");
  Write("t.csv", "");
  EXPECT_EQ(GaitComplaints(gait),
            "t.csv:1:1: error: the table has no header line (such as time_s,outer_top_1_m)\n");
}

TEST_F(Gait, AGaitMustFitTheRobotThatPlaysIt) {
  EXPECT_EQ(PlayedComplaints(kSine), "");
  EXPECT_EQ(PlayedComplaints(kCpg), "");
  EXPECT_EQ(PlayedComplaints(kTable), "");
  std::string text = kSine;
  text.replace(text.find("cables: left"), 12, "cables: lefty");
  EXPECT_EQ(PlayedComplaints(text),
            "g.yaml:8:7: error: wave a: no cable matches [lefty] (no cable of pair is called or "
            "tagged \"lefty\"; did you mean \"left\"?)\n");
  text = kSine;
  text.replace(text.find("cables: left"), 12, "cables: driven");
  EXPECT_EQ(
      PlayedComplaints(text),
      "g.yaml:9:7: error: wave b: right already has the wave a (a cable can have only one wave)\n");
  text = kSine;
  text.replace(text.find("cables: left"), 12, "cables: loose");
  EXPECT_EQ(PlayedComplaints(text),
            "trial.yaml:11:21: error: gait waves drives loose, which controller hold does not "
            "drive (add `gains` and `set_points` for them)\n");
  text = kSine;
  text.replace(text.find("offset_m_per_s: 0.01"), 20, "phase_per_segment_rad: 1");
  EXPECT_EQ(PlayedComplaints(text),
            "g.yaml:8:7: error: wave a: phase_per_segment_rad needs cable names that end in a "
            "number, got left (such as outer_top_2)\n");
  text = kCpg;
  text.replace(text.find("left.right"), 10, "left.rihgt");
  EXPECT_EQ(PlayedComplaints(text),
            "g.yaml:5:3: error: cpg.groups lacks left.right (`taut gait create` writes a file with "
            "all groups of a robot)\n"
            "g.yaml:9:7: error: cpg.groups: pair has no group left.rihgt (did you mean "
            "\"left.right\"?)\n");
  text = kCpg;
  text.replace(text.find("symmetry: none"), 14, "symmetry: segments");
  EXPECT_EQ(
      PlayedComplaints(text),
      "g.yaml:5:3: error: the name of cable left does not end in a number (use names such as "
      "outer_top_2, by which symmetric couplings distinguish cables, or write `symmetry: none`)\n");
  text = kCpg;
  text.replace(text.find("symmetry: none"), 14,
               "symmetry: none\n  order: [left, loose, left, rihgt]");
  EXPECT_EQ(
      PlayedComplaints(text),
      "g.yaml:5:3: error: cpg.order contains left twice\n"
      "g.yaml:5:3: error: cpg.order: loose has no actuator (give the cable's builder in the model "
      "an `actuator:`)\n"
      "g.yaml:5:3: error: cpg.order: there is no cable \"rihgt\" (did you mean \"right\"?)\n");
  text = kCpg;
  text.replace(text.find("symmetry: none"), 14, "symmetry: none\n  inverted: lfet");
  EXPECT_EQ(PlayedComplaints(text),
            "g.yaml:5:3: error: cpg.inverted: no cable matches [lfet] (no cable of pair is called "
            "or tagged \"lfet\"; did you mean \"left\"?)\n");
  text = kTable;
  text.replace(text.find("[left, right]"), 13, "[left, rihgt]");
  EXPECT_EQ(PlayedComplaints(text),
            "g.yaml:5:3: error: pair has no cable \"rihgt\" (did you mean \"right\"?)\n");
  text.replace(text.find("[left, rihgt]"), 13, "[left, left]");
  EXPECT_EQ(PlayedComplaints(text), "g.yaml:5:3: error: the table contains left twice\n");
}

}  // namespace
}  // namespace taut::test
