/// Fault injection scripts: electronic faults of a robot against time
/// (docs/hardware/virtual_robot.md).
///
/// Threads: any number may read scripts concurrently.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut {

enum class FaultKind {
  kClockDrift,       ///< The clock of a board is fast or slow.
  kBoardLoss,        ///< A board has no power.
  kBrownOut,         ///< Low supply voltage holds a board in reset.
  kFirmwareHang,     ///< The firmware of a board hangs with interrupts disabled.
  kBusNoise,         ///< Bits on the bus flip.
  kBusError,         ///< An illegal start condition within the next byte on the bus.
  kBusStuck,         ///< A line of the bus is held low.
  kCutCable,         ///< A cable is cut permanently.
  kStuckLoadCell,    ///< A load cell reads a constant force.
  kStuckEncoder,     ///< An encoder stops counting.
  kDriverFault,      ///< The motor drivers of a board report a fault.
  kMotorSupplyLoss,  ///< All motors lose their supply; the boards keep power.
  kUsbLoss,          ///< The adapter is unplugged from the computer.
  kHostKilled        ///< The program on the computer ends.
};

enum class BusLine { kData, kClock };

struct FaultSpec {
  FaultKind kind = FaultKind::kClockDrift;
  double at_s = 0;
  /// Duration of the fault.
  double for_s = std::numeric_limits<double>::infinity();
  int board = -1;  ///< Index of the affected board, for faults of one board.
  int cable = -1;  ///< Index of the affected cable among the actuated cables, in model order.
  double drift_ppm = 0;
  double flips_per_bit = 0;  ///< Probability of a flip per bit.
  BusLine line = BusLine::kData;
  std::optional<double> force_n{};  ///< Reading of a stuck load cell; absent: the last reading.
};

struct FaultScript {
  std::string name, description;
  std::vector<FaultSpec> faults;   ///< Faults in file order.
  std::vector<std::string> files;  ///< All files read; the script is first.
};

/// Returns the name of a fault kind as in files.
const char* FaultName(FaultKind kind);

/// Reads a fault script for a robot with the actuated cables `cables`, two per board. On an error,
/// returns nothing and adds diagnostics.
std::optional<FaultScript> LoadFaults(const std::string& path,
                                      const std::vector<std::string>& cables, Diagnostics& out);

}  // namespace taut
