/// The keys of a fault script.
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

/// An entry of `faults:`, with the keys of all kinds.
struct FaultText {
  SourceRef at;
  bool good = true;
  FaultSpec spec;
  std::optional<int> board;
  Placed cable;
  SourceRef board_at;  ///< Of the key.
};
template <class Io>
void Keys(Io& io, Like<FaultText> auto& f) {
  io.Map("fault", "faults", "One thing that goes wrong.");
  io("kind", f.spec.kind, kFaultKinds, kNeeded,
     "`clock_drift`: a board's clock is fast by `drift_ppm`. `board_loss`: a board has no power. "
     "`brown_out`: a board's supply is too low, which holds it in reset. `firmware_hang`: a "
     "board's program goes round in a circle with interrupts off. `bus_noise`: bits on the bus "
     "turn over. `bus_error`: an illegal start within the next byte on the bus. `bus_stuck`: a "
     "line of the bus is held low. `cut_cable`: a cable is cut, for good. `stuck_load_cell`: a "
     "cable's load cell shows one force. `stuck_encoder`: a motor's encoder stands. "
     "`driver_fault`: a board's motor drivers report a fault. `motor_supply_loss`: the motors of "
     "all boards have no supply, and their drivers report it. `usb_loss`: the adapter is pulled "
     "out of the computer, and forgets its mode. `host_killed`: the program on the computer is "
     "gone.");
  io("at_s", f.spec.at_s, kNeeded, Bound::kNonNegative, "When, since the robot was switched on.");
  io("for_s", f.spec.for_s, Bound::kPositive, kLimit,
     "How long; then all is as it was. For good if absent.");
  io("board", f.board, Bound{.least = 0, .most = 5}, "Which board, 0 first.");
  io("cable", f.cable, "Which cable, by its name in the model; it has to have a motor.");
  io("drift_ppm", f.spec.drift_ppm, Bound{.least = -100'000, .most = 100'000},
     "For `clock_drift`: millionths by which the clock is fast; negative: slow.");
  io("flips_per_bit", f.spec.flips_per_bit, Bound::kFraction,
     "For `bus_noise`: the probability that a bit turns over.");
  io("line", f.spec.line, kBusLines, "For `bus_stuck`: which line.");
  io("force_n", f.spec.force_n,
     "For `stuck_load_cell`: what it shows. What it showed last if absent.");
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
  io.Map("", "Fault script", "What goes wrong with a robot's electronics, and when.");
  HeadKeys(
      io, s,
      {"Name of the script. Needed unless `base` has it.", "What it is for, in a sentence or two.",
       "Another fault script, seen from this file's folder. This file then holds only what "
       "differs: each of its keys replaces the base's as a whole, except that `parameters` "
       "are merged by name.",
       R"("noisy_bus.yaml")",
       "Named numbers for expressions in this file. They may refer to each other, in any "
       "order.",
       R"({"begin_s": "0.5"})"});
  io("faults", s.faults, kNeeded, "What happens, in any order. Several may last at once.");
}

}  // namespace taut::description
