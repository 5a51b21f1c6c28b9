// Errors of study files, reported all at once with their places and hints
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "taut/study.h"

namespace taut {
namespace {

const std::string kGoodStudy = R"(taut: 1
kind: study
name: s
experiment: )" TAUT_SOURCE_DIR R"(/share/experiments/push_20n.yaml
seed: 1
vary:
  - {each: impedance.outer_*_1.tension_offset_n, low: 1, high: 20}
  - {name: friction, all: model.friction, low: 0.5, high: 2, scale: log}
objective: {measure: heading, direction: [0, 2, 0], from_s: 5}
worlds: {count: 4, friction: 0.2, start: {position_m: 0.001}, score: worst}
search:
  - {method: monte_carlo, evaluations: 10}
  - {method: nlopt, algorithm: bobyqa, evaluations: 20}
)";

class StudyFile : public testing::Test {
 protected:
  std::optional<StudySpec> Load(const std::string& text) {
    const auto path = std::filesystem::temp_directory_path() /
                      ("taut_study_" + std::to_string(getpid()) + ".yaml");
    std::ofstream(path) << text;
    out_ = {};
    auto study = LoadStudy(path.string(), {}, out_);
    std::filesystem::remove(path);
    return study;
  }
  /// Returns the messages, without the file's name, for the valid study with `old` replaced.
  std::string Wrong(const std::string& old, const std::string& by) {
    std::string text = kGoodStudy;
    const std::size_t at = text.find(old);
    EXPECT_NE(at, text.npos) << old;
    EXPECT_FALSE(Load(text.replace(at, old.size(), by)));
    std::string messages;
    for (const Diagnostic& d : out_.items()) {
      messages += std::to_string(d.at.line) + ": " + d.what +
                  (d.hint.empty() ? "" : " (" + d.hint + ")") + "\n";
    }
    return messages;
  }
  Diagnostics out_;
};

TEST_F(StudyFile, IsRead) {
  const auto study = Load(kGoodStudy);
  ASSERT_TRUE(study) << out_.Format();
  ASSERT_EQ(study->parameters.size(), 4u);
  EXPECT_EQ(study->parameters[0].name, "impedance.outer_right_1.tension_offset_n");
  EXPECT_EQ(study->parameters[0].unit, "N");
  EXPECT_EQ(study->parameters[3].name, "friction");
  EXPECT_TRUE(study->parameters[3].log);
  EXPECT_EQ(study->objective.direction.y, 1.0);
  EXPECT_TRUE(study->perturbation.worst);
  EXPECT_EQ(std::get<NloptSpec>(study->searches[1].method).algorithm, "bobyqa");
}

TEST_F(StudyFile, AParameterThatNothingReadsIsAWarning) {
  std::string text = kGoodStudy;
  text.replace(text.find("low: 1,"), 7, "low: least_n,");
  text += "parameters: {least_n: 1, idle: least_n}\n";
  ASSERT_TRUE(Load(text)) << out_.Format();
  ASSERT_EQ(out_.warnings().size(), 1u) << out_.Format();
  EXPECT_EQ(out_.warnings()[0].what, "the parameter \"idle\" is not used");
  EXPECT_EQ(out_.warnings()[0].at.line, 14);
}

TEST_F(StudyFile, ParametersAreAThousandAtMost) {
  std::string many;
  for (int i = 0; i < 2000; ++i) {
    many += "\n  - {name: p" + std::to_string(i) + ", all: model.friction, low: 0.5, high: 2}";
  }
  const std::string wrong = Wrong(
      "\n  - {each: impedance.outer_*_1.tension_offset_n, low: 1, "
      "high: 20}",
      many);
  EXPECT_NE(wrong.find("7: vary has more than 1000 parameters (use `all` instead of `each`, so "
                       "that groups share a parameter)\n"),
            wrong.npos)
      << wrong;
  // Entries after the limit are not read, so they add no errors.
  EXPECT_LT(out_.items().size(), 1100u);
}

TEST_F(StudyFile, UnknownNamesAreSaidWithTheLikelyOne) {
  EXPECT_EQ(
      Wrong("all: model.friction", "all: model.fricton"),
      "8: vary.all: there is no parameter \"model.fricton\" (did you mean \"model.friction\"?)\n");
  const std::string far = Wrong("impedance.outer_*_1.tension_offset_n", "nothing.like.it");
  EXPECT_EQ(far,
            "7: vary.each: there is no parameter \"nothing.like.it\" (`taut learn --parameters "
            "EXPERIMENT` lists them all)\n");
}

TEST_F(StudyFile, BoundsMustLeaveRoom) {
  EXPECT_EQ(
      Wrong("low: 1, high: 20", "low: 20, high: 1"),
      "7: vary: low 20 is above high 1 (to keep a parameter fixed, set it in the experiment)\n");
  EXPECT_EQ(Wrong("low: 1, high: 20", "low: 3, high: 3"),
            "7: vary: low and high are equal, both 3 (to keep a parameter fixed, set it in the "
            "experiment)\n");
  EXPECT_EQ(Wrong("low: 1, high: 20", "low: .nan, high: 20").substr(0, 12), "7: vary.low ");
  EXPECT_EQ(Wrong("low: 0.5, high: 2", "low: 0, high: 2"),
            "8: vary: `scale: log` needs bounds above 0, got 0\n");
  EXPECT_EQ(Wrong("low: 1, high: 20", "low: -1, high: 20"),
            "7: vary: impedance.outer_right_1.tension_offset_n must stay within 0..inf N\n");
}

TEST_F(StudyFile, ANumberIsVariedOnce) {
  EXPECT_EQ(Wrong("all: model.friction", "all: impedance.outer_top_1.tension_offset_n"),
            "8: vary: impedance.outer_top_1.tension_offset_n is varied twice (first in line 7)\n");
}

TEST_F(StudyFile, AllErrorsAreSaidAtOnce) {
  std::string text = kGoodStudy;
  const auto replace = [&](const std::string& old, const std::string& by) {
    text.replace(text.find(old), old.size(), by);
  };
  replace("name: s", "nam: s");
  replace("high: 20}", "hig: 20}");
  replace("friction: 0.2, start", "friction: 1.5, start");
  replace("evaluations: 10", "evaluations: 0");
  replace("from_s: 5", "from_s: 500");
  EXPECT_FALSE(Load(text));
  const std::string all = out_.Format();
  for (const char* part :
       {"unknown key \"nam\"", "unknown key \"hig\"",
        "worlds.friction must be below 1, got 1.5 (0.2 means factors from 0.8 to 1.2)",
        "search.evaluations",
        "objective.from_s must be before the end of the experiment (the end is at 60 s)"}) {
    EXPECT_NE(all.find(part), std::string::npos) << part << "\n" << all;
  }
}

TEST_F(StudyFile, AnObjectiveAloneIsReadAsThatOfAStudy) {
  const auto study = Load(kGoodStudy);
  ASSERT_TRUE(study);
  Diagnostics out;
  const auto same =
      ReadObjective("{\"measure\": \"heading\", \"direction\": [0, 2, 0], \"from_s\": 5}", "text",
                    study->experiment, out);
  ASSERT_TRUE(same) << out.Format();
  EXPECT_EQ(same->measure, study->objective.measure);
  EXPECT_EQ(same->direction.y, 1.0);
  EXPECT_EQ(same->from_s, 5.0);
  EXPECT_FALSE(
      ReadObjective("{measure: nearer, from_s: 500, form: 1}", "text", study->experiment, out));
  EXPECT_EQ(
      out.Format(),
      "text:1:2: error: objective.measure: nearer needs a goal (add a `goal` to the experiment)\n"
      "text:1:19: error: objective.from_s must be before the end of the experiment (the end is at "
      "60 s)\n"
      "text:1:32: error: unknown key \"form\" in objective (one of: measure, direction, from_s, "
      "tension_limit, fall, max_speed_m_per_s)\n");
  Diagnostics others;
  for (const char* text : {"", "[1]", "{measure: [}", "5"}) {
    const std::size_t before = others.items().size();
    EXPECT_FALSE(ReadObjective(text, "text", study->experiment, others)) << text;
    EXPECT_GT(others.items().size(), before) << text;
  }
}

TEST_F(StudyFile, KeysOfOtherMethodsAreSaid) {
  EXPECT_EQ(Wrong("method: monte_carlo,", "method: monte_carlo, deviation: 0.1,"),
            "12: search.deviation has no effect here (it is for hill_climbing and cma_es)\n");
  EXPECT_EQ(Wrong("method: monte_carlo,", "method: monte_carlo, starts: 3,"),
            "12: search.starts has no effect here (it is for `method: nlopt`)\n");
  EXPECT_EQ(
      Wrong("algorithm: bobyqa,", "algorithm: bobyqa, batch: 3,"),
      "13: search: nlopt uses neither batch nor deviation (use `starts` and `initial_step`)\n");
  EXPECT_EQ(Wrong("algorithm: bobyqa", "algorithm: praxis"),
            "13: search.algorithm cannot be \"praxis\" (one of: nelder_mead, subplex, bobyqa, "
            "cobyla)\n");
}

TEST_F(StudyFile, AHeadingNeedsADirection) {
  EXPECT_EQ(Wrong("direction: [0, 2, 0], ", ""),
            "9: objective: heading needs the key \"direction\" (such as [1, 0, 0])\n");
}

TEST_F(StudyFile, ErrorsOfItsExperimentAreItsErrors) {
  const std::string all = Wrong("push_20n.yaml", "no_such.yaml");
  EXPECT_NE(all.find("4: experiment: there is no file"), std::string::npos) << all;
}

TEST_F(StudyFile, WhatItFindsDoesNotDependOnTheLastBudget) {
  const auto a = Load(kGoodStudy);
  std::string text = kGoodStudy;
  text.replace(text.find("evaluations: 20"), 15, "evaluations: 90");
  const auto b = Load(text);
  text.replace(text.find("evaluations: 10"), 15, "evaluations: 11");
  const auto c = Load(text);
  ASSERT_TRUE(a && b && c);
  EXPECT_EQ(StudyText(*a), StudyText(*b));
  EXPECT_NE(StudyText(*a), StudyText(*c));
}

}  // namespace
}  // namespace taut
