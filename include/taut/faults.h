/// Fault injection scripts: faults of a robot's electronics against time
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
  kClockDrift,       ///< A board's clock runs fast or slow.
  kBoardLoss,        ///< A board loses power.
  kBrownOut,         ///< Low supply voltage holds a board in reset.
  kFirmwareHang,     ///< A board's firmware hangs with interrupts off.
  kBusNoise,         ///< Bits on the bus flip.
  kBusError,         ///< An illegal start within the next byte on the bus.
  kBusStuck,         ///< A line of the bus is held low.
  kCutCable,         ///< A cable is cut, permanently.
  kStuckLoadCell,    ///< A load cell reads a constant force.
  kStuckEncoder,     ///< An encoder stops counting.
  kDriverFault,      ///< The motor drivers of a board report a fault.
  kMotorSupplyLoss,  ///< All motors lose their supply; the boards keep theirs.
  kUsbLoss,          ///< The adapter is unplugged from the computer.
  kHostKilled        ///< The program on the computer ends.
};

enum class BusLine { kData, kClock };

struct FaultSpec {
  FaultKind kind = FaultKind::kClockDrift;
  double at_s = 0;
  /// Duration, after which the previous state returns.
  double for_s = std::numeric_limits<double>::infinity();
  int board = -1;  ///< Index of the board, for faults of one board.
  int cable = -1;  ///< Index among the actuated cables, in the model's order.
  double drift_ppm = 0;
  double flips_per_bit = 0;  ///< Probability.
  BusLine line = BusLine::kData;
  std::optional<double> force_n{};  ///< Reading of a stuck load cell. Absent: the last reading.
};

struct FaultScript {
  std::string name, description;
  std::vector<FaultSpec> faults;   ///< In the order of the file.
  std::vector<std::string> files;  ///< All files read, the script first.
};

/// Returns the name of a kind as used in files.
const char* FaultName(FaultKind kind);

/// Reads a fault script for a robot whose actuated cables are `cables`, two per board. Returns
/// nothing, and adds diagnostics, on any error.
std::optional<FaultScript> LoadFaults(const std::string& path,
                                      const std::vector<std::string>& cables, Diagnostics& out);

}  // namespace taut
