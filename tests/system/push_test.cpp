// The quasi-static push of Mirletz et al. (2015) compared with NTRT's run, and the figures of
// docs/validation/push.md
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "taut/run.h"
#include "taut/spec.h"
#include "taut/trace.h"

namespace taut {
namespace {

const std::string kRoot = TAUT_SOURCE_DIR "/";

ExperimentSpec Load(const std::string& name) {
  Diagnostics out;
  auto experiment = LoadExperiment(kRoot + "share/experiments/" + name + ".yaml", {}, out);
  EXPECT_TRUE(experiment) << out.Format();
  return experiment ? *experiment : ExperimentSpec{};
}

RunSummary SimulatePush(const ExperimentSpec& experiment) {
  Diagnostics out;
  const auto summary = RunExperiment(experiment, {}, out);
  EXPECT_TRUE(summary) << out.Format();
  if (!summary) return {};
  EXPECT_EQ(summary->status_text, "");
  EXPECT_EQ(summary->simulated_s, 60.0);
  EXPECT_EQ(summary->cables.size(), 12u);
  EXPECT_EQ(summary->phases.size(), 3u);
  return *summary;
}

/// Reads a CSV file of names and one number each.
std::map<std::string, double> ReadNumbers(const std::string& path) {
  std::map<std::string, double> numbers;
  std::ifstream file(kRoot + path);
  std::string line;
  std::getline(file, line);  // the header
  while (std::getline(file, line)) {
    const auto comma = line.find(',');
    numbers[line.substr(0, comma)] = std::stod(line.substr(comma + 1));
  }
  EXPECT_EQ(numbers.size(), 6u) << path;
  return numbers;
}

/// Returns the maximum over all cables and all steps of NTRT's run, the paper's measure [N].
double NtrtLargestTension() {
  double largest_n = 0;
  for (const auto& [cable, n] : ReadNumbers("tests/data/ntrt/push_maxima.csv")) {
    largest_n = std::max(largest_n, n);
  }
  return largest_n;
}

/// Returns the largest difference between a mean elastic tension and NTRT's, over 12 cables and
/// three phases, in percent of NTRT's largest tension.
double WorstMeanPercent(const RunSummary& run) {
  Diagnostics out;
  const auto ntrt = ReadTrace(kRoot + "tests/data/ntrt/push_1000hz.csv.gz", out);
  EXPECT_TRUE(ntrt) << out.Format();
  if (!ntrt) return NAN;
  double worst_n = 0;
  for (const CableSummary& cable : run.cables) {
    const auto channel = ntrt->Find(cable.name + "_tension_N");
    EXPECT_TRUE(channel) << cable.name;
    if (!channel) return NAN;
    for (std::size_t p = 0; p < run.phases.size(); ++p) {
      double sum = 0, rows = 0;
      for (std::size_t row = 0; row < ntrt->time_s.size(); ++row) {
        const double time_s = ntrt->time_s[row];
        if (time_s < run.phases[p].from_s - 1e-9 || time_s > run.phases[p].to_s + 1e-9) continue;
        sum += ntrt->values[*channel][row];
        ++rows;
      }
      EXPECT_GT(rows, 100);
      worst_n = std::max(worst_n, std::fabs(cable.elastic.phases[p].mean - sum / rows));
    }
  }
  return 100 * worst_n / NtrtLargestTension();
}

TEST(Push, MeansMatchNtrtUnderItsLaws) {
  EXPECT_LT(WorstMeanPercent(SimulatePush(Load("push_20n_ntrt"))), 1.0);
}

TEST(Push, LargestTensionMatchesNtrtUnderItsLaws) {
  const double ntrt_n = NtrtLargestTension();
  EXPECT_NEAR(SimulatePush(Load("push_20n_ntrt")).system_max_elastic_n, ntrt_n, 0.005 * ntrt_n);
}

TEST(Push, MeansStayNearNtrtWithTheExactCone) {
  ExperimentSpec experiment = Load("push_20n_ntrt");
  ASSERT_EQ(experiment.robot.def.friction_law, FrictionLaw::kAlongSlip);
  experiment.robot.def.friction_law = FrictionLaw::kCone;
  EXPECT_LT(WorstMeanPercent(SimulatePush(experiment)), 1.5);
}

/// NTRT's code pushes with 2.3 * 9.81 N; its velocity gain B is 150 N s/m, its friction 0.15 * 0.5.
TEST(Push, NtrtExperimentHasItsLaws) {
  const ExperimentSpec experiment = Load("push_20n_ntrt");
  const ModelDef& def = experiment.robot.def;
  EXPECT_EQ(def.friction_law, FrictionLaw::kAlongSlip);
  EXPECT_EQ(def.friction_combine, CombineRule::kProduct);
  EXPECT_EQ(def.restitution_combine, CombineRule::kProduct);
  ASSERT_EQ(def.planes.size(), 1u);
  for (const SphereDef& sphere : def.spheres) {
    EXPECT_DOUBLE_EQ(sphere.material.kinetic_friction * def.planes[0].material.kinetic_friction,
                     0.075);
  }
  for (const CableDef& cable : def.cables) EXPECT_EQ(cable.damping_law, DampingLaw::kClamped);
  // Segment 0 in NTRT: Ixx 106.32264 kg cm^2 about its x, taut's y. NTRT stores mass and size as
  // float.
  EXPECT_NEAR(def.bodies[0].inertia_kg_m2.yy, 106.32264e-4, 1e-8);
  ASSERT_EQ(experiment.controllers.size(), 1u);
  const ImpedanceSpec& control = *experiment.controllers[0].impedance;
  EXPECT_TRUE(control.start_from_rest_length);
  for (const ImpedanceGains& gains : control.cables) {
    const bool top =
        def.cables[static_cast<std::size_t>(gains.cable)].name.find("top") != std::string::npos;
    EXPECT_EQ(gains.velocity_gain_n_s_per_m, top ? 150 : 100);
  }
  ASSERT_EQ(experiment.pushes.size(), 3u);
  EXPECT_DOUBLE_EQ(experiment.pushes[0].force_n[1].second, 22.563);
}

/// The first table below a heading of the page: its header, and its rows by their first cell
struct PageTable {
  std::vector<std::string> head;
  std::map<std::string, std::vector<std::string>> rows;

  explicit PageTable(const std::string& heading) {
    std::ifstream page(kRoot + "docs/validation/push.md");
    std::string line;
    while (std::getline(page, line) && line != heading) continue;
    while (std::getline(page, line) && line.rfind("|", 0) != 0) continue;
    head = Cells(line);
    std::getline(page, line);  // | --- | --- |
    while (std::getline(page, line) && line.rfind("|", 0) == 0) {
      const auto cells = Cells(line);
      rows[cells[0]] = cells;
    }
  }

  static std::vector<std::string> Cells(const std::string& line) {
    std::vector<std::string> cells;
    for (std::size_t from = 2; from < line.size();) {
      const std::size_t to = line.find(" |", from);
      if (to == std::string::npos) break;
      cells.push_back(line.substr(from, to - from));
      from = to + 3;
    }
    return cells;
  }

  /// Expects the page's number, to its last digit.
  void Expect(const std::string& row, const std::string& column, double value) const {
    const auto at = std::find(head.begin(), head.end(), column);
    ASSERT_NE(at, head.end()) << "no column " << column;
    ASSERT_EQ(rows.count(row), 1u) << "no row " << row;
    const std::string& cell = rows.at(row)[static_cast<std::size_t>(at - head.begin())];
    const std::size_t point = cell.find('.');
    ASSERT_NE(point, std::string::npos) << cell;
    const std::size_t end = cell.find_first_not_of("0123456789", point + 1);
    const auto digits = (end == std::string::npos ? cell.size() : end) - point - 1;
    EXPECT_NEAR(std::stod(cell), value, 0.5001 * std::pow(10.0, -static_cast<double>(digits)))
        << row << ", " << column << ": run script/validate push";
  }
};

std::string Plain(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

TEST(PushPage, ShowsTheMeansOfThisVersion) {
  const PageTable table("### Mean elastic tension [N]");
  EXPECT_EQ(table.rows.size(), 12u);
  for (const auto& [name, who] :
       {std::pair("push_20n_ntrt", "NTRT's laws"), {"push_20n", "taut's own laws"}}) {
    const RunSummary run = SimulatePush(Load(name));
    for (const CableSummary& cable : run.cables) {
      for (std::size_t p = 0; p < run.phases.size(); ++p) {
        table.Expect(Plain(cable.name), run.phases[p].name + ": " + who,
                     cable.elastic.phases[p].mean);
      }
    }
  }
}

TEST(PushPage, ShowsHowNearThisVersionIsToNtrt) {
  const PageTable table("### Agreement with NTRT");
  const double ntrt_n = NtrtLargestTension();
  table.Expect("NTRT", "largest `elastic` [N]", ntrt_n);
  for (const auto& [name, who] :
       {std::pair("push_20n_ntrt", "NTRT's laws"), {"push_20n", "taut's own laws"}}) {
    const RunSummary run = SimulatePush(Load(name));
    table.Expect(who, "largest `elastic` [N]", run.system_max_elastic_n);
    table.Expect(who, "difference from NTRT", 100 * (run.system_max_elastic_n / ntrt_n - 1));
    table.Expect(who, "largest difference of a mean from NTRT", WorstMeanPercent(run));
  }
}

TEST(PushPage, ShowsTheSixMaximaOfTheRobotAndOfThisVersion) {
  const PageTable whole("### Largest tensions, whole run");
  const PageTable after("### Largest tensions, from 5 s on");
  const auto robot = ReadNumbers("tests/data/hardware/tetraspine3_push_maxima.csv");
  const auto ntrt = ReadNumbers("tests/data/ntrt/push_maxima.csv");
  EXPECT_EQ(whole.rows.size(), 6u);
  EXPECT_EQ(after.rows.size(), 6u);
  const RunSummary run = SimulatePush(Load("push_20n"));
  for (const CableSummary& cable : run.cables) {
    if (robot.count(cable.name) == 0) continue;
    const std::string row = Plain(cable.name);
    whole.Expect(row, "robot [N]", robot.at(cable.name));
    whole.Expect(row, "NTRT `elastic` [N]", ntrt.at(cable.name));
    whole.Expect(row, "taut `tension` [N]", cable.tension.max_n);
    whole.Expect(row, "taut `elastic` [N]", cable.elastic.max_n);
    after.Expect(row, "robot [N]", robot.at(cable.name));
    after.Expect(row, "taut `tension` [N]", cable.tension.max_after_start_n);
    after.Expect(row, "taut `elastic` [N]", cable.elastic.max_after_start_n);
  }
}

}  // namespace
}  // namespace taut
