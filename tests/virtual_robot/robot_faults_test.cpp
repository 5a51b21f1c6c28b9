// Each kind of fault once, with the driver and the firmware of all boards: no tension above the
// limit, motors held or off as specified, and the fault reported or counted. A silent fault fails
// the test. docs/validation/robot_faults.md has twenty trials of each.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>

#include "apps/virtual_robot/boards_plant.h"
#include "taut/run.h"

namespace taut::virtual_robot {
namespace {

using board::Mode;

constexpr double kLimit_n = 50;
constexpr double kFault_s = 0.3, kEnd_s = 0.8;  // of the experiment

ExperimentSpec FaultPush() {
  Diagnostics found;
  auto experiment =
      LoadExperiment(TAUT_SOURCE_DIR "/share/experiments/push_20n_motors.yaml", {}, found);
  EXPECT_TRUE(experiment.has_value()) << found.Format();
  experiment->duration_s = kEnd_s;
  return *experiment;
}

/// An experiment on boards, with the events reported after its fault
class Broken {
 public:
  explicit Broken(FaultSpec fault, BoardsOptions options = {}) : experiment_(FaultPush()) {
    Diagnostics found;
    options.robot.program = ReadAvrProgram(TAUT_FIRMWARE_ELF, found);
    motors = MotorPlant::Make(experiment_.robot, found);
    // Time at which the setup is complete; the same in every run.
    static const double started_s = [&] {
      const auto other = MotorPlant::Make(experiment_.robot, found);
      BoardsPlant good(experiment_, *other, options);
      EXPECT_TRUE(good.Prepare(found)) << found.Format();
      return good.started_s();
    }();
    fault.at_s = started_s + kFault_s;
    options.robot.faults = {fault};
    plant = std::make_unique<BoardsPlant>(experiment_, *motors, options);
    plant->driver().on_event = [this, at_s = fault.at_s](double time_s, const std::string& text) {
      if (time_s < at_s || text.find(" -> ") != std::string::npos) return;
      if (first_s < 0) first_s = time_s - at_s;
      told += text + "\n";
    };
    plant->driver().on_cycle = [this, at_s = fault.at_s](const link::State& state) {
      if (state.time_s < at_s) counted_before_ = Count();
    };
    EXPECT_TRUE(plant->Prepare(found)) << found.Format();
    EXPECT_EQ(plant->started_s(), started_s);
    RunOptions how;
    how.plant = plant.get();
    EXPECT_TRUE(RunExperiment(experiment_, how, found).has_value()) << found.Format();
    EXPECT_LE(plant->most_n(), kLimit_n);
  }
  ~Broken() {
    plant->driver().on_event = {};
    plant->driver().on_cycle = {};
  }

  bool Told(const std::string& text) const { return told.find(text) != std::string::npos; }
  /// Returns the number of boards in a mode, by the statuses that the PC received last.
  int In(Mode mode) const {
    int count = 0;
    for (const link::BoardView& board : plant->heard().boards) {
      count += board.there && board.status.mode == mode;
    }
    return count;
  }
  /// Returns the counts caused by a fault that has no event.
  std::int64_t Counted() const { return Count() - counted_before_; }

  std::string told;
  double first_s = -1;
  std::unique_ptr<MotorPlant> motors;
  std::unique_ptr<BoardsPlant> plant;

 private:
  std::int64_t Count() const {
    const link::LinkView& link = plant->heard().link;
    std::int64_t sum = plant->bad_frames() + link.silent_transfers + link.unheard_broadcasts +
                       link.failed_group_reads;
    for (const link::BoardView& board : plant->heard().boards) {
      sum += board.bad_messages + board.missed_broadcasts + board.bus_recoveries + board.late_ticks;
    }
    return sum;
  }

  ExperimentSpec experiment_;
  std::int64_t counted_before_ = 0;
};

struct Case {
  const char* name;
  FaultKind kind;
  double for_s;
  const char* told;                   ///< Null: counted only.
  int impedance, hold, off, stopped;  ///< Expected numbers of boards in each mode.
  double force_n = std::numeric_limits<double>::quiet_NaN();
  BusLine line = BusLine::kData;
};
std::ostream& operator<<(std::ostream& out, const Case& one) { return out << one.name; }

class RobotFaults : public testing::TestWithParam<Case> {};

constexpr double kForGood = std::numeric_limits<double>::infinity();
constexpr const char* kLost = "emergency stop: board";
const Case kCases[] = {
    {"BroadcastsLost", FaultKind::kHostKilled, 0.06, nullptr, 6, 0, 0, 0},
    {"PcKilled", FaultKind::kHostKilled, kForGood, kLost, 0, 0, 0, 0},
    {"UsbPulledOut", FaultKind::kUsbLoss, 0.2, "the adapter is gone", 6, 0, 0, 0},
    {"BoardGone", FaultKind::kBoardLoss, kForGood, kLost, 0, 0, 0, 5},
    {"BrownOut", FaultKind::kBrownOut, 0.02, "board 2: reset cause brown_out", 0, 5, 1, 0},
    {"FirmwareHangs", FaultKind::kFirmwareHang, kForGood, "board 2: reset cause watchdog", 0, 5, 1,
     0},
    {"BusNoise", FaultKind::kBusNoise, 0.3, nullptr, 6, 0, 0, 0},
    {"IllegalStart", FaultKind::kBusError, kForGood, nullptr, 6, 0, 0, 0},
    {"DataLow", FaultKind::kBusStuck, 0.3, "received no broadcast in time", 6, 0, 0, 0},
    {"ClockLow", FaultKind::kBusStuck, 0.3, "received no broadcast in time", 6, 0, 0, 0,
     std::numeric_limits<double>::quiet_NaN(), BusLine::kClock},
    {"CableCut", FaultKind::kCutCable, kForGood, "inner_top_1 is slack", 6, 0, 0, 0},
    {"LoadCellStands", FaultKind::kStuckLoadCell, kForGood,
     "inner_top_1: its load cell reading does not change", 6, 0, 0, 0},
    {"LoadCellShowsNothing", FaultKind::kStuckLoadCell, kForGood, "inner_top_1: sensor", 0, 6, 0, 0,
     -5},
    {"LoadCellShowsTooMuch", FaultKind::kStuckLoadCell, kForGood, "inner_top_1: over_tension", 0, 6,
     0, 0, 60},
    {"EncoderStands", FaultKind::kStuckEncoder, kForGood, "inner_top_1: stall", 0, 6, 0, 0},
    {"DriverFault", FaultKind::kDriverFault, 0.1, "board 2: driver", 0, 5, 1, 0},
    {"NoSupply", FaultKind::kMotorSupplyLoss, 0.2, "board 2: driver", 0, 0, 6, 0},
};

TEST_P(RobotFaults, AreToldAndHarmNothing) {
  const Case& one = GetParam();
  FaultSpec fault;
  fault.kind = one.kind;
  fault.for_s = one.for_s;
  fault.line = one.line;
  fault.flips_per_bit = 1e-3;
  if (!std::isnan(one.force_n)) fault.force_n = one.force_n;
  const std::vector<std::string> names = link::MotorNames(FaultPush().robot);
  fault.cable =
      static_cast<int>(std::find(names.begin(), names.end(), "inner_top_1") - names.begin());
  fault.board = 2;
  const Broken broken(fault);
  if (one.told == nullptr) {
    EXPECT_GT(broken.Counted(), 0) << "silent";
    EXPECT_EQ(broken.told, "");
  } else {
    EXPECT_TRUE(broken.Told(one.told)) << broken.told;
    EXPECT_LT(broken.first_s, 0.4) << broken.told;
  }
  EXPECT_EQ(broken.In(Mode::kImpedance), one.impedance) << broken.told;
  EXPECT_EQ(broken.In(Mode::kHold), one.hold) << broken.told;
  EXPECT_EQ(broken.In(Mode::kOff), one.off) << broken.told;
  EXPECT_EQ(broken.In(Mode::kStopped), one.stopped) << broken.told;
}

INSTANTIATE_TEST_SUITE_P(All, RobotFaults, testing::ValuesIn(kCases),
                         [](const auto& of) { return std::string(of.param.name); });

TEST(ARobot, RecoversFromAFault) {
  FaultSpec fault;
  fault.kind = FaultKind::kBrownOut;
  fault.board = 3;
  fault.for_s = 0.02;
  Broken broken(fault);
  Diagnostics found;
  EXPECT_TRUE(broken.plant->Recover(found)) << found.Format();
  broken.plant->driver().Cycle(20);
  EXPECT_EQ(broken.In(Mode::kImpedance), 6) << broken.told;
  for (const link::BoardView& board : broken.plant->heard().boards) {
    EXPECT_FALSE(board.status.faulty);
    EXPECT_FALSE(board.status.timeout);
    EXPECT_TRUE(board.status.referenced);
  }
  EXPECT_LE(broken.plant->most_n(), kLimit_n);
}

// Without a fault nothing is reported.
TEST(ARobot, IsNotSaidToBeBrokenIfItIsNot) {
  FaultSpec fault;
  fault.kind = FaultKind::kClockDrift;
  fault.board = 1;
  fault.drift_ppm = 5000;
  const Broken broken(fault);
  EXPECT_EQ(broken.told, "");
  EXPECT_EQ(broken.Counted(), 0);
  EXPECT_EQ(broken.In(Mode::kImpedance), 6);
}

}  // namespace
}  // namespace taut::virtual_robot
