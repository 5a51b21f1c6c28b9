// The whole robot, with the probe on its boards and springs on its motors
#include "apps/virtual_robot/emulated_robot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/virtual_robot/probe_host.h"

namespace taut::virtual_robot {
namespace {

/// Returns the log and all memory of a run of 0.3 s.
std::string Story(std::uint64_t seed, double noise, Time slice = kSecond) {
  std::string story;
  SpringPlant plant;
  RobotOptions options;
  options.program = ProbeProgram();
  options.seed = seed;
  options.drift_ppm = {0, 500, -500, 1000, -1000, 20};
  options.log_frames = true;
  options.log = [&](Time at, std::string_view who, std::string_view what) {
    story += LogLine(at, who, what);
  };
  options.faults = {
      {.kind = FaultKind::kBusNoise, .at_s = 0.1, .for_s = 0.1, .flips_per_bit = noise},
      {.kind = FaultKind::kBrownOut, .at_s = 0.15, .for_s = 0.01, .board = 3}};
  Robot robot(plant, options);
  const auto advance = [&](Time until) {
    while (robot.now() < until) robot.AdvanceTo(std::min(until, robot.now() + slice));
  };
  ProbeHost host(robot);
  host.Configure();
  for (int cycle = 0; cycle < 30; ++cycle) {
    advance(cycle * 10 * kMillisecond);
    host.Send(std::vector<double>(12, 0.3 * std::sin(0.4 * cycle)), true);
    for (int board = 0; board < 6; ++board) host.Read(board);
  }
  for (int board = 0; board < 6; ++board) {
    for (std::uint16_t address = 0; address < 0x900; ++address) {
      story += static_cast<char>(robot.board(board).Memory(address));
    }
  }
  for (int motor = 0; motor < 12; ++motor) story += std::to_string(plant.RotorAngle(motor)) + "\n";
  return story;
}

TEST(Robot, TwoRunsAreTheSameToTheByte) {
  const std::string once = Story(7, 0.002);
  // Not EXPECT_EQ, which would print 20 kB twice.
  EXPECT_TRUE(once == Story(7, 0.002));
  EXPECT_FALSE(once == Story(8, 0.002)) << "another seed";
  EXPECT_FALSE(once == Story(7, 0.0));
}

TEST(Robot, HowTimeIsCutIntoPiecesDoesNotMatter) {
  const std::string whole = Story(7, 0.002);
  const std::string pieces = Story(7, 0.002, 7 * kMicrosecond + 130 * kNanosecond);
  const auto differ = std::mismatch(whole.begin(), whole.end(), pieces.begin(), pieces.end());
  EXPECT_TRUE(whole == pieces) << whole.substr(
      static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, differ.first - whole.begin() - 100)),
      200);
}

TEST(Robot, ABroadcastMovesAllMotors) {
  SpringPlant plant;
  Robot robot(plant, {.program = ProbeProgram()});
  ProbeHost host(robot);
  host.Configure();
  std::vector<double> duties;
  for (int motor = 0; motor < 12; ++motor) duties.push_back((motor - 5.5) / 12.0);
  robot.AdvanceTo(20 * kMillisecond);
  ASSERT_TRUE(host.Send(duties, true));
  robot.AdvanceTo(robot.now() + kMillisecond);
  for (int motor = 0; motor < 12; ++motor) {
    EXPECT_NEAR(robot.Drive(motor).duty, duties[static_cast<std::size_t>(motor)], 0.008) << motor;
    EXPECT_TRUE(robot.Drive(motor).enabled);
  }
  const std::vector<double> before = host.Angles(plant);
  robot.AdvanceTo(robot.now() + 50 * kMillisecond);
  for (int motor = 0; motor < 12; ++motor) {
    const auto i = static_cast<std::size_t>(motor);
    EXPECT_NEAR(plant.RotorAngle(motor) - before[i],
                robot.Drive(motor).duty * SpringPlant::kSpeed * 0.05, 1e-6);
  }
}

TEST(Robot, BoardsCountAndFeelWhatMoves) {
  SpringPlant plant;
  Robot robot(plant, {.program = ProbeProgram(), .load_cell = {.noise_counts = 0.0}});
  ProbeHost host(robot);
  host.Configure();
  for (int cycle = 0; cycle < 40; ++cycle) {
    robot.AdvanceTo(cycle * 10 * kMillisecond);
    host.Send(std::vector<double>(12, cycle < 30 ? 0.5 : 0.0), true);
  }
  robot.AdvanceTo(robot.now() + 5 * kMillisecond);
  for (int motor = 0; motor < 12; ++motor) {
    Board& board = robot.board(motor / 2);
    // Two counts per line: 32 per turn.
    const double counts = plant.RotorAngle(motor) * 32 / 6.283185307179586;
    EXPECT_NEAR(Count(board, motor % 2), counts, 1.0);
    EXPECT_GT(counts, 500.0);
    const auto cell = static_cast<std::uint16_t>(kBoxAdc + 2 * (motor % 2));
    EXPECT_EQ(Word(board, cell), LoadCellCode({}, plant.LoadCellForce(motor), 0.0));
  }
}

TEST(Robot, NoiseOfALoadCellHasItsDeviation) {
  SpringPlant plant;
  Robot robot(plant, {.program = ProbeProgram(), .load_cell = {.noise_counts = 3.0}});
  plant.Set(0, 400.0);  // 20 N, 159.1 counts
  double sum = 0, squares = 0;
  int n = 0;
  for (int i = 0; i < 4000; ++i) {
    robot.AdvanceTo(robot.now() + kMillisecond);
    if (i < 10) continue;
    const double code = Word(robot.board(0), kBoxAdc);
    sum += code, squares += code * code, ++n;
  }
  const double mean = sum / n, deviation = std::sqrt(squares / n - mean * mean);
  EXPECT_NEAR(mean, 20 / 0.1567 + 4.9363 / 0.1567, 4 * 3.0 / std::sqrt(n));
  EXPECT_NEAR(deviation, std::sqrt(9.0 + 1.0 / 12), 0.15) << "and what rounding adds";
}

TEST(Robot, NoiseOfALoadCellFollowsFromTheSeed) {
  const auto codes = [](std::uint64_t seed) {
    SpringPlant plant;
    Robot robot(plant, {.program = ProbeProgram(), .seed = seed, .load_cell = {.noise_counts = 3}});
    plant.Set(0, 400.0);
    std::vector<std::uint16_t> all;
    for (int i = 0; i < 20; ++i) {
      robot.AdvanceTo(robot.now() + kMillisecond);
      all.push_back(Word(robot.board(0), kBoxAdc));
    }
    return all;
  };
  EXPECT_EQ(codes(5), codes(5));
  EXPECT_NE(codes(5), codes(6));
}

TEST(Robot, AReplyTakesTheTimeOfTheBusAndOfUsb) {
  SpringPlant plant;
  Robot robot(plant, {.program = ProbeProgram()});
  ProbeHost host(robot);
  host.Configure();
  robot.AdvanceTo(20 * kMillisecond);
  const Time begun = robot.now();
  ASSERT_EQ(host.Read(2).size(), 16U);
  const double bus = 17 * 22.5e-6 + 2 * 2.5e-6;  // nine bits per byte at 400 kHz, start and stop
  const double took = ToSeconds(robot.now() - begun);
  EXPECT_GT(took, 0.5e-3 + bus);
  EXPECT_LT(took, 0.5e-3 + bus + 17 * 10e-6) << "the interrupts of the probe";
  EXPECT_EQ(robot.now(), robot.bus().result().ended + 250 * kMicrosecond);
}

TEST(Robot, AHostThatAsksNobodyWaitsInVain) {
  SpringPlant plant(2);
  Robot robot(plant, {.program = ProbeProgram()});
  const Bytes nonsense{0x11};
  EXPECT_FALSE(robot.Transfer(nonsense));
  EXPECT_EQ(robot.now(), 500 * kMillisecond);
  EXPECT_EQ(robot.board_count(), 1);
}

}  // namespace
}  // namespace taut::virtual_robot
