// Functions of one line in a table of keys, with tables of this file
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "base/name_unit.h"
#include "description/yaml/number_list.h"
#include "description/yaml/read_keys.h"
#include "description/yaml/write_keys.h"

namespace taut::description {
namespace {

enum class Law { kLinear, kSquare };
const Choices<Law> kLaws{{"linear", Law::kLinear}, {"square", Law::kSquare}};

struct Damper {
  std::string name;
  double damping_n_s_per_m = 2.0;
  Law law = Law::kLinear;
};
template <class Io>
void Keys(Io& io, Like<Damper> auto& d) {
  io.Map("", "damper", "It damps.");
  io("name", d.name, kNeeded, kName, "Its name.");
  io("damping_n_s_per_m", d.damping_n_s_per_m, Bound{.least = 1, .most = 10}, "b.");
  io("law", d.law, kLaws, "How.");
}

struct Spring {
  SourceRef at;
  bool good = true;
  std::string source;
  double stiffness_n_per_m = 7.0, limit_n = std::numeric_limits<double>::infinity();
  Vec3 axis{1.0, 0.0, 0.0};
  std::optional<double> length_m, length_ratio;
  std::vector<Damper> dampers;
};
template <class Io>
void Keys(Io& io, Like<Spring> auto& s) {
  io.Map("spring", "spring", "It pulls.");
  io.OneOf({"length_m", "length_ratio"});
  io("source", s.source, kResolvedOnly);
  io("stiffness_n_per_m", s.stiffness_n_per_m, kNeeded, Bound::kPositive, "k.");
  io("limit_n", s.limit_n, kLimit, Bound::kPositive, "Most.");
  io("axis", s.axis, kDirection, "Along.");
  io("length_m", s.length_m, Bound::kPositive, "L.");
  io("length_ratio", s.length_ratio, kFixed, Bound::kPositive, "L / l.");
  io("dampers", s.dampers, "Beside it.");
}
void Check(const MapReader& map, Spring& spring) {
  if (spring.length_m > 100.0) map.Error("test.too_long", "length_m", "too long for this room");
}

constexpr Spellings kReach{{"reach_m", "reach_rad"}, {"a line", "a turn"}};

struct Stroke {
  std::string name;
  double reach = 1.0;
};
template <class Io>
void Keys(Io& io, Like<Stroke> auto& s) {
  io.Map("strokes", "strokes", "There and back.");
  io("name", s.name, kNeeded, "Its name.");
  io(kReach, s.reach, kNeeded, Bound::kPositive, "How far.");
}

/// Moves by a spring's pull, or by a crank, a rope or both
struct Drive {
  bool turns = false;
  double pull_n = 0.0, slack_m = 0.5;
  std::optional<double> crank_m, rope_m;
  std::vector<Stroke> strokes;
};
const Choices<bool> kTurns{{"line", false}, {"turn", true}};
template <class Io>
void Keys(Io& io, Like<Drive> auto& d) {
  io.Map("drive", "drive", "It moves.");
  io("moves", d.turns, kTurns, kLater, "How.");
  io.SpeltBy("moves", {d.turns ? 1 : 0, d.turns ? "what turns" : "what goes straight"});
  io.EitherSide({"pull_n"}, {"crank_m", "rope_m"});
  io("pull_n", d.pull_n, "Pull.");
  io("crank_m", d.crank_m, "Crank.");
  io("rope_m", d.rope_m, "Rope.");
  io("slack_m", d.slack_m, LaterThan{0.5}, "Slack.");
  io("strokes", d.strokes, kLater, "Strokes.");
}

class Tables : public ::testing::Test {
 protected:
  template <class T = Spring>
  T Read(const std::string& text) {
    Diagnostics out;
    const ValuePtr root = ParseYaml(text, "f.yaml", out);
    T read;
    if (root) ReadMapping(*root, "", {names_, out}, read);
    errors_ = out.Format();
    return read;
  }
  NameTable names_{{"edge_m", 0.5}};
  std::string errors_;
};

TEST_F(Tables, ALineIsReadWithRangeAndDefault) {
  const Spring spring = Read(
      "{stiffness_n_per_m: 2 * edge_m, length_m: edge_m, axis: [0, 3, 0],\n"
      " dampers: [{name: a}, {name: b, damping_n_s_per_m: 3, law: square}]}");
  EXPECT_EQ(errors_, "");
  EXPECT_TRUE(spring.good);
  EXPECT_EQ(spring.at.line, 1);
  EXPECT_EQ(spring.stiffness_n_per_m, 1.0);
  EXPECT_EQ(spring.length_m, 0.5);
  EXPECT_FALSE(spring.length_ratio);
  EXPECT_EQ(spring.axis.y, 1.0);
  EXPECT_TRUE(std::isinf(spring.limit_n));
  ASSERT_EQ(spring.dampers.size(), 2u);
  EXPECT_EQ(spring.dampers[0].damping_n_s_per_m, 2.0);
  EXPECT_EQ(spring.dampers[1].damping_n_s_per_m, 3.0);
  EXPECT_EQ(spring.dampers[1].law, Law::kSquare);
}

TEST_F(Tables, WhatIsWrongIsSaidWithItsPlaceAllAtOnce) {
  const Spring spring = Read(
      "{stiffnes_n_per_m: 1,\n source: x,\n limit_n: 0,\n axis: [0, 0, 0],\n length_m: 200,\n"
      " dampers: [{damping_n_s_per_m: 11, law: cubic}]}");
  EXPECT_EQ(errors_,
            "f.yaml:1:2: error: unknown key \"stiffnes_n_per_m\" in spring (did you mean "
            "\"stiffness_n_per_m\"?)\n"
            "f.yaml:2:2: error: unknown key \"source\" in spring (one of: stiffness_n_per_m, "
            "limit_n, axis, length_m, length_ratio, dampers)\n"
            "f.yaml:3:11: error: spring.limit_n must be positive, got 0\n"
            "f.yaml:4:8: error: spring.axis must not be zero (it is a direction)\n"
            "f.yaml:6:12: error: spring.dampers needs the key \"name\"\n"
            "f.yaml:6:32: error: spring.dampers.damping_n_s_per_m must be within 1..10, got 11\n"
            "f.yaml:6:41: error: spring.dampers.law cannot be \"cubic\" (one of: linear, "
            "square)\n");
  EXPECT_FALSE(spring.good);
  EXPECT_TRUE(std::isnan(spring.stiffness_n_per_m));  // so that no further errors follow
}

TEST_F(Tables, OfSeveralNoneIsLookedAt) {
  const Spring spring = Read("{stiffness_n_per_m: 1, length_m: 200, length_ratio: -1}");
  EXPECT_EQ(
      errors_,
      "f.yaml:1:39: error: spring has both length_m and length_ratio (give only one of them)\n");
  EXPECT_FALSE(spring.length_m);
}

TEST_F(Tables, ALineIsWrittenForResolvedExperimentsAndForPeople) {
  const Spring spring = Read("{stiffness_n_per_m: 1, length_m: 2, dampers: [{name: a_1}]}");
  FlowWriter<true> resolved;
  Keys(resolved, spring);
  EXPECT_EQ(resolved.text(),
            "source: \"\", stiffness_n_per_m: 1, axis: [1, 0, 0], length_m: 2, "
            "dampers: [{name: \"a_1\", damping_n_s_per_m: 2, law: linear}]");
  FlowWriter<false> people;
  Keys(people, spring);
  EXPECT_EQ(people.text(),
            "stiffness_n_per_m: 1, axis: [1, 0, 0], length_m: 2, "
            "dampers: [{name: a_1, damping_n_s_per_m: 2, law: linear}]");
  EXPECT_EQ(PlainOrQuoted("No"), "\"No\"");
  EXPECT_EQ(PlainOrQuoted("a \"b\""), "\"a \\\"b\\\"\"");
}

TEST_F(Tables, NumbersAreListedByName) {
  Spring spring = Read("{stiffness_n_per_m: 1, length_ratio: 2, dampers: [{name: a}]}");
  struct Number {
    std::string name, unit;
    double* value;
    double least, most;
  };
  NumberList<Number> list("s.");
  Keys(list, spring);
  std::string names;
  for (const Number& number : list.numbers) names += number.name + " [" + number.unit + "] ";
  EXPECT_EQ(names, "s.stiffness_n_per_m [N/m] s.limit_n [N] s.a.damping_n_s_per_m [N s/m] ");
  EXPECT_EQ(list.numbers[2].value, &spring.dampers[0].damping_n_s_per_m);
  EXPECT_EQ(list.numbers[2].most, 10.0);
}

TEST_F(Tables, AKeyIsSpeltAsAnotherSays) {
  Drive drive = Read<Drive>("{moves: turn, pull_n: 1, strokes: [{name: a, reach_rad: 2}]}");
  EXPECT_EQ(errors_, "");
  ASSERT_EQ(drive.strokes.size(), 1u);
  EXPECT_EQ(drive.strokes[0].reach, 2.0);
  FlowWriter<true> resolved;
  Keys(resolved, std::as_const(drive));
  EXPECT_EQ(resolved.text(), "moves: turn, pull_n: 1, strokes: [{name: \"a\", reach_rad: 2}]");
  struct Number {
    std::string name, unit;
    double* value;
    double least, most;
  };
  NumberList<Number> list("");
  Keys(list, drive);
  EXPECT_EQ(list.numbers.back().name, "a.reach_rad");
  EXPECT_EQ(list.numbers.back().unit, "rad");

  Read<Drive>("{moves: turn, pull_n: 1, strokes: [{name: a, reach_m: 2}, {name: b, reach: 1}]}");
  EXPECT_EQ(errors_,
            "f.yaml:1:46: error: strokes.reach_m has the wrong unit (what turns needs reach_rad)\n"
            "f.yaml:1:69: error: unknown key \"reach\" in strokes (did you mean \"reach_rad\"?)\n");
  // if the kind of motion is unknown, both keys are accepted
  Read<Drive>(
      "{moves: trun, pull_n: 1, strokes: [{name: a, reach_m: 2}, {name: b, reach_rad: 1}]}");
  EXPECT_EQ(errors_,
            "f.yaml:1:9: error: drive.moves cannot be \"trun\" (did you mean \"turn\"?)\n");
}

TEST_F(Tables, WhatCameLaterIsWrittenIfItSaysSomething) {
  const Drive old_drive = Read<Drive>("{pull_n: 1}");
  FlowWriter<true> as_before;
  Keys(as_before, old_drive);
  EXPECT_EQ(as_before.text(), "pull_n: 1");
  const Drive new_drive = Read<Drive>("{pull_n: 1, slack_m: 0.25}");
  FlowWriter<true> later;
  Keys(later, new_drive);
  EXPECT_EQ(later.text(), "pull_n: 1, slack_m: 0.25");
}

TEST_F(Tables, OneSideOrTheOther) {
  const Drive both = Read<Drive>("{crank_m: 1, rope_m: 2}");
  EXPECT_EQ(errors_, "");
  EXPECT_EQ(both.rope_m, 2.0);
  Read<Drive>("{rope_m: 2, pull_n: 1}");
  EXPECT_EQ(errors_,
            "f.yaml:1:2: error: drive has both pull_n and rope_m (give only one of them)\n");
  Read<Drive>("{slack_m: 1}");
  EXPECT_EQ(errors_, "f.yaml:1:1: error: drive needs one of pull_n, crank_m, rope_m\n");
}

TEST(Units, AreThoseOfTheName) {
  EXPECT_EQ(base::UnitAtEnd("damping_n_s_per_m").Text(), "N s/m");
  EXPECT_EQ(base::UnitAtEnd("weight_per_m_s").Text(), "1/(m s)");
  EXPECT_EQ(base::UnitAtEnd("proportional_m_per_s_n").Text(), "m/(s N)");
  EXPECT_EQ(base::UnitAtEnd("integral_m_per_s2_n").Text(), "m/(s^2 N)");
  EXPECT_EQ(base::UnitAtEnd("weight_per_m").Text(), "1/m");
  EXPECT_EQ(base::UnitAtEnd("phase_per_segment_rad").Text(), "rad");
  EXPECT_EQ(base::UnitAtEnd("counts_per_turn").Text(), "");
  EXPECT_EQ(base::UnitAtEnd("rate_hz").Text(), "Hz");
  EXPECT_EQ(base::UnitAtEnd("torque_constant_n_m_per_a").Text(), "N m/A");
  EXPECT_EQ(base::UnitAtEnd("housing_thermal_resistance_k_per_w").Text(), "K/W");
  EXPECT_EQ(base::UnitAtEnd("resistance_ohm").Text(), "ohm");
  EXPECT_EQ(base::UnitAtEnd("winding_temperature_c").Text(), "degC");
  EXPECT_EQ(base::UnitAtEnd("supply_voltage_v").Text(), "V");
  EXPECT_EQ(base::UnitAtEnd("orientation_w").Text(), "");  // a component
  EXPECT_EQ(base::UnitAtEnd("body_a").Text(), "");         // a label
  EXPECT_EQ(base::UnitAtEnd("friction").Text(), "");
  EXPECT_EQ(base::UnitAtEnd("s").Text(), "");
}

}  // namespace
}  // namespace taut::description
