/// Requests to single boards outside of cycles: identification, parameters, actions. Each request
/// waits for its reply.
///
/// Threads: only one thread at a time may use an object.
#pragma once

#include <optional>

#include "taut/board/protocol.h"
#include "taut/diagnostics.h"
#include "taut/link/names.h"
#include "taut/link/usb_iss.h"

namespace taut::link {

/// Faults of a board and its motors.
struct FaultReport {
  std::uint8_t motor[board::kMotors] = {};  ///< `board::MotorFault` bits.
  std::uint8_t board = 0;                   ///< `board::BoardFault` bits.
  std::uint8_t reset_cause = 0;             ///< `board::ResetCause` bits.
  bool timeout = false, stopped = false, armed = false, writes_memory = false;
  bool referenced[board::kMotors] = {};
  std::uint8_t temperature_c[board::kMotors] = {};  ///< Computed winding temperatures.
};
/// Decodes the reply to a request for faults.
FaultReport DecodeFaults(const board::Reply& reply);

/// Counters of a board since its boot; each saturates at 65535.
struct CounterReport {
  std::uint16_t bad_messages = 0, late_ticks = 0, missed_broadcasts = 0, bus_recoveries = 0;
};

class Requests {
 public:
  /// `adapter` must outlive the object.
  explicit Requests(UsbIss& adapter) : adapter_(adapter) {}

  // Each function tries three times. If the board does not answer or rejects the request, it
  // returns nothing or false and adds an error.
  std::optional<board::Reply> Ask(int board, const board::Asking& asking, Diagnostics& out);
  std::optional<board::Info> Info(int board, Diagnostics& out);
  std::optional<FaultReport> Faults(int board, Diagnostics& out);
  std::optional<CounterReport> Counters(int board, Diagnostics& out);
  std::optional<float> Get(const ParameterPlace& place, Diagnostics& out);
  bool Set(const Setting& setting, Diagnostics& out);
  /// Performs an action. `nonce`: boot number of the board (`board::Info`).
  bool Do(int board, board::Action action, std::uint16_t nonce, Diagnostics& out);
  bool SetReference(int motor, std::int32_t counts, std::uint16_t nonce, Diagnostics& out);
  /// Waits at most 2 s until the EEPROM has stored the parameters after `kStore`.
  bool WaitForMemory(int board, Diagnostics& out);

  /// Returns the status of the board as of its last applied broadcast; nothing without a valid
  /// frame.
  std::optional<board::Status> ReadStatus(int board);

  UsbIss& adapter() { return adapter_; }

 private:
  UsbIss& adapter_;
};

}  // namespace taut::link
