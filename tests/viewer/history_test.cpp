// Recorded history of a live run
#include "apps/viewer/history.h"

#include <gtest/gtest.h>

#include <cmath>

namespace taut::test {
namespace {

using viewer::Frame;
using viewer::History;
using viewer::Json;

ModelDef OneOfEach() {
  ModelDef def;
  def.bodies.resize(1);
  def.bodies[0].name = "rod";
  def.cables.resize(1);
  def.cables[0].name = "string";
  return def;
}

History HistoryOfOneOfEach(std::size_t max_bytes = 128u << 20) {
  return {OneOfEach(), {true}, 0.01, {}, max_bytes};
}

/// Returns a frame whose numbers all follow from its index; some have pushes, contacts and bends.
Frame Moment(int i) {
  Frame frame;
  frame.time_s = 0.01 * i;
  frame.real_time_factor = 1;
  frame.energy = {1.0 * i, 2.0 * i, 3.0 * i};
  frame.bodies = {{{0.1 * i, 0.2 * i, 0.3 * i}, {1, 0, 0, 0.001 * i}}};
  frame.cables = {{5.0 + i, 0.5, 0.25, 4.0}};
  for (int k = 0; k < i % 4; ++k) frame.contacts.push_back({{1.0 * k, 0, 0}, {0, 0, 1.0 * i}});
  frame.contact_count = i % 4;
  if (i % 3 == 0) frame.pushes = {{7, {1.0 * i, 0, 0}}};
  for (int k = 0; k < i % 5; ++k) frame.bends.push_back({0, {0.01 * i, 1.0 * k, 0}});
  return frame;
}

std::vector<double> Numbers(const Frame& frame) { return viewer::FrameNumbers(frame); }

TEST(History, ShowsEveryMomentAsItWas) {
  History history = HistoryOfOneOfEach();
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(history.IsDue(0.01 * i)) << i;
    history.Take(Moment(i));
    ASSERT_FALSE(history.IsDue(0.01 * i + 0.009)) << i;
  }
  for (const int i : {0, 1, 12, 99}) {
    Frame frame;
    frame.real_time_factor = 1;
    history.Show(history.RowAt(0.01 * i + 0.004), frame);
    EXPECT_EQ(Numbers(frame), Numbers(Moment(i))) << i;
  }
  EXPECT_EQ(history.RowAt(-1), 0u);
  EXPECT_EQ(history.RowAt(1e9), 99u);
}

TEST(History, ASetPointIsAChannelWhereThereIsOne) {
  for (const bool controlled : {false, true}) {
    History history(OneOfEach(), {controlled}, 0.01);
    history.Take(Moment(3));
    EXPECT_EQ(history.SeriesOf("cable/string/setpoint_n", 0, 1, 9).is_null(), !controlled);
    EXPECT_EQ(history.SeriesOf("cable/string/rest_length_m", 0, 1, 9)["first"][0], 0.25);
    EXPECT_EQ(history.channels().size(), 5u + 7u + (controlled ? 4u : 3u));
    Frame frame;
    frame.real_time_factor = 1;
    history.Show(0, frame);
    EXPECT_EQ(Numbers(frame), Numbers(Moment(3)));
  }
}

TEST(History, SeriesHaveTheLeastAndGreatestOfTheirBlocks) {
  History history = HistoryOfOneOfEach();
  for (int i = 0; i < 100; ++i) history.Take(Moment(i));
  const Json all = history.SeriesOf("cable/string/tension_n", 0, 1, 1000);
  EXPECT_EQ(all["level"], 1);
  ASSERT_EQ(all["first"].size(), 100u);
  EXPECT_EQ(all["first"][42], 47);
  const Json few = history.SeriesOf("cable/string/tension_n", 0, 1, 25);
  EXPECT_EQ(few["level"], 4);
  ASSERT_EQ(few["first"].size(), 25u);
  EXPECT_EQ(few["min"][3], 17);
  EXPECT_EQ(few["max"][3], 20);
  EXPECT_EQ(few["first"][3], 17);
  // A narrow span contains the rows themselves, regardless of the requested points.
  const Json row = history.SeriesOf("cable/string/tension_n", 0.4249, 0.4249, 4);
  EXPECT_EQ(row["level"], 1);
  EXPECT_EQ(row["first"], Json({47, 48}));
  EXPECT_EQ(history.SeriesOf("body/rod/position_z_m", 0, 1, 1000)["max"][99], 0.3 * 99);
  EXPECT_EQ(history.SeriesOf("system/elastic_j", 0, 1, 1000)["max"][99], 297);
  EXPECT_TRUE(history.SeriesOf("cable/absent/tension_n", 0, 1, 100).is_null());
  EXPECT_EQ(history.channels().size(), 5u + 7u + 4u);
}

TEST(History, KeepsTheWholeRunMoreCoarselyTheLongerItLasts) {
  constexpr std::size_t kBytes = 40000;  // about 100 rows
  History history = HistoryOfOneOfEach(kBytes);
  int taken = 0;
  for (int i = 0; i < 10000; ++i) {
    if (!history.IsDue(0.01 * i)) continue;
    history.Take(Moment(i));
    ++taken;
  }
  EXPECT_LT(history.size(), 200u);
  EXPECT_GT(history.size(), 50u);
  EXPECT_LT(taken, 1000);
  EXPECT_EQ(history.time_s(0), 0);
  EXPECT_GT(history.time_s(history.size() - 1), 97);
  const double step_s = history.time_s(1) - history.time_s(0);
  for (std::size_t row = 1; row < history.size(); ++row) {
    EXPECT_NEAR(history.time_s(row) - history.time_s(row - 1), step_s, 1e-9);
    Frame frame;
    frame.real_time_factor = 1;
    history.Show(row, frame);
    const int i = static_cast<int>(std::lround(history.time_s(row) / 0.01));
    EXPECT_EQ(Numbers(frame), Numbers(Moment(i)));
  }
  history.Clear();
  EXPECT_EQ(history.size(), 0u);
  EXPECT_TRUE(history.IsDue(0));
}

TEST(History, KeepsWhatIsRecordedBesideFrames) {
  const std::vector<ChannelInfo> recorded = {{"cable/string/tension_n", "N"},
                                             {"cable/string/rate_m_per_s", "m/s"},
                                             {"push/a/force_n", "N"}};
  History history(OneOfEach(), {true}, 0.01, recorded, 40000);
  for (int i = 0; i < 1000; ++i) {
    if (history.IsDue(0.01 * i)) history.Take(Moment(i), {-1, 0.5 * i, 20});
  }
  EXPECT_EQ(history.channels().size(), 5u + 7u + 4u + 2u);
  EXPECT_EQ(history.channels().back().unit, "N");
  const Json rate = history.SeriesOf("cable/string/rate_m_per_s", 0, 10, 1000);
  ASSERT_EQ(rate["first"].size(), history.size());
  for (std::size_t row = 0; row < history.size(); ++row) {
    EXPECT_NEAR(rate["first"][row], 50 * history.time_s(row), 1e-9);
  }
  EXPECT_EQ(history.SeriesOf("push/a/force_n", 0, 10, 1000)["min"][3], 20);
  EXPECT_EQ(history.SeriesOf("cable/string/tension_n", 0, 0, 4)["first"][0], 5) << "the frame's";
}

// Half a turn about x + z maps (x, y, z) to (z, -y, x).
TEST(History, NodesAreWhereTheirBodiesTakeThem) {
  ModelDef def = OneOfEach();
  def.bodies[0].com_m = {1, 2, 3};
  def.nodes.resize(2);
  def.nodes[0].name = "rod.top";
  def.nodes[0].body = 0;
  def.nodes[0].position_m = {1.5, 2.25, 2};
  def.nodes[1].name = "hook";
  def.nodes[1].body = kWorld;
  History history(def, {true}, 0.01);
  Frame frame = Moment(4);
  const double half = std::sqrt(0.5);
  frame.bodies = {{{10, 20, 30}, {0, half, 0, half}}};
  history.Take(frame);
  const double wanted[] = {10 - 1, 20 - 0.25, 30 + 0.5};
  for (int k = 0; k < 3; ++k) {
    const std::string name = std::string("node/rod.top/position_") + "xyz"[k] + "_m";
    EXPECT_NEAR(history.SeriesOf(name, 0, 1, 9)["first"][0], wanted[k], 1e-14) << name;
  }
  EXPECT_TRUE(history.SeriesOf("node/hook/position_x_m", 0, 1, 9).is_null());
  EXPECT_EQ(history.channels().size(), 5u + 7u + 4u + 3u);
}

}  // namespace
}  // namespace taut::test
