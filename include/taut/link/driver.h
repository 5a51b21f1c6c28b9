/// Driver for up to six motor boards over a USB-ISS adapter. In each cycle of 10 ms, it sends a
/// broadcast and reads a frame from each board (docs/hardware/driver.md). The boards have the final
/// decision on safety. The driver adds reactions that a board alone cannot have: to the loss or
/// fault of another board and to a stop by the PC.
///
/// Lifecycle: `Configure` identifies and configures the boards without moving motors. Cycles then
/// update sensor values. `Arm` and, one cycle later, `Go` give motors power; `Off` and `Stop`
/// remove the power. The destructor stops motors that have power.
///
/// Threads: only one thread at a time may use an object.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/link/requests.h"
#include "taut/link/state.h"

namespace taut::link {

/// Reaction of all motors to a fault of a board or motor, or to a restart of a board. A board that
/// does not answer always stops all boards.
enum class OnFault { kHold, kOff, kStop };

struct DriverOptions {
  int motors = board::kCables;  ///< Number of motors, 1 .. 12.
  double period_s = 0.01;       ///< Period of cycles. Boards time out after 0.1 s.
  double patience_s = 0.04;     ///< Timeout for replies during cycles.
  int lost_after = 3;           ///< Number of cycles without a frame until a board counts as lost.
  OnFault on_fault = OnFault::kHold;
  std::vector<std::string> cables;  ///< Names for messages; default: "motor 3".
};

class Driver {
 public:
  /// `port` must outlive the driver.
  Driver(Port& port, DriverOptions options);
  ~Driver();
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  // --- before the cycles -----------------------------------------------------------------------
  /// Identifies adapter and boards, sets parameters and reads the scales of the boards' numbers. On
  /// problems, returns false and adds an error for each: no adapter, missing boards, other protocol
  /// or parameter versions, rejected values. A repeated call restarts the driver. During a repeated
  /// call, motors with power are turned off. With kHold, motors on boards without faults hold their
  /// positions instead until these boards time out.
  enum class Meanwhile { kOff, kHold };
  bool Configure(std::span<const Setting> settings, Diagnostics& out,
                 Meanwhile meanwhile = Meanwhile::kOff);
  /// Sets the encoder reference of a motor to the present rest length of its cable [m]. Returns
  /// false and adds an error if motors are neither off nor holding.
  bool SetReference(int motor, double rest_length_m, Diagnostics& out);
  Requests& requests() { return requests_; }
  const AdapterInfo& adapter() const { return adapter_info_; }
  const MotorFigures& figures(int motor) const { return figures_[At(motor)]; }

  // --- commands, sent in the next broadcast ----------------------------------------------------
  /// Turns motors off and prepares the boards for power.
  void Arm();
  /// Gives motors power. Call it after `Arm` and a cycle in which no board reported a fault;
  /// otherwise it returns false without effect. `capture`: in impedance control, T0 and L0 become
  /// the measured values.
  bool Go(board::Mode mode, bool capture = false);
  /// Sets the command of a motor, according to the mode: rest length [m], V0 [m/s] or duty. Values
  /// are clipped to the range of the message. A position that is not finite, or was not set since
  /// the motors were off, is replaced by the present position.
  void SetValue(int motor, double value) { values_[At(motor)] = value; }
  /// Turns motors off.
  void Off();
  /// Sends an emergency stop, alone and several times. It lasts until faults are cleared.
  void Stop(const std::string& why);
  /// Clears all faults, timeouts and stops with the next broadcast. Motors are then off or, in mode
  /// kHold, hold.
  void ClearFaults();
  /// Queues a request to a board, such as a new gain of a running motor. Each cycle sends at most
  /// one request. `done` (may be empty) is called with the reply, or with nothing after three
  /// tries.
  void Request(int board, const board::Asking& asking,
               std::function<void(const std::optional<board::Reply>&)> done = {});

  // --- cycles ----------------------------------------------------------------------------------
  /// Performs the work of the cycle that is possible without waiting. Returns true if a cycle has
  /// just ended.
  bool Poll();
  double due_s() const;  ///< Time of the next work for `Poll` if no bytes arrive until then.
  void RunUntil(double time_s);  ///< Polls and waits until `time_s` on the clock of the port.
  /// Runs `count` cycles; fewer if the adapter is lost, none before `Configure`.
  void Cycle(int count = 1);
  /// Runs until a cycle ends or the clock of the port reaches `time_s`. Meanwhile, it tries to
  /// reconnect a missing adapter. Returns whether a cycle has ended.
  bool CycleBy(double time_s);
  /// Gives motors power in two steps: first they hold their positions, then they change to `mode`.
  /// Returns false and adds an error if a board has a fault or does not follow.
  bool Enable(board::Mode mode, bool capture, Diagnostics& out);

  const State& state() const { return state_; }
  void ForgetStatistics();  ///< Resets `LinkView` and the frame counters.
  Port& port() { return port_; }
  std::string MotorName(int motor) const;

  /// Called after each cycle.
  std::function<void(const State&)> on_cycle;
  /// Called with the text of an event, for a log. Events are, for example, faults of boards and
  /// cables, and stops with their reasons.
  std::function<void(double time_s, const std::string& text)> on_event;

 private:
  struct Step {
    enum class Kind { kStop, kBroadcast, kRequest, kGroup, kOne } kind;
    Bytes frame;
    ReplyShape shape;
    std::vector<int> boards{};
    int tries = 0;
  };
  struct Waiting {
    int board;
    board::Asking asking;
    std::function<void(const std::optional<board::Reply>&)> done;
    int tries = 0;
    int rest = 0;  ///< Cycles to wait before the next try.
  };
  /// Monitors a cable for conditions that boards do not report as faults.
  struct CableWatch {
    int slack_cycles = 0, same_cycles = 0;
    bool slack = false, stands = false;
    int quarters = -1;        ///< Last load cell reading that differed from the previous one.
    std::int64_t counts = 0;  ///< Encoder count at the time of `quarters`.
  };

  std::size_t At(int motor) const;
  int board_count() const { return static_cast<int>(state_.boards.size()); }
  bool FindBoards(Diagnostics& out);
  bool ReadFigures(Diagnostics& out);
  void FinishCycle();  ///< Ends the cycle, so that no request comes between its frames.
  void Watch();        ///< Selects a broadcast that neither moves motors nor changes their power.

  // driver_cycle.cpp
  void BeginCycle();
  void AddRequest();
  void AddReads();
  void EndStep(UsbIss::State how);
  void CountBad(int board, int tries);
  void TakeFrame(int board, std::span<const std::uint8_t> bytes, int tries);
  void TakeStatus(int board, const board::Status& status);
  void TakeReply(int board, const board::Reply& reply);
  void ReadAgain(int board, int tries);
  void Lost();
  bool TryReconnect();
  std::int16_t OnWire(int motor) const;
  /// Returns whether boards without a reply in this cycle are excused, because the adapter was
  /// silent for a short time.
  bool IsExcused() const;

  // driver_watch.cpp
  void EndCycle();
  void TakeFaults(int board, int index, std::uint8_t bits);
  void LookAt(int board, const BoardView& before);
  void LookAtCable(int motor);
  void Event(const std::string& text);
  void React(const std::string& why);

  Port& port_;
  DriverOptions options_;
  UsbIss adapter_;
  Requests requests_;
  AdapterInfo adapter_info_;
  std::vector<MotorFigures> figures_;
  std::vector<double> values_;
  board::Cyclic say_;
  bool clear_due_ = false;
  int stops_left_ = 0;
  State state_;

  std::vector<Step> steps_;  ///< Steps of the present cycle; those from `step_` remain.
  std::size_t step_ = 0;
  bool under_way_ = false, transfer_under_way_ = false;
  double next_cycle_s_ = 0, cycle_begun_s_ = 0, reconnect_s_ = 0;
  std::vector<Waiting> waiting_;
  std::vector<bool> heard_;  ///< Per board: whether it replied in this cycle.
  std::vector<CableWatch> cable_watches_;
  std::vector<int> missed_;        ///< Consecutive cycles without a frame, per board.
  std::vector<int> deaf_;          ///< Consecutive cycles without an applied broadcast, per board.
  std::vector<BoardView> before_;  ///< Views of the boards in the previous cycle.
  int unheard_in_row_ = 0;
  bool silent_in_cycle_ = false;
  double replied_s_ = 0;  ///< Time of the last reply from the adapter.
};

}  // namespace taut::link
