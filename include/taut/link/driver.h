/// Driver for up to six motor boards over a USB-ISS: in each cycle of 10 ms, sends a broadcast and
/// reads a frame from each board (docs/hardware/driver.md). The boards have the final decision on
/// safety; the driver adds reactions that a board cannot have: to the loss or fault of another
/// board, and to a stop by the PC.
///
/// Lifecycle: `Configure` addresses the boards without moving motors; then cycles update sensor
/// values; `Arm` and, a cycle later, `Go` give motors power; `Off` and `Stop` remove it. The
/// destructor stops motors that have power.
///
/// Threads: use an object from one thread at a time.
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

/// Reaction of all motors to a fault of a board or motor, or to a restart of a board. (A board that
/// does not answer always causes a stop of all boards.)
enum class OnFault { kHold, kOff, kStop };

struct DriverOptions {
  int motors = board::kCables;  ///< 1 .. 12.
  double period_s = 0.01;       ///< Of cycles; boards time out after 0.1 s.
  double patience_s = 0.04;     ///< Timeout of a reply in cycles.
  int lost_after = 3;           ///< Cycles without a frame after which a board counts as lost.
  OnFault on_fault = OnFault::kHold;
  std::vector<std::string> cables;  ///< Names for messages; without a name, "motor 3".
};

class Driver {
 public:
  /// The port must outlive the driver.
  Driver(Port& port, DriverOptions options);
  ~Driver();
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  // --- before cycles -----------------------------------------------------------------------------
  /// Identifies adapter and boards, sets parameters and reads the scales of the boards' numbers.
  /// Returns false, with errors about all problems: no adapter, boards that are missing or have
  /// another protocol or parameter version, refused values. May be called again and then restarts
  /// the driver; motors with power are turned off or, with kHold, hold: boards without faults then
  /// keep holding the robot, and time out meanwhile.
  enum class Meanwhile { kOff, kHold };
  bool Configure(std::span<const Setting> settings, Diagnostics& out,
                 Meanwhile meanwhile = Meanwhile::kOff);
  /// Sets the reference of a motor's encoder: the present rest length of its cable [m]. Motors must
  /// be off or holding; otherwise returns false, with an error.
  bool SetReference(int motor, double rest_length_m, Diagnostics& out);
  Requests& requests() { return requests_; }
  const AdapterInfo& adapter() const { return adapter_info_; }
  const MotorFigures& figures(int motor) const { return figures_[At(motor)]; }

  // --- commands, sent with the next broadcast ----------------------------------------------------
  /// Turns motors off and makes boards ready for power.
  void Arm();
  /// Gives motors power, after `Arm` and a cycle in which every board reported no fault; otherwise
  /// returns false without an effect. `capture`: under impedance control, measured values become T0
  /// and L0 (paper).
  bool Go(board::Mode mode, bool capture = false);
  /// Sets the command of a motor according to the mode: rest length [m], V0 [m/s], duty. Values are
  /// clipped to the range of the message. A position that is not finite, or not set since motors
  /// were off, is the motor's present position.
  void SetValue(int motor, double value) { values_[At(motor)] = value; }
  /// Turns motors off.
  void Off();
  /// Sends an emergency stop, alone and several times, until faults are cleared.
  void Stop(const std::string& why);
  /// Clears all faults, timeouts and stops with the next broadcast, which turns motors off or, in
  /// mode kHold, holds them.
  void ClearFaults();
  /// Queues a request to a board in the next cycles, such as for a gain of a running motor. `done`
  /// (may be empty) is called with the reply, or with nothing after three tries. At most one
  /// request is sent per cycle.
  void Request(int board, const board::Asking& asking,
               std::function<void(const std::optional<board::Reply>&)> done = {});

  // --- cycles ------------------------------------------------------------------------------------
  /// Continues the cycle as far as possible without waiting. Returns true if a cycle has just
  /// ended.
  bool Poll();
  double due_s() const;          ///< Time of the next work for `Poll` if no bytes arrive before.
  void RunUntil(double time_s);  ///< Polls and waits until a time of the port's clock.
  /// Runs `count` cycles; fewer if the adapter is lost, none before `Configure`.
  void Cycle(int count = 1);
  /// Runs until a cycle has ended or the port's clock reaches `time_s`; meanwhile tries to
  /// reconnect a missing adapter. Returns whether a cycle has ended.
  bool CycleBy(double time_s);
  /// Gives motors power in two steps, first holding their positions, then in `mode`. Returns false,
  /// with an error, if a board has a fault or does not follow.
  bool Enable(board::Mode mode, bool capture, Diagnostics& out);

  const State& state() const { return state_; }
  void ForgetStatistics();  ///< Resets `LinkView` and the counts of frames.
  Port& port() { return port_; }
  std::string MotorName(int motor) const;

  /// Called after each cycle.
  std::function<void(const State&)> on_cycle;
  /// Called with the text of an event for a log, such as a fault of a board or cable, or the reason
  /// of a stop.
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
    int rest = 0;  ///< Cycles to wait for the answer before the next try.
  };
  /// Monitoring of a cable for conditions that boards do not detect as faults.
  struct CableWatch {
    int slack_cycles = 0, same_cycles = 0;
    bool slack = false, stands = false;
    int quarters = -1;        ///< Last changed reading of the load cell,
    std::int64_t counts = 0;  ///< and the encoder's count at that time.
  };

  std::size_t At(int motor) const;
  int board_count() const { return static_cast<int>(state_.boards.size()); }
  bool FindBoards(Diagnostics& out);
  bool ReadFigures(Diagnostics& out);
  void FinishCycle();  ///< So that requests are not sent between its frames.
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
  /// Returns whether boards without a reply in this cycle are excused: the adapter was briefly
  /// silent.
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

  std::vector<Step> steps_;  ///< Of the present cycle; remaining from `step_` on.
  std::size_t step_ = 0;
  bool under_way_ = false, transfer_under_way_ = false;
  double next_cycle_s_ = 0, cycle_begun_s_ = 0, reconnect_s_ = 0;
  std::vector<Waiting> waiting_;
  std::vector<bool> heard_;  ///< In this cycle, per board.
  std::vector<CableWatch> cable_watches_;
  std::vector<int> missed_;        ///< Consecutive cycles without a frame, per board.
  std::vector<int> deaf_;          ///< Consecutive cycles without an applied broadcast, per board.
  std::vector<BoardView> before_;  ///< From the previous cycle.
  int unheard_in_row_ = 0;
  bool silent_in_cycle_ = false;
  double replied_s_ = 0;  ///< Time of the adapter's last reply.
};

}  // namespace taut::link
