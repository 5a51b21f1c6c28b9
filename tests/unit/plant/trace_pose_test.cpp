// Poses read from traces
#include "taut/trace_pose.h"

#include <gtest/gtest.h>

#include <cmath>

#include "taut/statics.h"
#include "taut/world_batch.h"

namespace taut {
namespace {

class TracePose : public testing::Test {
 protected:
  TracePose() : robot_(*LoadRobot(TAUT_SOURCE_DIR "/share/models/prism3.yaml", {}, out_)) {
    trace_.time_s = {0.0, 0.5};
  }

  void Put(const std::string& name, double first, double second) {
    trace_.channels.push_back({name, "1"});
    trace_.values.push_back({first, second});
  }

  /// Writes poses with every body rotated by a right angle about z and translated, computed
  /// explicitly.
  void PutAll() {
    const double half = std::sqrt(0.5);
    for (const BodyDef& body : robot_.def.bodies) {
      const std::string name = "body/" + body.name + "/";
      Put(name + "position_x_m", 0, 1 - body.com_m.y);
      Put(name + "position_y_m", 0, 2 + body.com_m.x);
      Put(name + "position_z_m", 0, 3 + body.com_m.z);
      Put(name + "orientation_w", 1, half);
      Put(name + "orientation_x", 0, 0);
      Put(name + "orientation_y", 0, 0);
      Put(name + "orientation_z", 0, half);
    }
  }
  std::size_t Channel(const std::string& name) const { return *trace_.Find(name); }

  std::optional<Pose> At(std::size_t row) {
    return PoseOfTrace(robot_, trace_, row, {"seen.csv", 0, 0}, out_);
  }

  Diagnostics out_;
  RobotSpec robot_;
  Trace trace_;
};

TEST_F(TracePose, NodesAreWhereTheRowPutsThem) {
  PutAll();
  const auto pose = At(1);
  ASSERT_TRUE(pose) << out_.Format();
  const ModelDef there = RobotAt(robot_, *pose).def;
  for (std::size_t n = 0; n < there.nodes.size(); ++n) {
    const Vec3 &was = robot_.def.nodes[n].position_m, &is = there.nodes[n].position_m;
    EXPECT_NEAR(is.x, 1 - was.y, 1e-12);
    EXPECT_NEAR(is.y, 2 + was.x, 1e-12);
    EXPECT_NEAR(is.z, 3 + was.z, 1e-12);
  }
  for (std::size_t c = 0; c < there.cables.size(); ++c) {
    EXPECT_EQ(there.cables[c].rest_length_m, robot_.def.cables[c].rest_length_m);
  }
  EXPECT_TRUE(out_.warnings().empty()) << out_.Format();
}

TEST_F(TracePose, RestLengthsAreThoseRecorded) {
  PutAll();
  const std::string& name = robot_.def.cables[2].name;
  Put("cable/" + name + "/rest_length_m", 0.1, 0.25);
  const auto pose = At(1);
  ASSERT_TRUE(pose) << out_.Format();
  EXPECT_EQ(pose->rest_lengths_m[2], 0.25);
  EXPECT_EQ(pose->rest_lengths_m[1], robot_.def.cables[1].rest_length_m);
}

TEST_F(TracePose, AllThatIsWrongIsNamed) {
  PutAll();
  const std::string first = "body/" + robot_.def.bodies[0].name + "/";
  const std::string second = "body/" + robot_.def.bodies[1].name + "/";
  trace_.channels[Channel(first + "position_y_m")].name = "somebody";
  trace_.values[Channel(first + "position_z_m")][1] = NAN;
  trace_.values[Channel(second + "orientation_w")][1] = 0.9;
  Put("cable/" + robot_.def.cables[0].name + "/rest_length_m", 1, -1);
  EXPECT_FALSE(At(1));
  const std::string said = out_.Format();
  for (const std::string& part :
       {"seen.csv: error: the trace has no channel " + first + "position_y_m",
        first + "position_z_m is nan at 0.5 s",
        "the orientation of body " + robot_.def.bodies[1].name + " has the length 1.145",
        "cable/" + robot_.def.cables[0].name + "/rest_length_m is -1"}) {
    EXPECT_NE(said.find(part), std::string::npos) << part << "\n" << said;
  }
  EXPECT_EQ(out_.items().size(), 4u) << said;
}

TEST_F(TracePose, ARowThatIsNotThereIsAnError) {
  PutAll();
  EXPECT_FALSE(At(2));
  EXPECT_FALSE(out_.ok());
}

/// Rotations are relative to the described pose: if the robot was placed differently, cable lengths
/// differ from the recorded ones.
TEST_F(TracePose, ARecordingOfAnotherPlacementIsAWarning) {
  PutAll();
  const CableDef& cable = robot_.def.cables[0];
  Put("cable/" + cable.name + "/length_m", 1, 1.0005 * CableLength(cable));
  EXPECT_TRUE(At(1));
  EXPECT_TRUE(out_.warnings().empty()) << out_.Format();
  trace_.values.back()[1] = 1.002 * CableLength(cable);
  EXPECT_TRUE(At(1));
  ASSERT_EQ(out_.warnings().size(), 1u);
  EXPECT_NE(out_.Format().find("cable " + cable.name + " is "), std::string::npos);
}

/// Anchored bodies need not be recorded.
TEST_F(TracePose, WhatStandsStillMayBeLeftOut) {
  robot_.def.bodies[0].fixed = true;
  PutAll();
  const std::string name = "body/" + robot_.def.bodies[0].name + "/position_x_m";
  trace_.channels[Channel(name)].name = "somebody";
  const auto pose = At(1);
  ASSERT_TRUE(pose) << out_.Format();
  EXPECT_EQ(pose->bodies[0].position_m.x, robot_.def.bodies[0].com_m.x);
  robot_.def.bodies[0].fixed = false;
  EXPECT_FALSE(At(1));
}

}  // namespace
}  // namespace taut
