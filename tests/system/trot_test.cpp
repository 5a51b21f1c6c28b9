// Standing and trotting of a tensegrity with four legs (docs/validation/puppy.md)
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "system/columns.h"
#include "taut/run.h"
#include "taut/spec.h"

namespace taut {
namespace {

constexpr int kSlots = 8;

/// Recorded columns of a run, and the feet in contact in each row
struct Outcome {
  Columns columns;
  std::map<std::string, std::vector<bool>> carries;  ///< Whether each leg's foot is in contact, by
                                                     ///< the leg's name.
  bool only_feet = true;                             ///< No other contacts occurred.
};

/// Runs an experiment. `friction`: factor of all coefficients.
Outcome SimulateTrot(const std::string& name, double friction = 1) {
  Outcome outcome;
  Diagnostics out;
  auto experiment = LoadExperiment(TAUT_SOURCE_DIR "/share/experiments/" + name + ".yaml", {}, out);
  EXPECT_TRUE(experiment) << out.Format();
  if (!experiment) return outcome;
  experiment->scales.push_back({ScaleSpec::Quantity::kFriction, {}, friction});
  experiment->record.rate_hz = 100;
  experiment->record.contacts = kSlots;
  experiment->record.channels = {"system/com_*_m", "body/*/position_z_m", "body/*/orientation_*",
                                 "contact/*/body_*", "contact/*/force_z_n"};
  Rows rows(*experiment);
  RunOptions options;
  options.traces = {&rows};
  const auto summary = RunExperiment(*experiment, options, out);
  EXPECT_TRUE(summary) << out.Format();
  EXPECT_EQ(summary ? summary->status_text : "no run", "");
  outcome.columns = std::move(rows.columns);
  const std::size_t count = outcome.columns["time_s"].size();

  std::map<long, std::string> leg_of;  // by the index of the shank's body
  for (std::size_t b = 0; b < experiment->robot.def.bodies.size(); ++b) {
    const std::string& body = experiment->robot.def.bodies[b].name;
    for (const char* leg : {"front_left", "front_right", "rear_left", "rear_right"}) {
      if (body == std::string(leg) + ".spur-shank_knee") leg_of[static_cast<long>(b)] = leg;
    }
  }
  EXPECT_EQ(leg_of.size(), 4u);
  for (const auto& [body, leg] : leg_of) outcome.carries[leg].assign(count, false);
  for (int slot = 0; slot < kSlots; ++slot) {
    const std::string contact = "contact/" + std::to_string(slot) + "/";
    const std::vector<double>& a = outcome.columns[contact + "body_a"];
    const std::vector<double>& b = outcome.columns[contact + "body_b"];
    const std::vector<double>& up_n = outcome.columns[contact + "force_z_n"];
    for (std::size_t row = 0; row < a.size(); ++row) {
      if (std::isnan(a[row])) continue;
      const auto leg = leg_of.find(std::lround(a[row]));
      if (leg == leg_of.end() || std::lround(b[row]) != -1) {
        outcome.only_feet = false;
      } else if (up_n[row] > 0) {
        outcome.carries[leg->second][row] = true;
      }
    }
  }
  return outcome;
}

double Ahead(const Outcome& outcome) {
  const std::vector<double>& x = outcome.columns.at("system/com_x_m");
  return x.back() - x.front();
}

/// Returns the least height of the centers of mass of the two girdles [m].
double Lowest(const Outcome& outcome) {
  double lowest_m = std::numeric_limits<double>::infinity();
  for (const char* body : {"vertebra_0.centre-left", "vertebra_3.centre-left"}) {
    for (const double z : outcome.columns.at(std::string("body/") + body + "/position_z_m")) {
      lowest_m = std::min(lowest_m, z);
    }
  }
  return lowest_m;
}

/// Returns the largest tilt of a girdle's vertical axis [rad].
double Tilt(const Outcome& outcome) {
  double least = 1;
  for (const char* body : {"vertebra_0.centre-left", "vertebra_3.centre-left"}) {
    const std::string orientation = std::string("body/") + body + "/orientation_";
    const std::vector<double>& x = outcome.columns.at(orientation + "x");
    const std::vector<double>& y = outcome.columns.at(orientation + "y");
    for (std::size_t row = 0; row < x.size(); ++row) {
      least = std::min(least, 1 - 2 * (x[row] * x[row] + y[row] * y[row]));
    }
  }
  return std::acos(std::max(-1.0, least));
}

/// Returns the share of the time from 2 s on in which two feet are in the same state, in contact or
/// not.
double Alike(const Outcome& outcome, const std::string& one, const std::string& other) {
  const std::vector<bool>& a = outcome.carries.at(one);
  const std::vector<bool>& b = outcome.carries.at(other);
  const std::vector<double>& time_s = outcome.columns.at("time_s");
  int same = 0, all = 0;
  for (std::size_t row = 0; row < time_s.size(); ++row) {
    if (time_s[row] < 2) continue;
    ++all;
    same += a[row] == b[row] ? 1 : 0;
  }
  return all > 0 ? static_cast<double>(same) / all : 0.0;
}

TEST(Puppy, StandsOnItsFourFeetAndStandsUpToAPush) {
  const Outcome outcome = SimulateTrot("puppy_stand");
  ASSERT_EQ(outcome.carries.size(), 4u);
  EXPECT_TRUE(outcome.only_feet);
  for (const auto& [leg, carries] : outcome.carries) EXPECT_TRUE(carries.back()) << leg;
  EXPECT_GT(Lowest(outcome), 0.26);
  EXPECT_LT(Tilt(outcome), 0.1);
  EXPECT_LT(std::fabs(Ahead(outcome)), 0.005);
}

TEST(Puppy, TrotsAMetreWithoutFalling) {
  for (const double friction : {1.0, 0.7, 1.3}) {
    const Outcome outcome = SimulateTrot("puppy_trot", friction);
    ASSERT_EQ(outcome.carries.size(), 4u);
    EXPECT_TRUE(outcome.only_feet) << friction;
    EXPECT_GT(Ahead(outcome), 1.0) << friction;
    EXPECT_GT(Lowest(outcome), 0.25) << friction;
    EXPECT_LT(Tilt(outcome), 0.2) << friction;
  }
}

TEST(Puppy, MovesTheLegsOfADiagonalTogether) {
  const Outcome outcome = SimulateTrot("puppy_trot");
  ASSERT_EQ(outcome.carries.size(), 4u);
  EXPECT_GT(Alike(outcome, "front_left", "rear_right"), 0.7);
  EXPECT_GT(Alike(outcome, "front_right", "rear_left"), 0.7);
  EXPECT_LT(Alike(outcome, "front_left", "rear_left"), 0.4);  // pace
  EXPECT_LT(Alike(outcome, "front_right", "rear_right"), 0.4);
  EXPECT_LT(Alike(outcome, "front_left", "front_right"), 0.4);  // bound
  EXPECT_LT(Alike(outcome, "rear_left", "rear_right"), 0.4);
}

}  // namespace
}  // namespace taut
