/// Keys of fault scripts.
#pragma once

#include <string>
#include <vector>

#include "description/yaml/head_keys.h"
#include "description/yaml/keys.h"
#include "taut/faults.h"

namespace taut::description {

inline const Choices<FaultKind> kFaultKinds{{"clock_drift", FaultKind::kClockDrift},
                                            {"board_loss", FaultKind::kBoardLoss},
                                            {"brown_out", FaultKind::kBrownOut},
                                            {"firmware_hang", FaultKind::kFirmwareHang},
                                            {"bus_noise", FaultKind::kBusNoise},
                                            {"bus_error", FaultKind::kBusError},
                                            {"bus_stuck", FaultKind::kBusStuck},
                                            {"cut_cable", FaultKind::kCutCable},
                                            {"stuck_load_cell", FaultKind::kStuckLoadCell},
                                            {"stuck_encoder", FaultKind::kStuckEncoder},
                                            {"driver_fault", FaultKind::kDriverFault},
                                            {"motor_supply_loss", FaultKind::kMotorSupplyLoss},
                                            {"usb_loss", FaultKind::kUsbLoss},
                                            {"host_killed", FaultKind::kHostKilled}};
inline const Choices<BusLine> kBusLines{{"data", BusLine::kData}, {"clock", BusLine::kClock}};

/// Entry of `faults:`, with the keys of all kinds of faults.
struct FaultText {
  SourceRef at;
  bool good = true;
  FaultSpec spec;
  std::optional<int> board;
  Placed cable;
  SourceRef board_at;  ///< Position of the key.
};
template <class Io>
void Keys(Io& io, Like<FaultText> auto& f) {
  io.Map("fault", "faults", "Fault at a given time.");
  io("kind", f.spec.kind, kFaultKinds, kNeeded,
     "`clock_drift`: a board's clock is fast by `drift_ppm`. `board_loss`: a board loses power. "
     "`brown_out`: low supply voltage holds a board in reset. `firmware_hang`: a board's firmware "
     "hangs in a loop with interrupts off. `bus_noise`: bits on the bus flip. `bus_error`: an "
     "illegal start condition occurs within the next byte on the bus. `bus_stuck`: a line of the "
     "bus is held low. "
     "`cut_cable`: a cable is cut, permanently. `stuck_load_cell`: a cable's load cell reads a "
     "constant force. `stuck_encoder`: a motor's encoder stops counting. `driver_fault`: a board's "
     "motor drivers report a fault. `motor_supply_loss`: the motors of all boards lose their "
     "supply, and their drivers report it. `usb_loss`: the adapter is unplugged from the computer "
     "and loses its configured mode. `host_killed`: the program on the computer ends.");
  io("at_s", f.spec.at_s, kNeeded, Bound::kNonNegative,
     "Start time of the fault, measured from when the robot was switched on.");
  io("for_s", f.spec.for_s, Bound::kPositive, kLimit,
     "Duration, after which the previous state returns. Default: permanent.");
  io("board", f.board, Bound{.least = 0, .most = 5}, "Number of the board, from 0.");
  io("cable", f.cable, "Name of a cable with a motor.");
  io("drift_ppm", f.spec.drift_ppm, Bound{.least = -100'000, .most = 100'000},
     "Clock error for `clock_drift` in parts per million. Positive: the clock is fast; negative: "
     "it is slow.");
  io("flips_per_bit", f.spec.flips_per_bit, Bound::kFraction,
     "Probability of a bit flip for `bus_noise`.");
  io("line", f.spec.line, kBusLines, "Bus line for `bus_stuck`.");
  io("force_n", f.spec.force_n, "Reading for `stuck_load_cell`. Default: the last reading.");
}
void Check(const MapReader& map, FaultText& fault);

struct FaultsForm {
  static constexpr const char* kSchema = R"("const": "faults")";
};
struct FaultFileText {
  Head<FaultsForm> head;
  std::string name, description;
  std::vector<FaultText> faults;
};
template <class Io>
void Keys(Io& io, Like<FaultFileText> auto& s) {
  io.Map("", "Fault script",
         "A fault script defines faults of a robot's electronics and their times.");
  HeadKeys(
      io, s,
      {"Name of the script. Required unless the `base` file has it.",
       "Purpose of the script, in a sentence or two.",
       "Another fault script to inherit from, relative to this file's folder. Each key of this "
       "file replaces the whole key of the base, except that `parameters` are merged by name.",
       R"("noisy_bus.yaml")",
       "Named numbers for expressions in this file. Parameters may refer to each other, in any "
       "order.",
       R"({"begin_s": "0.5"})"});
  io("faults", s.faults, kNeeded, "Faults, in any order. Several may act at once.");
}

}  // namespace taut::description
