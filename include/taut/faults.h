/// Fault scripts: what goes wrong with a robot's electronics, and when
/// (docs/hardware/virtual_robot.md).
///
/// Threads: any number may read scripts at once.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut {

enum class FaultKind {
  kClockDrift,       ///< A board's crystal is fast or slow.
  kBoardLoss,        ///< A board loses power.
  kBrownOut,         ///< A board is held in reset.
  kFirmwareHang,     ///< A board's program hangs with interrupts off.
  kBusNoise,         ///< Bits on the bus turn over.
  kBusError,         ///< An illegal start within the next byte on the bus.
  kBusStuck,         ///< A line of the bus is held low.
  kCutCable,         ///< A cable is cut, for good.
  kStuckLoadCell,    ///< A load cell shows one force whatever it feels.
  kStuckEncoder,     ///< An encoder stands whatever the shaft does.
  kDriverFault,      ///< The motor drivers of a board say that something is wrong.
  kMotorSupplyLoss,  ///< The supply of all motors is off; the boards keep theirs.
  kUsbLoss,          ///< The adapter is pulled out of the computer.
  kHostKilled        ///< The program on the computer is gone.
};

enum class BusLine { kData, kClock };

struct FaultSpec {
  FaultKind kind = FaultKind::kClockDrift;
  double at_s = 0;
  double for_s = std::numeric_limits<double>::infinity();  ///< Then all is as it was.
  int board = -1;                                          ///< Of those that concern one board.
  int cable = -1;  ///< Index in the actuated cables, in the model's order.
  double drift_ppm = 0;
  double flips_per_bit = 0;
  BusLine line = BusLine::kData;
  std::optional<double> force_n{};  ///< Of a stuck load cell; what it showed last if there is none.
};

struct FaultScript {
  std::string name, description;
  std::vector<FaultSpec> faults;   ///< As in the file.
  std::vector<std::string> files;  ///< That were read, the script first.
};

/// Names of the kinds, as files spell them.
const char* FaultName(FaultKind kind);

/// Reads a fault script for a robot with these actuated cables, two of them a board. Returns
/// nothing if there was any error.
std::optional<FaultScript> LoadFaults(const std::string& path,
                                      const std::vector<std::string>& cables, Diagnostics& out);

}  // namespace taut
