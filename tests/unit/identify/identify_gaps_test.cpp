// Fits to data with gaps, uneven rows, quaternions of either sign, wrapped angles and tables of
// other programs: a free box of known velocity and rotation
#include <cmath>
#include <functional>
#include <iterator>

#include "identify/computed.h"
#include "tests/unit/identify/identify_fixture.h"

namespace taut {
namespace {

using test::IdentifyTest;

const std::string kBox = R"(taut: 1
kind: model
name: m
gravity_m_per_s2: [0, 0, 0]
nodes: {b: [0, 0, 0]}
builders: [{match: b, box: {size_m: [0.1, 0.1, 0.1], mass_kg: 1}}]
)";
const std::string kSlide = R"(taut: 1
kind: experiment
name: slide
model: box.yaml
parameters: {v: 0.7, w: 0.7}
place: {velocity_m_per_s: [v, 0, 0], angular_velocity_rad_per_s: [0, 0, w]}
duration_s: 4
)";

class GapsTest : public IdentifyTest {
 protected:
  void SetUp() override {
    IdentifyTest::SetUp();
    Write("box.yaml", kBox);
    Write("slide.yaml", kSlide);
  }
  void WriteRows(const std::vector<double>& time_s, const std::string& columns,
                 const std::function<std::string(double)>& cells) {
    std::ofstream file(folder_ / "a.csv");
    file << columns << "\n";
    for (const double t : time_s) {
      file.precision(12);
      file << t << "," << cells(t) << "\n";
    }
  }
  /// Returns the residuals at the true value.
  std::vector<double> Residual(const std::string& parameter, const std::string& channel,
                               const std::string& statistic, const std::string& more = {}) {
    const auto fit = Make(
        "taut: 1\nkind: fit\nname: f\nexperiments: [{name: t, experiment: slide.yaml, data: "
        "a.csv" +
        more + "}]\nestimate: [{parameter: " + parameter +
        ", low: 0.1, high: 2}]\nresiduals: [{channel: " + channel +
        ", sd: 0.01, statistic: " + statistic + "}]\n");
    EXPECT_TRUE(fit) << out_.Format();
    if (!fit) return {};
    const Residuals at = At(*fit, {0.9});
    EXPECT_EQ(at.failed, "");
    return at.value;
  }
};

std::vector<double> Span(double from_s, double to_s, double step_s) {
  std::vector<double> times;
  for (int i = 0; from_s + step_s * i <= to_s + 1e-9; ++i) times.push_back(from_s + step_s * i);
  return times;
}

TEST_F(GapsTest, StatisticsOfPerfectDataWithGapsAreThoseOfTheRun) {
  const auto x = [](double t) { return std::to_string(0.9 * t); };
  const std::string name = "time_s,body/m/position_x_m";
  std::vector<double> rows_missing = Span(0, 2, 0.01), late = Span(3.9, 4, 0.01);
  rows_missing.insert(rows_missing.end(), late.begin(), late.end());
  std::vector<double> uneven = Span(0, 2, 0.01), slow = Span(2.1, 4, 0.1);
  uneven.insert(uneven.end(), slow.begin(), slow.end());
  const auto check = [&](const char* what) {
    for (const char* statistic : {"mean", "max", "min", "rows"}) {
      for (const double r : Residual("v", "body/m/position_x_m", statistic)) {
        EXPECT_NEAR(r, 0, 2e-3) << what << ", " << statistic;  // six digits in the file
      }
    }
  };
  WriteRows(rows_missing, name, x);
  check("rows missing");
  WriteRows(uneven, name, x);
  check("uneven rows");
  WriteRows(Span(0, 4, 0.01), name,
            [&](double t) { return t > 2.005 && t < 3.895 ? std::string("nan") : x(t); });
  check("cells missing");
  WriteRows(Span(0, 4, 0.01), name, [&](double t) {
    return t > 2.005 && std::lround(100 * t) % 5 < 3 ? std::string("nan") : x(t);
  });
  check("dropouts");
  WriteRows(Span(0, 2, 0.01), name, x);
  check("the data end early");
}

TEST_F(GapsTest, MeansOfDataAreOverTime) {
  std::vector<double> uneven = Span(0, 2, 0.01), slow = Span(2.1, 4, 0.1);
  uneven.insert(uneven.end(), slow.begin(), slow.end());
  WriteRows(uneven, "time_s,body/m/position_x_m", [](double t) { return std::to_string(t); });
  const auto fit = Make(
      "taut: 1\nkind: fit\nname: f\nexperiments: [{name: t, experiment: slide.yaml, data: a.csv}]\n"
      "estimate: [{parameter: v, low: 0.1, high: 2}]\nresiduals: [{channel: body/m/position_x_m, "
      "sd: 0.01}]\n");
  ASSERT_TRUE(fit) << out_.Format();
  EXPECT_NEAR(fit->train_points().at(0).measured, 2, 0.03);  // 1.2 over rows
}

TEST_F(GapsTest, SignsOfMeasuredQuaternionsDoNotCount) {
  const auto rows = [this](const std::function<double(double)>& sign) {
    WriteRows(Span(0, 4, 0.01),
              "time_s,body/m/orientation_w,body/m/orientation_x,body/m/orientation_y,body/m/"
              "orientation_z",
              [&](double t) {
                const double s = t > 1 && t < 3 ? NAN : sign(t);
                return std::to_string(s * std::cos(0.45 * t)) + "," + std::to_string(s * 0.0) +
                       "," + std::to_string(s * 0.0) + "," + std::to_string(s * std::sin(0.45 * t));
              });
    for (const char* statistic : {"mean", "max", "min", "rows"}) {
      for (const double r : Residual("w", "body/m/orientation_*", statistic)) {
        EXPECT_NEAR(r, 0, 5e-3) << statistic;
      }
    }
  };
  rows([](double) { return 1.0; });
  rows([](double) { return -1.0; });
  rows([](double t) { return t < 3.5 ? -1.0 : 1.0; });
  rows([](double t) { return std::lround(100 * t) % 2 == 0 ? 1.0 : -1.0; });
}

TEST_F(GapsTest, AQuaternionWithoutAComponentIsAWarning) {
  WriteRows(Span(0, 4, 0.01), "time_s,body/m/orientation_w,body/m/orientation_z", [](double t) {
    return std::to_string(std::cos(0.45 * t)) + "," + std::to_string(std::sin(0.45 * t));
  });
  Residual("w", "body/m/orientation_*", "rows");
  EXPECT_NE(out_.Format().find("warning: residuals: the data of t have only some of "
                               "body/m/orientation_{w,x,y,z}, so their sign cannot be aligned"),
            std::string::npos)
      << out_.Format();
}

TEST_F(GapsTest, WrappedAnglesOfPerfectDataAreThoseOfTheRun) {
  Write("map.json", R"({"version": 1, "channels": [{"from": "yaw", "to": "body/m/rotation_z_rad",
      "from_unit": "deg", "wrap": "turn"}]})");
  // The box turns by 206 degrees in 4 s, so the run's rotation vector wraps, too.
  for (const double least_deg : {0.0, -180.0, -90.0}) {
    for (const double begin_s : {0.0, 1.0}) {  // 1 s: the turn of the gap is not known
      WriteRows(Span(0, 4, 0.01), "time_s,yaw", [&](double t) {
        const double angle = 0.9 * t * 180 / std::acos(-1.0) - least_deg;
        const bool missing = t > begin_s && t < 3 * begin_s;
        return missing ? std::string("nan")
                       : std::to_string(angle - 360 * std::floor(angle / 360) + least_deg);
      });
      for (const char* statistic : {"mean", "max", "min", "rows"}) {
        for (const double r :
             Residual("w", "body/m/rotation_z_rad", statistic, ", map: map.json")) {
          EXPECT_NEAR(r, 0, 2e-3) << least_deg << ", " << statistic;
        }
      }
      EXPECT_EQ(out_.Format(), "");
    }
  }
}

TEST_F(GapsTest, AnAngleThatJumpsByATurnIsAWarningWithTheRemedy) {
  WriteRows(Span(0, 4, 0.01), "time_s,body/m/rotation_z_rad",
            [](double t) { return std::to_string(std::remainder(0.9 * t, 2 * std::acos(-1.0))); });
  Residual("w", "body/m/rotation_z_rad", "rows");
  EXPECT_NE(out_.Format().find("warning: residuals: body/m/rotation_z_rad in the data of t jumps "
                               "by a turn at 3.49 s (if the angle wraps, add \"wrap\": \"turn\" to "
                               "the rule of this channel in the mapping file given by `map`)"),
            std::string::npos)
      << out_.Format();
}

TEST_F(GapsTest, ATableOfAnotherProgramIsReadAsItsMappingSays) {
  Write("map.json", R"({"version": 1, "table": {"skip_lines": 1, "separator": ";",
      "time": {"column": "t [ms]", "unit": "ms"}},
      "channels": [{"from": "x [cm]", "to": "body/m/position_x_m", "from_unit": "cm"}]})");
  std::ofstream file(folder_ / "a.csv");
  file << "made by another program\nt [ms];x [cm]\n";
  for (int i = 0; i <= 400; ++i) file << 10 * i << ";" << std::to_string(0.9 * i) << "\n";
  file.close();
  for (const char* statistic : {"mean", "rows"}) {
    const auto found = Residual("v", "body/m/position_x_m", statistic, ", map: map.json");
    ASSERT_FALSE(found.empty());
    for (const double r : found) EXPECT_NEAR(r, 0, 1e-3);
  }
  Write("map.json", R"({"version": 1, "table": {"time": {"column": "t [ms]", "unit": "ms"}},
      "channels": [{"from": "x [mm]", "to": "body/m/position_x_m", "from_unit": "mm"}]})");
  std::ofstream(folder_ / "a.csv") << "t [ms],x [cm]\n0,1\n10,2\n";
  EXPECT_EQ(Make("taut: 1\nkind: fit\nname: f\nexperiments: [{name: t, experiment: slide.yaml, "
                 "data: a.csv, map: map.json}]\nestimate: [{parameter: v, low: 0.1, high: 2}]\n"
                 "residuals: [{channel: body/*/position_x_m, sd: 1}]\n"),
            nullptr);
  EXPECT_NE(out_.Format().find("a.csv has no column \"x [mm]\""), std::string::npos)
      << out_.Format();
}

}  // namespace
}  // namespace taut
