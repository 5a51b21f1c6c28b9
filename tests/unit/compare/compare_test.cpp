// Differences of traces against closed forms
#include "taut/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/pattern.h"
#include "tests/constants.h"

namespace taut {
namespace {

template <class Function>
Trace Sampled(double step_s, int rows, const Function& f, double start_s = 0.0,
              const std::string& name = "cable/a/tension_n") {
  Trace trace;
  trace.channels = {{name, "N"}};
  trace.values.resize(1);
  for (int i = 0; i < rows; ++i) {
    trace.time_s.push_back(start_s + step_s * i);
    trace.values[0].push_back(f(trace.time_s.back()));
  }
  return trace;
}

template <class Function>
void AddChannel(Trace& trace, const std::string& name, const Function& f,
                const std::string& unit = "N") {
  trace.channels.push_back({name, unit});
  trace.values.emplace_back();
  for (const double time_s : trace.time_s) trace.values.back().push_back(f(time_s));
}

TEST(Compare, ATraceEqualsItself) {
  const Trace a = Sampled(0.01, 401, [](double t) { return std::sin(3 * t); });
  const Comparison found = Compare(a, a, {});
  ASSERT_EQ(found.channels.size(), 1u);
  const ChannelComparison& channel = found.channels[0];
  EXPECT_EQ(found.rows, 401u);
  EXPECT_FALSE(found.resampled);
  EXPECT_EQ(channel.rmse, 0.0);
  EXPECT_EQ(channel.bias, 0.0);
  EXPECT_EQ(channel.error.value, 0.0);
  EXPECT_EQ(channel.max_error_percent, 0.0);
  EXPECT_NEAR(channel.lag_s, 0.0, 1e-4) << "ends of the record bend the peak a little";
  EXPECT_NEAR(channel.correlation, 1.0, 1e-12);
}

TEST(Compare, AShiftedSineHasTheDelayTheRmseAndTheBiasOfTheClosedForm) {
  // a = 2 sin(w t) + 7, b = 2 sin(w (t - tau)) + 5 over whole periods: the mean of (a - b) is 2,
  // the mean of its square 4 + 2^2 (1 - cos(w tau)).
  const double w = 2 * std::numbers::pi, tau_s = 0.07, step_s = 0.01;
  const int periods = 9,
            rows = 100 * periods;  // without repeating a row at the ends of the periods
  const Trace a = Sampled(step_s, rows, [&](double t) { return 2 * std::sin(w * t) + 7; });
  const Trace b =
      Sampled(step_s, rows, [&](double t) { return 2 * std::sin(w * (t - tau_s)) + 5; });
  CompareOptions options;
  options.max_lag_s = 0.5;
  const Comparison found = Compare(a, b, options);
  const ChannelComparison& channel = found.channels.at(0);
  EXPECT_NEAR(channel.bias, 2.0, 1e-12);
  EXPECT_NEAR(channel.rmse, std::sqrt(4 + 4 * (1 - std::cos(w * tau_s))), 1e-12);
  // 900 rows less 50 at either end are 8 whole periods, so that the correlation at lag k is exactly
  // cos(w (k h - tau)), which peaks on a row.
  EXPECT_NEAR(channel.lag_s, tau_s, 1e-10);
  EXPECT_NEAR(channel.correlation, 1.0, 1e-12);
  EXPECT_FALSE(channel.lag_at_limit);
  // a - b = 2 + 2 * 2 sin(w tau / 2) cos(w (t - tau / 2)): largest at t = tau / 2, between rows
  const double amplitude = 4 * std::sin(w * tau_s / 2);
  EXPECT_NEAR(channel.error.value, 2 + amplitude * std::cos(w * 0.005), 1e-12);
  EXPECT_NEAR(std::fmod(channel.error.time_s, 1.0), 0.035, 0.0051);
  EXPECT_NEAR(channel.max_a.value, 9.0, 1e-12);
  EXPECT_NEAR(channel.max_b.value, 7.0, 1e-12);
  EXPECT_NEAR(channel.max_error_percent, 100 * 2.0 / 7.0, 1e-10);
}

TEST(Compare, ADelayBetweenRowsIsWhatTheParabolaGives) {
  // Through cos(h (k - d)) at k = -1, 0, 1 the parabola peaks at tan(h d) / (2 tan(h / 2)), with h
  // = w step and d the delay in rows; this is d up to O(h^2 d).
  const double w = 2 * std::numbers::pi, step_s = 0.01, h = w * step_s;
  for (const double d : {-0.45, -0.1, 0.2, 0.3}) {
    const auto sine = [&](double t) { return std::sin(w * t); };
    const auto later = [&](double t) { return std::sin(w * (t - (3 + d) * step_s)); };
    const Comparison found = Compare(Sampled(step_s, 900, sine), Sampled(step_s, 900, later), {});
    const double fraction = std::tan(h * d) / (2 * std::tan(h / 2));
    EXPECT_NEAR(found.channels.at(0).lag_s, (3 + fraction) * step_s, 1e-10);
    EXPECT_NEAR(found.channels.at(0).lag_s, (3 + d) * step_s, 2e-5);
  }
}

TEST(Compare, ADelayBeyondTheSearchIsMarked) {
  const auto sine = [](double t) { return std::sin(t); };
  const auto later = [](double t) { return std::sin(t - 1.0); };
  CompareOptions options;
  options.max_lag_s = 0.5;
  Comparison found = Compare(Sampled(0.01, 5000, sine), Sampled(0.01, 5000, later), options);
  EXPECT_TRUE(found.channels.at(0).lag_at_limit);
  EXPECT_NEAR(found.channels.at(0).lag_s, 0.5, 1e-12);
  EXPECT_NE(ComparisonTable(found, "a", "b").find(" >0.5 "), std::string::npos);
  options.max_lag_s = 0.0;
  found = Compare(Sampled(0.01, 5000, sine), Sampled(0.01, 5000, later), options);
  EXPECT_TRUE(std::isnan(found.channels.at(0).lag_s)) << "was not looked for";
  EXPECT_FALSE(found.channels.at(0).lag_at_limit);
}

TEST(Compare, AConstantHasNoDelay) {
  const Trace a = Sampled(0.01, 100, [](double) { return 0.1; });
  const Trace b = Sampled(0.01, 100, [](double t) { return std::sin(9 * t); });
  for (const auto& [x, y] : {std::pair(a, b), std::pair(b, a), std::pair(a, a)}) {
    const Comparison found = Compare(x, y, {});
    EXPECT_TRUE(std::isnan(found.channels.at(0).lag_s));
    EXPECT_TRUE(std::isnan(found.channels.at(0).correlation));
    EXPECT_TRUE(std::isfinite(found.channels.at(0).rmse));
  }
}

TEST(Compare, MissingNumbersAreLeftOut) {
  const auto sine = [](double t) { return std::sin(7 * t); };
  Trace a = Sampled(0.01, 1000, sine),
        b = Sampled(0.01, 1000, [&](double t) { return sine(t - 0.05) + 1; });
  for (std::size_t row : {0, 300, 301, 999}) a.values[0][row] = kNan;
  b.values[0][500] = kNan;
  b.values[0][501] = std::numeric_limits<double>::infinity();
  const Comparison found = Compare(a, b, {});
  const ChannelComparison& channel = found.channels.at(0);
  EXPECT_EQ(found.rows, 1000u);
  EXPECT_EQ(channel.rows, 994u);
  EXPECT_TRUE(std::isfinite(channel.rmse));
  EXPECT_NEAR(channel.lag_s, 0.05, 1e-3);
  EXPECT_LE(channel.max_b.value, 2.0);
  // without rows there are no results
  for (double& value : a.values[0]) value = kNan;
  const Comparison none = Compare(a, b, {});
  EXPECT_EQ(none.channels.at(0).rows, 0u);
  EXPECT_TRUE(std::isnan(none.channels.at(0).rmse));
  EXPECT_TRUE(std::isnan(none.channels.at(0).max_error_percent));
  EXPECT_EQ(ExceededLimits(none, {.max_error_percent = 1e9}).size(), 1u) << "NaN does not pass";
  EXPECT_EQ(ExceededLimits(none, {.max_rmse = 1e9}).size(), 1u);
}

TEST(Compare, TheFinerTraceIsInterpolatedAtTheRowsOfTheCoarser) {
  // Linear interpolation is exact for straight lines; at the middle of a step h it overestimates
  // t^2 by h^2 / 4.
  const double h = 0.1;
  Trace fine = Sampled(h, 101, [](double t) { return 3 * t - 1; });
  AddChannel(fine, "cable/b/tension_n", [](double t) { return t * t; });
  Trace coarse = Sampled(
      0.3, 33, [](double t) { return 3 * t - 1; }, 0.05);
  AddChannel(coarse, "cable/b/tension_n", [](double t) { return t * t; });
  for (const bool swapped : {false, true}) {
    const Comparison found = swapped ? Compare(coarse, fine, {}) : Compare(fine, coarse, {});
    EXPECT_TRUE(found.resampled);
    EXPECT_EQ(found.rows, 33u);
    EXPECT_DOUBLE_EQ(found.from_s, 0.05);
    EXPECT_NEAR(found.channels.at(0).rmse, 0.0, 1e-13);
    EXPECT_NEAR(found.channels.at(1).bias, (swapped ? -1 : 1) * h * h / 4, 1e-12);
    EXPECT_NEAR(found.channels.at(1).rmse, h * h / 4, 1e-12);
  }
}

TEST(Compare, UnevenRowsGiveTheSameDelay) {
  const auto sine = [](double t) { return std::sin(5 * t); };
  const auto later = [](double t) { return std::sin(5 * (t - 0.04)); };
  Trace uneven = Sampled(0.01, 2000, [](double) { return 0.0; });
  for (std::size_t i = 0; i < uneven.time_s.size(); ++i) {
    uneven.time_s[i] += 0.004 * std::sin(static_cast<double>(i));
    uneven.values[0][i] = sine(uneven.time_s[i]);
  }
  const Comparison found = Compare(uneven, Sampled(0.005, 4000, later), {});
  EXPECT_NEAR(found.channels.at(0).lag_s, 0.04, 2e-4);
}

TEST(Compare, OnlyTheCommonTimeCountsAndTheRestIsNamed) {
  const auto line = [](double t) { return t; };
  const Trace a = Sampled(0.5, 21, line), b = Sampled(0.5, 21, line, 4.0);  // 0..10 and 4..14 s
  const Comparison found = Compare(a, b, {});
  EXPECT_EQ(found.from_s, 4.0);
  EXPECT_EQ(found.to_s, 10.0);
  EXPECT_EQ(found.rows, 13u);
  EXPECT_EQ(found.channels.at(0).max_b.value, 10.0) << "b's 14 lies outside";
  const std::string table = ComparisonTable(found, "x.h5", "y.csv");
  EXPECT_NE(table.find("only a covers 0 .. 4 s\nonly b covers 10 .. 14 s\n"), std::string::npos)
      << table;

  CompareOptions options;
  options.from_s = 5.0;
  options.to_s = 6.0;
  EXPECT_EQ(Compare(a, b, options).rows, 3u);
  options.from_s = 11.0;
  const Comparison none = Compare(a, b, options);
  EXPECT_EQ(none.rows, 0u);
  EXPECT_TRUE(none.channels.empty());
  EXPECT_EQ(Compare(a, Sampled(1.0, 3, line, 50.0), {}).rows, 0u);
  EXPECT_EQ(Compare(a, Sampled(1.0, 0, line), {}).rows, 0u);
}

TEST(Compare, ChannelsOfOneSideAndOtherUnitsAreNamedNotCompared) {
  Trace a = Sampled(1.0, 3, [](double t) { return t; });
  Trace b = a;
  const auto zero = [](double) { return 0.0; };
  AddChannel(a, "a_only", zero);
  AddChannel(b, "b_only", zero);
  AddChannel(a, "f", zero, "N");
  AddChannel(b, "f", zero, "lbf");
  const Comparison found = Compare(a, b, {});
  EXPECT_EQ(found.only_a, std::vector<std::string>{"a_only"});
  EXPECT_EQ(found.only_b, std::vector<std::string>{"b_only"});
  EXPECT_EQ(found.unit_conflicts, std::vector<std::string>{"f: N against lbf"});
  EXPECT_EQ(found.channels.size(), 1u);
  const std::string table = ComparisonTable(found, "a", "b");
  EXPECT_NE(table.find("only in a (1): a_only\nonly in b (1): b_only\n"
                       "units differ, not compared:\n  f: N against lbf\n"),
            std::string::npos)
      << table;
  CompareOptions options;
  options.channels = {"cable/*", "x*"};
  const Comparison selected = Compare(a, b, options);
  EXPECT_TRUE(selected.only_a.empty() && selected.only_b.empty());
  EXPECT_EQ(selected.channels.size(), 1u);
}

TEST(Compare, TheTableAbridgesLongListsOfNames) {
  const Trace b = Sampled(1.0, 3, [](double t) { return t; });
  Trace a = b;
  for (const char* name :
       {"cable/x/rate_n", "cable/y/rate_n", "cable/z/rate_n", "system/k_j", "u"}) {
    AddChannel(a, name, [](double) { return 0.0; });
  }
  const std::string table = ComparisonTable(Compare(a, b, {}), "a", "b");
  EXPECT_NE(table.find("only in a (5): cable/*/rate_n (3) system/k_j u\n"), std::string::npos)
      << table;
}

TEST(Compare, PhasesGiveMeanLeastAndGreatest) {
  const Trace a = Sampled(0.5, 21, [](double t) { return t; });
  const Trace b = Sampled(0.25, 41, [](double t) { return 2 * t; });
  CompareOptions options;
  options.phases = {{"early", 1.0, 2.0}, {"late", 9.0, 99.0}, {"never", 50.0, 60.0}};
  const Comparison found = Compare(a, b, options);
  const auto& phases = found.channels.at(0).phases;
  ASSERT_EQ(phases.size(), 3u);
  EXPECT_EQ(phases[0].a.rows, 3u);
  EXPECT_EQ(phases[0].b.rows, 5u) << "of its own rows";
  EXPECT_DOUBLE_EQ(phases[0].a.mean, 1.5);
  EXPECT_DOUBLE_EQ(phases[0].b.mean, 3.0);
  EXPECT_DOUBLE_EQ(phases[0].a.min, 1.0);
  EXPECT_DOUBLE_EQ(phases[0].b.max, 4.0);
  EXPECT_DOUBLE_EQ(phases[1].a.mean, 9.5);
  EXPECT_EQ(phases[2].a.rows, 0u);
  EXPECT_TRUE(std::isnan(phases[2].a.mean));
  const std::string table = ComparisonTable(found, "a", "b");
  EXPECT_NE(table.find("cable/*/tension_n [N], early: 1 .. 2 s\n"), std::string::npos) << table;
  EXPECT_NE(table.find("\na           1.500    3.000    -1.500    1.000    2.000    -1.000    2.000"
                       "    4.000    -2.000\n"),
            std::string::npos)
      << table;
}

TEST(Compare, ATableHasNoNegativeZeros) {
  const Trace a = Sampled(0.1, 11, [](double) { return -0.0; });
  Trace b = a, c = a;
  for (double& value : b.values[0]) value = 10.0;
  for (double& value : c.values[0]) value = 10.0 - 1e-5;  // error of -0.0001 %
  for (const auto& [one, other] : {std::pair(a, a), {a, b}, {c, b}}) {
    const std::string table = ComparisonTable(Compare(one, other, {}), "a", "b");
    for (std::size_t at = 0; (at = table.find("-0", at)) != table.npos; ++at) {
      const std::string number = table.substr(at, table.find_first_of(" \n", at) - at);
      EXPECT_NE(number.find_first_of("123456789"), number.npos) << table;
    }
  }
}

TEST(Compare, TheSystemMaximumIsTheLargestOfAllMatchingChannels) {
  Trace a = Sampled(0.1, 101, [](double t) { return 10 - t; });        // 10 at 0 s
  AddChannel(a, "cable/b/tension_n", [](double t) { return 2 * t; });  // 20 at 10 s
  AddChannel(a, "body/b/position_x_m", [](double t) { return 100 * t; });
  Trace b = Sampled(0.1, 101, [](double t) { return t == 0.0 ? 25 : 0; });  // 25 at 0 s
  AddChannel(b, "cable/b/tension_n", [](double) { return 24; });
  AddChannel(b, "body/b/position_x_m", [](double t) { return 100 * t; });
  const Comparison found = Compare(a, b, {});
  ASSERT_EQ(found.system.size(), 1u) << "there is no elastic_n";
  EXPECT_EQ(found.system[0].channel_a, "cable/b/tension_n");
  EXPECT_EQ(found.system[0].channel_b, "cable/a/tension_n");
  EXPECT_DOUBLE_EQ(found.system[0].a.value, 20.0);
  EXPECT_DOUBLE_EQ(found.system[0].a.time_s, 10.0);
  EXPECT_DOUBLE_EQ(found.system[0].error_percent, -20.0);
  const std::string table = ComparisonTable(found, "a", "b");
  EXPECT_NE(table.find("largest cable/*/tension_n: error -20.00 %\n"
                       "  a 20.0000 N in b at 10.00 s\n  b 25.0000 N in a at 0.00 s\n"),
            std::string::npos)
      << table;

  EXPECT_TRUE(ExceededLimits(found, {}).empty());
  EXPECT_TRUE(ExceededLimits(found, {.max_error_percent = 20.0}).empty());
  EXPECT_EQ(ExceededLimits(found, {.max_error_percent = 19.9}),
            std::vector<std::string>{
                "the largest cable/*/tension_n differs by -20.00 %, more than 19.9 %"});
  EXPECT_EQ(ExceededLimits(found, {.max_rmse = 30.0}).size(), 0u);
  const auto exceeded = ExceededLimits(found, {.max_rmse = 10.0});
  ASSERT_EQ(exceeded.size(), 1u);
  EXPECT_EQ(exceeded[0].substr(0, 32), "cable/b/tension_n has an RMSE of");

  CompareOptions options;
  options.channels = {"body/*"};
  const Comparison bodies = Compare(a, b, options);
  EXPECT_TRUE(bodies.system.empty());
  EXPECT_EQ(
      ExceededLimits(bodies, {.max_error_percent = 50.0}),
      std::vector<std::string>{"no compared channel is subject to the limit of the largest value"});
}

TEST(Compare, JsonHoldsTheSameNumbers) {
  const Trace a = Sampled(0.5, 21, [](double t) { return t; });
  const Trace b = Sampled(0.5, 21, [](double) { return 0.0; });
  CompareOptions options;
  options.phases = {{"early", 1.0, 2.0}};
  const Comparison found = Compare(a, b, options);
  const auto json = nlohmann::ordered_json::parse(ComparisonJson(found, "x.h5", "y.csv"));
  EXPECT_EQ(json["a"]["name"], "x.h5");
  EXPECT_EQ(json["rows"], 21);
  const auto& channel = json["channels"][0];
  EXPECT_EQ(channel["name"], "cable/a/tension_n");
  EXPECT_EQ(channel["rmse"], found.channels[0].rmse);
  EXPECT_TRUE(channel["lag_s"].is_null());
  EXPECT_TRUE(channel["max_error_percent"].is_null()) << "of zero";
  EXPECT_EQ(channel["max_a"]["value"], 10.0);
  EXPECT_EQ(channel["phases"]["early"]["difference"]["mean"], 1.5);
  EXPECT_EQ(json["system"][0]["a"]["channel"], "cable/a/tension_n");
}

TEST(Pattern, AStarStandsForAnyCharacters) {
  using base::Fits;
  EXPECT_TRUE(Fits("cable/*/tension_n", "cable/outer_top_1/tension_n"));
  EXPECT_TRUE(Fits("*", ""));
  EXPECT_TRUE(Fits("a*b*c", "axxbbbcc"));
  EXPECT_TRUE(Fits("**c", "abc"));
  EXPECT_TRUE(Fits("abc", "abc"));
  EXPECT_FALSE(Fits("abc", "abcd"));
  EXPECT_FALSE(Fits("abc*d", "abc"));
  EXPECT_FALSE(Fits("cable/*/tension_n", "cable/a/tension_n2"));
  EXPECT_FALSE(Fits("", "a"));
  EXPECT_EQ(base::Wildcard("a_*_n", "a_xy_n"), "xy");
  EXPECT_EQ(base::Wildcard("a_*_n", "a__n"), std::nullopt);
  EXPECT_EQ(base::Wildcard("a", "a"), "");
  EXPECT_EQ(base::Wildcard("a", "b"), std::nullopt);
}

}  // namespace
}  // namespace taut
