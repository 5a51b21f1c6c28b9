/// Requests to single boards, one at a time, each waiting for its answer: who they are, what is set
/// on them, what they are to do while nothing runs.
///
/// Threads: belongs to one at a time.
#pragma once

#include <optional>

#include "taut/board/protocol.h"
#include "taut/diagnostics.h"
#include "taut/link/names.h"
#include "taut/link/usb_iss.h"

namespace taut::link {

/// What a board says of its faults when it is asked.
struct FaultReport {
  std::uint8_t motor[board::kMotors] = {};  ///< `board::MotorFault` bits.
  std::uint8_t board = 0;                   ///< `board::BoardFault` bits.
  std::uint8_t reset_cause = 0;             ///< `board::ResetCause` bits.
  bool timeout = false, stopped = false, armed = false, writes_memory = false;
  bool referenced[board::kMotors] = {};
  std::uint8_t temperature_c[board::kMotors] = {};  ///< Of the windings, computed.
};
FaultReport DecodeFaults(const board::Reply& reply);

/// Since its boot; they stay at 65535.
struct CounterReport {
  std::uint16_t bad_messages = 0, late_ticks = 0, missed_broadcasts = 0, bus_recoveries = 0;
};

class Requests {
 public:
  /// The adapter outlives it.
  explicit Requests(UsbIss& adapter) : adapter_(adapter) {}

  // Each tries three times. Nothing, or false, and a complaint if the board does not answer or
  // refuses.
  std::optional<board::Reply> Ask(int board, const board::Asking& asking, Diagnostics& out);
  std::optional<board::Info> Info(int board, Diagnostics& out);
  std::optional<FaultReport> Faults(int board, Diagnostics& out);
  std::optional<CounterReport> Counters(int board, Diagnostics& out);
  std::optional<float> Get(const ParameterPlace& place, Diagnostics& out);
  bool Set(const Setting& setting, Diagnostics& out);
  /// `nonce`: of the boot that it is meant for (`board::Info`).
  bool Do(int board, board::Action action, std::uint16_t nonce, Diagnostics& out);
  bool SetReference(int motor, std::int32_t counts, std::uint16_t nonce, Diagnostics& out);
  /// Until the EEPROM has taken what `kStore` asked for.
  bool WaitForMemory(int board, Diagnostics& out);

  /// As of the last broadcast that the board took; nothing: no whole frame came.
  std::optional<board::Status> ReadStatus(int board);

  UsbIss& adapter() { return adapter_; }

 private:
  UsbIss& adapter_;
};

}  // namespace taut::link
