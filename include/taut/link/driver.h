/// Drives up to six motor boards over a USB-ISS: every 10 ms a broadcast and all frames back
/// (docs/hardware/driver.md). The boards' word about safety is final; the driver adds what they
/// cannot know: that one of them is gone, that another is not well, that the PC wants all to stop.
///
/// A life: `Configure` speaks to the boards and moves nothing; cycles then show what they sense;
/// `Arm`, and a cycle later `Go`, give motors power; `Off` and `Stop` take it. The destructor stops
/// motors that have power.
///
/// Threads: belongs to one at a time.
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

/// What happens to all motors when a board or a motor is not well, or a board has begun anew. (A
/// board that does not answer stops all, always.)
enum class OnFault { kHold, kOff, kStop };

struct DriverOptions {
  int motors = board::kCables;  ///< 1 .. 12.
  double period_s = 0.01;       ///< Of cycles; boards time out after 0.1 s.
  double patience_s = 0.04;     ///< For a reply while cycling.
  int lost_after = 3;           ///< Cycles without a frame: then a board is lost.
  OnFault on_fault = OnFault::kHold;
  std::vector<std::string> cables;  ///< Names for messages; "motor 3" where there is none.
};

class Driver {
 public:
  /// The port outlives it.
  Driver(Port& port, DriverOptions options);
  ~Driver();
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  // --- before cycles -----------------------------------------------------------------------------
  /// Finds adapter and boards, sets what is given and reads what their numbers mean. False, and
  /// complaints about all that is wrong: no adapter, boards that are not there or of another
  /// version, values that they refuse. Again after `Configure`: begins anew; motors that have power
  /// are turned off, or hold: then those of boards that are well do not let go of the robot, and
  /// time out meanwhile.
  enum class Meanwhile { kOff, kHold };
  bool Configure(std::span<const Setting> settings, Diagnostics& out,
                 Meanwhile meanwhile = Meanwhile::kOff);
  /// The cable of each motor has this rest length now. Motors have to be off or held. False and a
  /// complaint otherwise.
  bool SetReference(int motor, double rest_length_m, Diagnostics& out);
  Requests& requests() { return requests_; }
  const AdapterInfo& adapter() const { return adapter_info_; }
  const MotorFigures& figures(int motor) const { return figures_[At(motor)]; }

  // --- what is commanded; goes with the next broadcast -------------------------------------------
  /// Motors off, boards ready for power.
  void Arm();
  /// Power, after `Arm` and a cycle in which every board said that it is well; false, and nothing
  /// done, otherwise. `capture`: under impedance control T0 and L0 are what is measured (paper).
  bool Go(board::Mode mode, bool capture = false);
  /// By the mode: rest length [m], V0 [m/s], duty. What the wire cannot hold is cut off. A position
  /// that was not set since motors were off, or is no number, is where the motor is.
  void SetValue(int motor, double value) { values_[At(motor)] = value; }
  void Off();
  /// An emergency stop: sent alone and several times, until faults are cleared.
  void Stop(const std::string& why);
  /// With the next broadcast, which turns motors off or holds them: all faults, time-outs, stops.
  void ClearFaults();
  /// One request between cycles' frames, for gains of motors that run; `done` (may be empty) gets
  /// the answer, or nothing after three tries. One goes out a cycle.
  void Request(int board, const board::Asking& asking,
               std::function<void(const std::optional<board::Reply>&)> done = {});

  // --- cycles ------------------------------------------------------------------------------------
  /// Goes on as far as it can without waiting. True: a cycle has just ended.
  bool Poll();
  double due_s() const;          ///< When `Poll` has something to do, if no bytes come before.
  void RunUntil(double time_s);  ///< Polls and waits, by the port's clock.
  /// So many cycles; fewer if the adapter is gone, none before `Configure`.
  void Cycle(int count = 1);
  /// Runs until a cycle has ended or the port's clock reaches `time_s`; meanwhile tries to
  /// reconnect a missing adapter. Returns whether a cycle has ended.
  bool CycleBy(double time_s);
  /// Motors get power in two steps, held where they are, and then `mode`. False and a complaint if
  /// a board is not well or does not obey.
  bool Enable(board::Mode mode, bool capture, Diagnostics& out);

  const State& state() const { return state_; }
  void ForgetStatistics();  ///< What `LinkView` and frames' counts say begins anew.
  Port& port() { return port_; }
  std::string MotorName(int motor) const;

  /// After each cycle.
  std::function<void(const State&)> on_cycle;
  /// What happens, for a log: board 2 is not well, a cable's name, why all was stopped.
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
    int rest = 0;  ///< Cycles for the answer to come, before it is asked again.
  };
  /// What boards do not take for a fault, and a PC should tell all the same.
  struct CableWatch {
    int slack_cycles = 0, same_cycles = 0;
    bool slack = false, stands = false;
    int quarters = -1;        ///< The last reading of the load cell that differed from one before,
    std::int64_t counts = 0;  ///< and the encoder then.
  };

  std::size_t At(int motor) const;
  int board_count() const { return static_cast<int>(state_.boards.size()); }
  bool FindBoards(Diagnostics& out);
  bool ReadFigures(Diagnostics& out);
  void FinishCycle();  ///< So that requests do not come between its frames.
  void Watch();        ///< Chooses a broadcast that moves nothing and takes no power.

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
  /// Who was not heard in this cycle: the adapter was silent, for a moment.
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

  std::vector<Step> steps_;  ///< Of the cycle under way; those from `step_` on are to be done.
  std::size_t step_ = 0;
  bool under_way_ = false, transfer_under_way_ = false;
  double next_cycle_s_ = 0, cycle_begun_s_ = 0, reconnect_s_ = 0;
  std::vector<Waiting> waiting_;
  std::vector<bool> heard_;  ///< In this cycle, by board.
  std::vector<CableWatch> cable_watches_;
  std::vector<int> missed_;        ///< Cycles in a row, by board.
  std::vector<int> deaf_;          ///< Cycles in a row in which it took no broadcast, by board.
  std::vector<BoardView> before_;  ///< As of the cycle before.
  int unheard_in_row_ = 0;
  bool silent_in_cycle_ = false;
  double replied_s_ = 0;  ///< When the adapter did last.
};

}  // namespace taut::link
