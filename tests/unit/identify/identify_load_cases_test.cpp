// Load cases compared with measurements: a mass on a cable under forces, in closed form
#include <array>
#include <cmath>
#include <filesystem>
#include <map>

#include "tests/unit/identify/identify_fixture.h"

namespace taut {
namespace {

using test::IdentifyTest;

/// Forces sideways, downward, in both directions, and without weight
struct Case {
  const char* name;
  double x_n, z_n;
  bool weight;
};
constexpr std::array<Case, 4> kCases{
    {{"side", 3, 0, true}, {"down", 0, -7, true}, {"both", -4, -2, true}, {"alone", 0, -2, false}}};

const std::string kLoadCasesFit = R"(taut: 1
kind: fit
name: f
experiments: [{name: a, experiment: experiment.yaml, data: a.csv, forward: load_cases}]
estimate: [{parameter: k_n_per_m, low: 40, high: 250, scale: 20}]
residuals: [{channel: node/ball/position_*_m, sd: 0.001}]
groups: window
)";

double Pull(const Case& c) { return std::hypot(c.x_n, (c.weight ? -5 : 0) + c.z_n); }
/// Returns the place of the mass, which hangs in the direction of the total force, at L + T / k
/// from (0, 0, 1).
double Place(const Case& c, double k_n_per_m, bool z) {
  const double along_n = z ? (c.weight ? -5 : 0) + c.z_n : c.x_n;
  return (z ? 1 : 0) + (0.9 + Pull(c) / k_n_per_m) * along_n / Pull(c);
}

class LoadCases : public IdentifyTest {
 protected:
  void SetUp() override {
    IdentifyTest::SetUp();
    std::string cases;
    for (const Case& c : kCases) {
      cases += std::string("  - {name: ") + c.name + ", weight: " + (c.weight ? "true" : "false") +
               ", forces: [{node: ball, force_n: [" + std::to_string(c.x_n) + ", 0, " +
               std::to_string(c.z_n) + "]}]}\n";
    }
    Write("experiment.yaml",
          "taut: 1\nkind: experiment\nname: pull\nmodel: model.yaml\n"
          "gravity_m_per_s2: [0, 0, -10]\nduration_s: 1\nload_cases:\n" +
              cases);
    WriteCases(110);
  }
  void WriteCases(double k_n_per_m) {
    std::ofstream file(folder_ / "a.csv");
    file.precision(17);
    file << "time_s,node/ball/position_x_m,node/ball/position_z_m\n";
    for (std::size_t i = 0; i < kCases.size(); ++i) {
      file << i << "," << Place(kCases[i], k_n_per_m, false) << ","
           << Place(kCases[i], k_n_per_m, true) << "\n";
    }
  }
};

TEST_F(LoadCases, RowsAreThoseOfTheCases) {
  const auto fit = Make(kLoadCasesFit);
  ASSERT_TRUE(fit) << out_.Format();
  ASSERT_EQ(fit->train_points().size(), 8u);  // x of all cases, then z
  const Residuals at = IdentifyTest::At(*fit, {90});
  ASSERT_EQ(at.failed, "");
  for (std::size_t i = 0; i < 8; ++i) {
    const Case& c = kCases[i % 4];
    EXPECT_EQ(fit->train_points()[i].where, std::string("load case ") + c.name);
    EXPECT_EQ(fit->train_points()[i].time_s, static_cast<double>(i % 4 + 1));
    // in standard deviations of 1 mm
    const double moved_m = Place(c, 90, i >= 4) - Place(c, 110, i >= 4);
    EXPECT_NEAR(at.value[i], moved_m / 0.001, 1e-4) << i;
  }
}

TEST_F(LoadCases, AStiffnessIsFoundFromDeflections) {
  const auto fit = Make(kLoadCasesFit);
  ASSERT_TRUE(fit) << out_.Format();
  const FitOutcome outcome = RunFit(*fit, {});
  ASSERT_EQ(outcome.why, "");
  const ParameterVerdict& k = outcome.verdict.identifiability.parameters[0];
  EXPECT_NEAR(k.value, 110, 1e-4);
  EXPECT_EQ(k.kind, Determined::kEstimated);
  // Displacement of a case per unit of k: T / k^2 along its direction.
  double squares = 0;
  for (const Case& c : kCases) squares += std::pow(Pull(c) / (110 * 110) / 0.001, 2);
  EXPECT_NEAR(k.se, 1 / std::sqrt(squares), 1e-3 / std::sqrt(squares));
}

TEST_F(LoadCases, SensorErrorsThatAreNotEstimatedAreFound) {
  // Load cells read 5 % too little, and the camera 4 mm too high.
  std::ofstream file(folder_ / "a.csv");
  file.precision(17);
  file << "time_s,node/ball/position_z_m,cable/c/tension_n\n";
  for (std::size_t i = 0; i < kCases.size(); ++i) {
    file << i << "," << Place(kCases[i], 110, true) + 0.004 << "," << 0.95 * Pull(kCases[i])
         << "\n";
  }
  file.close();
  std::string text = Replaced(kLoadCasesFit, "scale: 20", "start: 110, scale: 20");
  text = Replaced(text, "residuals: [", "residuals: [{channel: cable/*/tension_n, sd: 0.05}, ");
  const auto fit = Make(Replaced(text, "position_*_m", "position_z_m"));
  ASSERT_TRUE(fit) << out_.Format();
  const FitOutcome outcome = RunFit(*fit, {});
  std::map<std::string, AliasTest> aliases;
  for (const AliasTest& test : outcome.verdict.aliases) aliases[test.name] = test;
  ASSERT_EQ(aliases.size(), 3u);
  // At rest the tension does not depend on k, so the gain is exact.
  const AliasTest& gain = aliases.at("gain *_n");
  EXPECT_NEAR(gain.value, 0.95, 1e-6);
  EXPECT_LT(gain.p, 1e-3);
  EXPECT_NEAR(gain.change[0], 0, 1e-9);
  // z depends on k nearly linearly.
  const AliasTest& offset = aliases.at("offset node/*/position_z_m");
  EXPECT_NEAR(offset.value, 0.004, 4e-4);
  EXPECT_EQ(offset.unit, "m");
  EXPECT_NEAR(outcome.verdict.values[0] + offset.change[0], 110, 1);
  EXPECT_GT(std::fabs(outcome.verdict.values[0] - 110), 2);
  // An estimated gain is not tested again.
  text = Replaced(text, "estimate: [", "estimate: [{channel: \"*_n\", gain: {sd: 0.1}}, ");
  const auto with_gain = Make(text);
  ASSERT_TRUE(with_gain) << out_.Format();
  for (const AliasTest& test : RunFit(*with_gain, {}).verdict.aliases) {
    EXPECT_NE(test.name, "gain *_n");
  }
}

TEST_F(LoadCases, ExperimentsThatDisagreeAreAContradiction) {
  std::filesystem::copy_file(folder_ / "a.csv", folder_ / "b.csv");
  WriteCases(122);
  const std::string two =
      Replaced(kLoadCasesFit, "load_cases}]",
               "load_cases}, {name: b, experiment: experiment.yaml, data: b.csv, forward: "
               "load_cases}]");
  const auto fit = Make(two);
  ASSERT_TRUE(fit) << out_.Format();
  const FitOutcome outcome = RunFit(*fit, {});
  const FitVerdict& verdict = outcome.verdict;
  EXPECT_TRUE(verdict.contradiction);
  ASSERT_EQ(verdict.alone.fits.size(), 2u);
  EXPECT_NEAR(*verdict.alone.fits[0].value[0], 122, 1e-3);
  EXPECT_NEAR(*verdict.alone.fits[1].value[0], 110, 1e-3);
  EXPECT_EQ(verdict.identifiability.parameters[0].kind, Determined::kUnreliable);
  EXPECT_NE(OutcomeJson(*fit, outcome).find("\"contradiction\": true"), std::string::npos);
  const auto errors = ErrorsByExperiment(fit->spec(), fit->train_points(), outcome.train);
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_EQ(errors[1].experiment, "b");
  EXPECT_GT(errors[0].untuned, errors[0].fitted);
}

TEST_F(LoadCases, AGapInTheDataIsThatCasesOnly) {
  std::ofstream file(folder_ / "a.csv");
  file.precision(17);
  file << "time_s,node/ball/position_z_m\n";
  for (std::size_t i = 0; i < kCases.size(); ++i) {
    file << i << ",";
    if (i == 1) file << "nan";
    if (i != 1) file << Place(kCases[i], 110, true);
    file << "\n";
  }
  file.close();
  const auto fit = Make(kLoadCasesFit);
  ASSERT_TRUE(fit) << out_.Format();
  ASSERT_EQ(fit->train_points().size(), 3u);
  EXPECT_EQ(fit->train_points()[1].where, "load case both");
  for (const double r : IdentifyTest::At(*fit, {110}).value) EXPECT_NEAR(r, 0, 1e-4);
}

TEST_F(LoadCases, RowsMoreOrLessThanCasesAreAMistake) {
  Write("a.csv", "time_s,node/ball/position_z_m\n0,0\n1,0\n");
  EXPECT_EQ(Wrong(kLoadCasesFit),
            "experiments: a has 4 load cases, but its data have 2 rows (row i of the data must "
            "belong to load case i)\n");
}

}  // namespace
}  // namespace taut
