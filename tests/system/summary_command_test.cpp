// The form of every command's text: the verdict, at most ten further lines, the next command
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "taut_command.h"

namespace taut {
namespace {

const std::string kShare = TAUT_SOURCE_DIR "/share/";
const std::string kHangSummary = kShare + "experiments/hang.yaml";
const std::string kPrism = kShare + "models/prism3.yaml";

class SummaryCommand : public test::CommandTest {
 protected:
  /// Runs a command. Returns its text, which must begin with `verdict`, have at most 12 lines
  /// besides exceeded limits, and end with the next command.
  std::string Brief(const std::vector<std::string>& words, const std::string& verdict,
                    int status = 0) {
    const test::CommandResult result = Taut(words);
    EXPECT_EQ(result.status, status) << result.output << result.errors;
    EXPECT_EQ(result.output.rfind(verdict, 0), 0u) << result.output;
    std::istringstream lines(result.output);
    int count = 0;
    for (std::string line; std::getline(lines, line);) count += line.rfind("FAIL", 0) != 0;
    EXPECT_LE(count, 12) << result.output;
    EXPECT_EQ(NextOf(result.output).rfind("next: ", 0), 0u) << result.output;
    return result.output;
  }

  static std::string NextOf(const std::string& text) {
    if (text.size() < 2) return {};
    return text.substr(text.rfind('\n', text.size() - 2) + 1);
  }

  void RunHang(const std::string& folder, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"run", kHangSummary, "--quiet", "--out", folder};
    words.insert(words.end(), more.begin(), more.end());
    ASSERT_EQ(Taut(words).status, 0);
  }
};

TEST_F(SummaryCommand, ARun) {
  const std::string prism = kShare + "experiments/drop_six_strut.yaml";
  const std::string text =
      Brief({"run", prism, "--duration_s", "0.1", "--out", "a"}, "drop_six_strut: ok; 0.1 s simu");
  EXPECT_NE(text.find("\n  largest tension: "), std::string::npos) << text;
  EXPECT_NE(text.find("\n  24 cables"), std::string::npos) << text;
  EXPECT_EQ(text.find("tension [N]"), std::string::npos) << text;
  EXPECT_EQ(NextOf(text), "next: taut view a\n");
  const std::string tables =
      Taut({"run", prism, "--duration_s", "0.1", "--out", "a", "--tables"}).output;
  EXPECT_NE(tables.find("tension [N]"), std::string::npos) << tables;
}

TEST_F(SummaryCommand, AStructureThatStands) {
  const std::string text =
      Brief({"analyze", kPrism}, "prism3 stands: prestress-stable, least stiff");
  EXPECT_NE(text.find("\n  3 cables side: tension 20.000 N\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("Described pose"), std::string::npos) << text;
  EXPECT_NE(Taut({"analyze", kPrism, "--tables"}).output.find("\nDescribed pose\n"),
            std::string::npos);
  Brief({"analyze", kPrism, "--inverse", "--at_least_n", "10"}, "prism3: tensions hold the descri");
  Brief({"analyze", kPrism, "--inverse", "--at_least_n", "10", "--at_most_n", "12"},
        "prism3: no tensions hold the described pose", 1);
  Brief({"analyze", kShare + "models/six_strut.yaml", "--form", "--tension_n", "10"},
        "six_strut: equilibrium shape found");
  Brief({"analyze", kPrism, "--linear", "prism.h5"}, "prism3: linearized about its equilibrium");
}

TEST_F(SummaryCommand, AStructureThatNeedsAnotherForm) {
  const std::string six = kShare + "models/six_strut.yaml";
  EXPECT_EQ(NextOf(Taut({"analyze", six}).output),
            "next: taut analyze " + six + " --form --tension_n 10\n");
}

TEST_F(SummaryCommand, AComparison) {
  RunHang("a");
  RunHang("b", {"--set", "mass_kg=0.51"});
  EXPECT_EQ(NextOf(Brief({"compare", "a", "a"}, "a/trace.h5 and a/trace.h5 are equal: ")),
            "next: taut report a/trace.h5 --compare a/trace.h5\n");
  Brief({"compare", "b", "a"}, "b/trace.h5 and a/trace.h5 differ in ");
  Brief({"compare", "b", "a", "--max_rmse", "1e-9"}, "FAIL: ", 1);
}

TEST_F(SummaryCommand, DemandsOnMotors) {
  ASSERT_EQ(
      Taut({"run", kShare + "experiments/rest_length_sine.yaml", "--out", "run", "--quiet"}).status,
      0);
  const std::string text = Brief({"size", "run"}, "rest_length_sine: requirements of ");
  EXPECT_EQ(NextOf(text), "next: taut size run --tables\n");
  EXPECT_EQ(Taut({"size", "run/trace.h5"}).output.substr(0, 40), text.substr(0, 40));
  const std::string catalogue = TAUT_SOURCE_DIR "/examples/winches.yaml";
  EXPECT_NE(Taut({"size", "run", "--catalogue", catalogue, "--tables"}).output.find("\nMotors: "),
            std::string::npos);
}

TEST_F(SummaryCommand, ImportsAndExports) {
  Brief({"export", "structure", kPrism}, "prism3: nodes: 6, bars: 3, strings: 9");
  ASSERT_EQ(Taut({"export", "mjcf", kPrism, "--out", "p.xml"}).status, 0);
  EXPECT_EQ(Brief({"import", "mjcf", "p.xml", "--out", "p.yaml"}, "p.yaml: model of "),
            "p.yaml: model of 3 bodies, 9 cables, 0 joints\nnext: taut check p.yaml\n");
}

TEST_F(SummaryCommand, FoldersOfRunsStandForTheirTraces) {
  const std::string drop = kShare + "experiments/drop_six_strut.yaml";
  ASSERT_EQ(Taut({"run", drop, "--duration_s", "0.1", "--quiet", "--out", "dropped"}).status, 0);
  for (const std::string where : {"dropped", "dropped/trace.h5"}) {
    EXPECT_EQ(Taut({"analyze", drop, "--pose", where, "--modes", "0", "--json"}).status, 0)
        << where;
    EXPECT_EQ(Taut({"export", "structure", drop, "--pose", where}).status, 0) << where;
  }
  RunHang("a");
  for (const std::string where : {"a", "a/trace.h5"}) {
    EXPECT_EQ(Taut({"run", kHangSummary, "--replay", where, "--out", "b", "--quiet"}).status, 0)
        << where;
    EXPECT_EQ(Taut({"trace", "convert", where, "--out", "t.csv", "--quiet"}).status, 0) << where;
    EXPECT_EQ(Taut({"size", where}).status, 0) << where;
    EXPECT_EQ(Taut({"compare", where, where}).status, 0) << where;
  }
}

}  // namespace
}  // namespace taut
