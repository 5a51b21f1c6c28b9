// Summary of a run, as JSON and as tables
#include "taut/summary.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "taut/version.h"

namespace taut {
namespace {

CableSummary Cable(const std::string& name, double base, std::size_t phase_count) {
  CableSummary cable;
  cable.name = name;
  cable.tension = {base + 9, base + 8, {}};
  cable.elastic = {base + 7, base + 6, {}};
  for (std::size_t i = 0; i < phase_count; ++i) {
    const double at = base + 0.1 * static_cast<double>(i);
    cable.tension.phases.push_back({at, at - 0.5, at + 0.5});
    cable.elastic.phases.push_back({at - 1, at - 1.5, at - 0.5});
  }
  cable.max_force_n = 31.25;
  cable.max_speed_m_per_s = 0.07;
  cable.max_power_w = 2.1875;
  cable.energy_j = 0.5;
  cable.net_energy_j = 0.375;
  return cable;
}

RunSummary Summary() {
  RunSummary summary;
  summary.experiment = "push_20n";
  summary.run = "00112233445566ff";
  summary.simulated_s = 60;
  summary.wall_s = 0.125;
  summary.phases = {{"before", 25, 30}, {"during", 35, 40}, {"after", 50, 60}};
  summary.cables = {Cable("inner_top_1", 32.25, 3), Cable("outer_top_2", 4, 3)};
  summary.system_max_tension_n = 41.25;
  summary.system_max_tension_cable = "inner_top_1";
  summary.system_max_elastic_n = 39.25;
  summary.system_max_elastic_after_start_n = 38.25;
  summary.state_hash = 0x0123456789abcdefu;
  return summary;
}

TEST(SummaryJson, ARunThatEndsInItsFirstSecondsHasNoMaximumAfterThem) {
  RunSummary summary = Summary();
  summary.simulated_s = 2;
  const auto json = nlohmann::ordered_json::parse(SummaryJson(summary));
  EXPECT_TRUE(json["system_max_elastic_after_start_n"].is_null());
  EXPECT_TRUE(json["cables"][0]["tension"]["max_after_start_n"].is_null());
  EXPECT_EQ(json["cables"][0]["tension"]["max_n"], 41.25);
}

TEST(SummaryJson, HoldsEverythingUnderItsName) {
  RunSummary summary = Summary();
  summary.drags = {{"scale", {1.5, 1.25, 1.75}}};
  const std::string text = SummaryJson(summary);
  const auto json = nlohmann::ordered_json::parse(text);
  EXPECT_EQ(json["experiment"], "push_20n");
  EXPECT_EQ(json["run"], "00112233445566ff");
  EXPECT_EQ(json["taut_version"], kVersion);
  EXPECT_EQ(json["format_version"], 1);
  EXPECT_EQ(json["simulated_s"], 60);
  EXPECT_EQ(json["wall_s"], 0.125);
  EXPECT_EQ(json["real_time_factor"], 480);
  EXPECT_EQ(json["interrupted"], false);
  EXPECT_EQ(json["status"], "ok");
  EXPECT_EQ(json["state_hash"], "0123456789abcdef");
  EXPECT_EQ(json["system_max_tension_n"], 41.25);
  EXPECT_EQ(json["system_max_tension_cable"], "inner_top_1");
  EXPECT_EQ(json["system_max_elastic_n"], 39.25);
  EXPECT_EQ(json["system_max_elastic_after_start_n"], 38.25);
  EXPECT_EQ(json["phases"][1]["from_s"], 35);
  const auto& cable = json["cables"][0];
  EXPECT_EQ(cable["name"], "inner_top_1");
  EXPECT_EQ(cable["tension"]["max_n"], 41.25);
  EXPECT_EQ(cable["tension"]["max_after_start_n"], 40.25);
  EXPECT_EQ(cable["elastic"]["max_n"], 39.25);
  EXPECT_EQ(cable["elastic"]["phases"]["before"]["mean_n"], 31.25);
  EXPECT_EQ(cable["tension"]["phases"]["before"]["min_n"], 31.75);
  EXPECT_EQ(cable["tension"]["phases"]["before"]["max_n"], 32.75);
  EXPECT_TRUE(cable["tension"]["phases"].contains("after"));
  EXPECT_EQ(cable["actuator"]["max_force_n"], 31.25);
  EXPECT_EQ(cable["actuator"]["max_speed_m_per_s"], 0.07);
  EXPECT_EQ(cable["actuator"]["max_power_w"], 2.1875);
  EXPECT_EQ(cable["actuator"]["energy_j"], 0.5);
  EXPECT_EQ(cable["actuator"]["net_energy_j"], 0.375);
  EXPECT_EQ(json["drags"][0]["name"], "scale");
  EXPECT_EQ(json["drags"][0]["force"]["mean_n"], 1.5);
  EXPECT_EQ(json.begin().key(), "format_version") << "keys stay in order";
  EXPECT_EQ(text, SummaryJson(summary));
  summary.run.clear();
  EXPECT_TRUE(nlohmann::json::parse(SummaryJson(summary))["run"].is_null())
      << "outside of a folder";
}

/// Returns reference maxima of a robot, and reference means of the second phase from a book.
std::vector<ReferenceSpec> References() {
  ReferenceSpec robot, book;
  robot.source = "a robot";
  robot.values = {{0, 33}, {1, 10}};
  book.source = "a book";
  book.quantity = ReferenceSpec::Quantity::kElastic;
  book.statistic = ReferenceSpec::Statistic::kMean;
  book.phase = "during";
  book.values = {{1, 3}};
  return {robot, book};
}

TEST(SummaryJson, PutsOursBesideTheReferences) {
  RunSummary summary = Summary();
  summary.references = References();
  const auto references = nlohmann::json::parse(SummaryJson(summary))["references"];
  ASSERT_EQ(references.size(), 2u);
  EXPECT_EQ(references[0]["source"], "a robot");
  EXPECT_EQ(references[0]["quantity"], "tension");
  EXPECT_EQ(references[0]["statistic"], "max");
  EXPECT_TRUE(references[0]["phase"].is_null());
  EXPECT_EQ(references[0]["cables"][1]["name"], "outer_top_2");
  EXPECT_EQ(references[0]["cables"][1]["reference_n"], 10);
  EXPECT_EQ(references[0]["cables"][1]["ours_n"], 13);
  EXPECT_EQ(references[1]["phase"], "during");
  EXPECT_DOUBLE_EQ(references[1]["cables"][0]["ours_n"], 3.1);
}

TEST(SummaryTable, SaysHowFarOffTheReferencesAre) {
  RunSummary summary = Summary();
  summary.references = References();
  const std::string whole = SummaryTable(summary);
  EXPECT_TRUE(
      whole.ends_with("compared with a robot: max tension of 2 cables, whole run\n"
                      "  largest difference 30.00 %: outer_top_2 13.000 N, reference 10.000 N\n"
                      "compared with a book: mean elastic of 1 cables, during\n"
                      "  largest difference 3.33 %: outer_top_2 3.100 N, reference 3.000 N\n"))
      << whole;
  summary.simulated_s = 37;
  EXPECT_TRUE(
      SummaryTable(summary).ends_with("compared with a book: mean elastic of 1 cables, during\n"
                                      "  the run did not reach this phase\n"));
}

TEST(SummaryJson, WhatWasNotReachedIsNull) {
  RunSummary summary = Summary();
  summary.simulated_s = 37;
  summary.interrupted = true;
  summary.status.bits = kStatusNonFinite;
  summary.status_text = "body segment_1 is not finite";
  summary.system_max_tension_n = std::numeric_limits<double>::quiet_NaN();
  const auto json = nlohmann::ordered_json::parse(SummaryJson(summary));
  EXPECT_EQ(json["interrupted"], true);
  EXPECT_EQ(json["status"], "body segment_1 is not finite");
  EXPECT_EQ(json["status_bits"], 1);
  const auto& phases = json["cables"][0]["tension"]["phases"];
  EXPECT_FALSE(phases["before"].is_null());
  EXPECT_TRUE(phases["during"].is_null()) << "was not complete";
  EXPECT_TRUE(phases["after"].is_null());
  EXPECT_TRUE(json["system_max_tension_n"].is_null());
}

TEST(SummaryTable, IsWhatAPersonReads) {
  RunSummary summary = Summary();
  summary.drags = {{"scale", {1.5, 1.25, 1.75}}};
  EXPECT_EQ(SummaryTable(summary),
            R"(push_20n: ok; 60 s simulated in 0.125 s (480 times real time)

                     before 25..30 s          during 35..40 s           after 50..60 s     whole
tension [N]     mean     min     max     mean     min     max     mean     min     max       max
inner_top_1    32.25   31.75   32.75    32.35   31.85   32.85    32.45   31.95   32.95     41.25
outer_top_2     4.00    3.50    4.50     4.10    3.60    4.60     4.20    3.70    4.70     13.00

largest tension: 41.250 N in inner_top_1
largest elastic part: 39.250 N; from 5 s on: 38.250 N

drag [N]       mean     min     max
scale         1.500   1.250   1.750

actuator     max force [N]  max speed [m/s]  max power [W]  energy [J]     net [J]
inner_top_1          31.25           0.0700          2.188       0.500       0.375
outer_top_2          31.25           0.0700          2.188       0.500       0.375
)");
}

std::vector<Overload> Overloads() {
  return {{MemberKind::kCable, "inner_top_1", MemberLimit::kStrength, 0.5, 17.14, 0.25},
          {MemberKind::kRod, "strut_0", MemberLimit::kBuckling, 1234.5, 2345.6, 12.345}};
}

TEST(SummaryTable, HasALineForEveryLimitThatAMemberExceeded) {
  RunSummary summary = Summary();
  summary.overloads = Overloads();
  summary.status.bits = kStatusOverloaded;
  summary.status.first_time_s = 0.25;
  summary.status_text = Describe(summary.overloads);
  const std::string table = SummaryTable(summary);
  EXPECT_NE(table.find("WARNING: cable inner_top_1 carried 17.14 N, more than its strength of 0.5 "
                       "N, first at t = 0.25 s; and one more limit of a member was exceeded"),
            std::string::npos)
      << table;
  EXPECT_NE(table.find(R"(
overloaded  member  limit       capacity [N]  max force [N]  first at [s]
inner_top_1 cable   strength             0.5          17.14          0.25
strut_0     rod     buckling            1234           2346         12.35
)"),
            std::string::npos)
      << table;
}

TEST(SummaryJson, HasWhatMembersCarriedBeyondWhatTheyBear) {
  RunSummary summary = Summary();
  EXPECT_EQ(nlohmann::json::parse(SummaryJson(summary))["overloads"], nlohmann::json::array());
  summary.overloads = Overloads();
  const auto overloads = nlohmann::json::parse(SummaryJson(summary))["overloads"];
  ASSERT_EQ(overloads.size(), 2u);
  EXPECT_EQ(overloads[1]["kind"], "rod");
  EXPECT_EQ(overloads[1]["name"], "strut_0");
  EXPECT_EQ(overloads[1]["limit"], "buckling");
  EXPECT_EQ(overloads[1]["bears_n"], 1234.5);
  EXPECT_EQ(overloads[1]["carried_n"], 2345.6);
  EXPECT_EQ(overloads[1]["first_time_s"], 12.345);
}

TEST(SummaryTable, SaysWhatWentWrongAndLeavesOutWhatWasNotReached) {
  RunSummary summary = Summary();
  summary.simulated_s = 37;
  summary.interrupted = true;
  summary.status.bits = kStatusNotConverged;
  summary.status.first_time_s = 36.5;
  for (CableSummary& cable : summary.cables) cable.max_force_n = cable.max_speed_m_per_s = 0.0;
  const std::string table = SummaryTable(summary);
  EXPECT_NE(table.find("push_20n: interrupted; 37 s simulated in 0.125 s (296 times real time)\n"
                       "WARNING: status bits 2 (first at 36.5 s)\n"),
            std::string::npos)
      << table;
  EXPECT_NE(table.find("inner_top_1    32.25   31.75   32.75        -       -       -        -    "
                       "   -       -     41.25"),
            std::string::npos)
      << table;
  EXPECT_EQ(table.find("actuator"), std::string::npos) << "there is none";
  EXPECT_EQ(table.find("drag"), std::string::npos);
}

TEST(SummaryTable, StaysWithinAHundredColumns) {
  RunSummary summary = Summary();
  summary.phases = {{"a", 0, 1}, {"b", 1, 2}, {"c", 2, 3}, {"d", 3, 4}, {"e", 4, 5}};
  summary.cables = {Cable("inner_top_11", 1234.5, 5), Cable("outer_left_12", 4, 5)};
  summary.system_max_tension_n = 1243.5;
  std::istringstream lines(SummaryTable(summary));
  std::size_t titles = 0;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 100u) << line;
    titles += line.find("tension [N]") != line.npos;
  }
  EXPECT_EQ(titles, 2u) << "five phases take two tables";
  summary.phases.clear();
  EXPECT_NE(SummaryTable(summary).find("tension [N]         max\ninner_top_11     1243.5\n"),
            std::string::npos)
      << SummaryTable(summary);
}

}  // namespace
}  // namespace taut
