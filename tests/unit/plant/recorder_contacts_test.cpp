// Recorded contacts in slots, nodes, and channels of a run
#include <cmath>
#include <filesystem>
#include <set>

#include "report/facts.h"
#include "taut/live.h"
#include "taut/summary.h"
#include "tests/constants.h"
#include "tests/scenes/ball.h"
#include "unit/description/experiment_fixture.h"
#include "unit/plant/recorder_fixture.h"

namespace taut::test {
namespace {

/// Balls of 1, 2, 3 ... kg in a row on the ground
ModelDef Balls(int count) {
  ModelDef def;
  def.name = "balls";
  scenes::AddGround(def, {});
  for (int i = 0; i < count; ++i) {
    scenes::AddBall(def, "ball_" + std::to_string(i), i + 1, 0.1, {0.5 * i, 0, 0.1}, {});
  }
  return def;
}

const std::set<std::string> kOfAContact = {"body_a",    "body_b",    "point_x_m",
                                           "point_y_m", "point_z_m", "force_x_n",
                                           "force_y_n", "force_z_n", "gap_m"};

TEST(RecordedContacts, StandInSlotsAndEmptyOnesAreNaN) {
  const Recording run(RecordedExperiment(Balls(2), 0.1, {"contact/*", "system/contact_count"}, 3));
  ASSERT_EQ(run.trace.channels.size(), 1u + 3 * kOfAContact.size());
  EXPECT_EQ(run.Last("system/contact_count"), 2);
  for (int k = 0; k < 2; ++k) {
    const std::string slot = "contact/" + std::to_string(k) + "/";
    EXPECT_EQ(run.Last(slot + "body_a"), k);
    EXPECT_EQ(run.Last(slot + "body_b"), kWorld);
    ExpectNear(run.VectorAt(slot + "point_", "_m", run.rows() - 1), {0.5 * k, 0, 0}, 1e-6, slot);
    ExpectNear(run.VectorAt(slot + "force_", "_n", run.rows() - 1), {0, 0, (k + 1) * kG}, 1e-6,
               slot);
    EXPECT_NEAR(run.Last(slot + "gap_m"), 0, 1e-6);
  }
  for (const std::string& name : kOfAContact)
    EXPECT_TRUE(std::isnan(run.Last("contact/2/" + name)));
  EXPECT_EQ(run.summary.left_out.contacts, 0);
  EXPECT_EQ(report::LeftOutText(run.summary), "");
}

TEST(RecordedContacts, WhereSlotsAreFewTheLargestForcesStayAndTheSummarySaysSo) {
  const Recording run(RecordedExperiment(Balls(4), 0.01, {"contact/*", "system/contact_count"}, 3));
  const std::size_t last = run.rows() - 1;
  EXPECT_EQ(run.At("system/contact_count", last), 4);
  for (int k = 0; k < 3; ++k) {  // the lightest is left out, the others keep their order
    const std::string slot = "contact/" + std::to_string(k) + "/";
    EXPECT_EQ(run.At(slot + "body_a", last), k + 1);
    EXPECT_NEAR(run.At(slot + "force_z_n", last), (k + 2) * kG, 1e-6);
  }
  const LeftOutContacts& left = run.summary.left_out;
  EXPECT_EQ(left.rows, static_cast<std::int64_t>(run.rows()) - 1) << "nothing touches at the start";
  EXPECT_EQ(left.contacts, left.rows);
  EXPECT_EQ(left.most_touching, 4);
  EXPECT_EQ(report::LeftOutText(run.summary),
            "10 contacts in 10 rows were not recorded; set record.contacts: 4 to record all");
  EXPECT_NE(SummaryTable(run.summary).find("WARNING: 10 contacts in 10 rows"), std::string::npos);
  EXPECT_NE(SummaryJson(run.summary).find("\"contacts_left_out\": 10,"), std::string::npos);
}

TEST(RecordedContacts, AreAllThereUnlessChannelsNamesSome) {
  const ModelDef def = Balls(1);
  const auto count = [&](const std::vector<std::string>& channels) {
    std::size_t contacts = 0;
    for (const ChannelInfo& channel : RunChannels(RecordedExperiment(def, 0, channels, 2))) {
      contacts += channel.name.starts_with("contact/");
    }
    return contacts;
  };
  EXPECT_EQ(count({}), 18u);
  EXPECT_EQ(count({"body/*"}), 18u);
  EXPECT_EQ(count({"body/*", "contact/*/force_?_n"}), 18u) << "? is no wildcard";
  EXPECT_EQ(count({"body/*", "contact/*/force_*"}), 6u);
}

TEST(RecordedContacts, EmptySlotsSurviveFiles) {
  const ExperimentSpec experiment = RecordedExperiment(Balls(1), 0.01, {"contact/*"}, 2);
  const std::filesystem::path folder(testing::TempDir());
  for (const char* const name : {"taut_contacts.h5", "taut_contacts.csv"}) {
    const std::string path = (folder / name).string();
    Diagnostics out;
    const auto channels = RunChannels(experiment);
    const auto writer = path.ends_with(".h5") ? CreateHdf5Trace(path, channels, {}, out)
                                              : CreateCsvTrace(path, channels, out);
    RunOptions options;
    options.traces = {writer.get()};
    ASSERT_TRUE(RunExperiment(experiment, options, out)) << out.Format();
    const auto trace = ReadTrace(path, out);
    ASSERT_TRUE(trace) << out.Format();
    ASSERT_EQ(trace->time_s.size(), 11u);
    const auto last = [&](const char* channel) { return trace->values[*trace->Find(channel)][10]; };
    EXPECT_NEAR(last("contact/0/force_z_n"), kG, 1e-6);
    EXPECT_TRUE(std::isnan(last("contact/1/force_z_n")));
    std::filesystem::remove(path);
  }
}

TEST(RecordedNodes, MoveWithTheirBody) {
  ModelDef def;
  def.name = "ball";
  def.gravity_m_per_s2 = {};
  scenes::AddBall(def, "ball", 1, 0.1, {1, 2, 3}, {});
  def.nodes.push_back({"pole", 0, {1, 2, 3.1}});
  def.nodes.push_back({"wall", kWorld, {5, 6, 7}});
  def.bodies[0].velocity_m_per_s = {0.5, 0, 0};
  def.bodies[0].angular_velocity_rad_per_s = {0, 2, 0};
  const Recording run(RecordedExperiment(def, 0.1, {"node/*"}));
  ASSERT_EQ(run.trace.channels.size(), 18u);
  const std::size_t last = run.rows() - 1;
  const double turned = 2 * 0.1;
  ExpectNear(run.VectorAt("node/pole/position_", "_m", last),
             {1.05 + 0.1 * std::sin(turned), 2, 3 + 0.1 * std::cos(turned)}, 1e-9, "");
  ExpectNear(run.VectorAt("node/pole/velocity_", "_m_per_s", last),
             {0.5 + 0.2 * std::cos(turned), 0, -0.2 * std::sin(turned)}, 1e-9, "");
  ExpectNear(run.VectorAt("node/wall/position_", "_m", last), {5, 6, 7}, 0, "");
  ExpectNear(run.VectorAt("node/wall/velocity_", "_m_per_s", last), {}, 0, "");
}

std::vector<std::string> Groups(const std::vector<ChannelInfo>& channels) {
  std::vector<std::string> groups;
  for (const ChannelInfo& channel : channels) {
    const std::string group = channel.name.substr(0, channel.name.find('/'));
    if (groups.empty() || groups.back() != group) groups.push_back(group);
  }
  return groups;
}

class RecordedChannels : public ExperimentFolder {};

TEST_F(RecordedChannels, OnRequestMeansNotByDefault) {
  ExperimentSpec experiment = Load();
  using Names = std::vector<std::string>;
  EXPECT_EQ(Groups(RunChannels(experiment)), (Names{"cable", "body", "push", "system"}));
  experiment.record.channels = {"*"};
  EXPECT_EQ(Groups(RunChannels(experiment)),
            (Names{"cable", "body", "push", "system", "node", "strut"}));
  experiment.record.channels = {"node/a0/position_*"};
  EXPECT_EQ(RunChannels(experiment).size(), 3u);
}

TEST_F(RecordedChannels, ALiveRunHasTheUsualOnesAndContacts) {
  ExperimentSpec experiment = Load();
  const std::size_t without = RunChannels(experiment).size();
  experiment.record.contacts = 4;
  const std::size_t usual = RunChannels(experiment).size();
  ASSERT_EQ(usual, without + 4 * kOfAContact.size());
  experiment.record.channels = {"*"};
  Diagnostics out;
  const auto live = LiveRun::Start(experiment, out);
  ASSERT_TRUE(live) << out.Format();
  EXPECT_EQ(live->channels().size(), usual + 8);
  EXPECT_EQ(live->Row().size(), usual + 8);
}

TEST_F(RecordedChannels, HintsKnowThoseOnRequest) {
  ExperimentSpec experiment = Load();
  const auto complaint = [&](const std::string& pattern, int contacts = 0) {
    experiment.record.channels = {pattern};
    experiment.record.contacts = contacts;
    Diagnostics out;
    const bool good = CheckRecord(experiment, out);
    EXPECT_EQ(good, out.ok());
    return out.Format();
  };
  EXPECT_EQ(complaint("node/*/velocity_x_m_per_s"), "");
  EXPECT_EQ(complaint("strut/a/axial_n"), "");
  EXPECT_EQ(complaint("contact/0/gap_m", 1), "");
  EXPECT_NE(complaint("node/*/positon_x_m").find("(did you mean \"node/*/position_x_m\"?)"),
            std::string::npos);
  EXPECT_NE(complaint("contact/0/gap_m")
                .find("record.contacts is 0: set it to the number of contacts to record"),
            std::string::npos);
  EXPECT_NE(complaint("contact/1/gap_m", 1).find("did you mean"), std::string::npos);
}

TEST_F(RecordedChannels, HowManyContactsComesBackResolvedAndMayBeMissingThere) {
  Change("rate_hz: 50", "rate_hz: 50, contacts: 7");
  const ExperimentSpec before = Load();
  EXPECT_EQ(before.record.contacts, 7);
  std::string text = ResolvedYaml(before);
  Write("resolved.yaml", text);
  EXPECT_EQ(Load("resolved.yaml").record.contacts, 7);
  const std::string line = "contacts: 7";
  const std::size_t at = text.find(line), comma = text.rfind(',', at);
  ASSERT_NE(at, std::string::npos);
  Write("earlier.yaml", text.erase(comma, at + line.size() - comma));
  EXPECT_EQ(Load("earlier.yaml").record.contacts, 0);
}

TEST_F(RecordedChannels, TheNumberOfContactsHasARange) {
  Change("rate_hz: 50", "rate_hz: 50, contacts: 1001");
  EXPECT_NE(Complaints().find("record.contacts must be"), std::string::npos) << Complaints();
}

}  // namespace
}  // namespace taut::test
