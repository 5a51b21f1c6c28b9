// Fuzz target of a motor board: valid and damaged messages on its bus, sensor readings, late ticks,
// completed memory accesses. After every tick its duties are within their limits, unarmed motors
// have no power, and its status is a valid frame of this board.
#include <cmath>
#include <cstring>

#include "fuzz/fuzz_folder.h"
#include "taut/board/board.h"

namespace taut::board {
namespace {

using fuzz::Must;

constexpr int kMaxTicks = 300;       // maximum number of ticks of an input
constexpr std::uint8_t kNobody = 7;  // number of a board without one

/// Draws from the first byte to the last; zeros follow.
class Draw {
 public:
  Draw(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}
  bool Ended() const { return at_ == end_; }
  std::uint8_t Byte() { return Ended() ? std::uint8_t{0} : *at_++; }
  std::uint16_t Word() {
    const std::uint8_t low = Byte();
    return static_cast<std::uint16_t>(low | Byte() << 8);
  }
  std::uint32_t Long() {
    const std::uint32_t low = Word();
    return low | static_cast<std::uint32_t>(Word()) << 16;
  }

 private:
  const std::uint8_t* at_;
  const std::uint8_t* const end_;
};

/// Checks that a message with a correct checksum is unchanged after decoding and encoding.
void CheckMessage(const std::uint8_t* bytes, std::size_t size, bool to_all) {
  if (!to_all) {
    Asking asking;
    if (Decode(bytes, size, asking) != Decoded::kGood) return;
    std::uint8_t again[kDoSize];
    Must(Encode(asking, again) == size && std::memcmp(again, bytes, size) == 0,
         "a request that was understood is the same again");
    return;
  }
  Cyclic all;
  for (std::uint8_t b = 0; b < kBoards; ++b) {
    Command part;
    if (Decode(bytes, size, static_cast<std::uint8_t>(kMotors * b), part) != Decoded::kGood) {
      Must(b == 0, "all boards take a broadcast, or none");
      return;
    }
    Must(!IsStop(bytes, size), "an emergency stop is no broadcast");
    all.sequence = part.sequence;
    all.mode = part.mode;
    all.capture = part.capture;
    all.clear_faults = part.clear_faults;
    all.zero_inputs = part.zero_inputs;
    all.arm = part.arm;
    for (std::uint8_t m = 0; m < kMotors; ++m) all.values[kMotors * b + m] = part.values[m];
  }
  std::uint8_t again[kCyclicSize];
  Encode(all, again);
  Must(std::memcmp(again, bytes, size) == 0, "a broadcast that was understood is the same again");
}

class Life {
 public:
  Life(const std::uint8_t* data, std::size_t size) : draw_(data, size) {
    Boot boot;
    const std::uint8_t kind = draw_.Byte();
    boot.board = kind % 8 < kBoards ? kind % 8 : kNobody;
    boot.parameters_good = (kind & 8) == 0;
    boot.reset_cause = kind >> 4;
    boot.nonce = 1;
    SetDefaults(board_.parameters);
    Start(boot, board_);
    CheckParameters();
  }

  void Go() {
    while (!draw_.Ended() && ticks_ < kMaxTicks) {
      switch (draw_.Byte() % 8) {
        case 0:
        case 1:
          Broadcast();
          break;
        case 2:
          Request();
          break;
        case 3:
          Bytes();
          break;
        case 4:
          Readings();
          break;
        case 5:
          Memorise();
          break;
        case 6:
          board_.reply_due = false;  // the reply was read
          break;
        default:
          Ticks(draw_.Byte() % 64, 1);
          Ticks(1, draw_.Byte());  // late
      }
      Ticks(1, 1);
    }
  }

 private:
  /// Delivers a message like the bus: no byte behind it belongs to the board.
  void Deliver(const std::uint8_t* bytes, std::size_t size, bool to_all) {
    const std::vector<std::uint8_t> message(bytes, bytes + size);
    CheckMessage(message.data(), size, to_all);
    Receive(message.data(), size, to_all, board_);
    CheckParameters();
    CheckFrame();
  }

  void Broadcast() {
    const std::uint8_t what = draw_.Byte();
    Cyclic say;
    say.sequence = ++sequence_;
    say.mode = static_cast<Mode>(what % 8 % 5);
    say.capture = (what & 8) != 0;
    say.clear_faults = (what & 16) != 0;
    say.zero_inputs = (what & 32) != 0;
    say.arm = static_cast<Arm>((what >> 6) % 3);
    for (std::int16_t& value : say.values) value = static_cast<std::int16_t>(sequence_ << 8);
    const std::size_t own = board_.boot.board % kBoards * kMotors;
    for (std::size_t m = 0; m < kMotors; ++m) {
      say.values[own + m] = static_cast<std::int16_t>(draw_.Word());
    }
    std::uint8_t frame[kCyclicSize];
    Encode(say, frame);
    Deliver(frame, sizeof frame, true);
  }

  /// Sends a request with a correct checksum, mostly a correct nonce, and range ends as half of the
  /// values.
  void Request() {
    const std::uint8_t what = draw_.Byte();
    Asking asking;
    asking.request = static_cast<board::Request>(0xd1 + what % 3);
    asking.index = (what >> 2) % 4;
    asking.nonce = (what & 16) != 0 ? draw_.Word() : board_.boot.nonce;
    asking.what = draw_.Byte();
    if (asking.request == board::Request::kDo) asking.what = 0xe0 | (asking.what & 7);
    const Range range = asking.index < kMotors ? MotorRange(asking.what) : BoardRange(asking.what);
    asking.value = (what & 32) != 0   ? draw_.Long()
                   : (what & 64) != 0 ? internal::ToBits(range.least)
                                      : internal::ToBits(range.greatest);
    const Parameters before = board_.parameters;
    std::uint8_t frame[kDoSize];
    Deliver(frame, Encode(asking, frame), false);
    Must(board_.reply_due, "a request is answered");
    if (asking.request == board::Request::kAsk || board_.reply.answer != Answer::kGood) {
      Must(std::memcmp(&before, &board_.parameters, sizeof before) == 0,
           "parameters stay what they are");
    } else if (asking.request == board::Request::kSet) {
      const float* const at = internal::ParameterAt(board_, asking.what, asking.index);
      Must(at != nullptr && internal::ToBits(*at) == asking.value, "a parameter is what was set");
    }
  }

  /// Sends arbitrary bytes, some of them with a correct checksum.
  void Bytes() {
    const std::uint8_t how = draw_.Byte();
    std::uint8_t bytes[kMaxMessageSize];
    const std::size_t size = draw_.Byte() % (kMaxMessageSize + 1);
    for (std::size_t i = 0; i < size; ++i) bytes[i] = draw_.Byte();
    if (how % 4 == 1 && size >= 4) {  // an emergency stop, or nearly one
      bytes[0] = kStopHead;
      bytes[1] = 'S';
      bytes[2] = 'T';
    }
    if ((how & 4) != 0 && size > 2) board::internal::Seal16(bytes, size);
    if ((how & 8) != 0 && size > 1) bytes[size - 1] = Crc8(bytes, size - 1);
    Deliver(bytes, size, (how & 16) != 0);
  }

  void Readings() {
    const std::uint8_t how = draw_.Byte();
    frozen_ = (how & 1) != 0;
    driver_fault_ = (how & 6) == 6;
    for (std::size_t m = 0; m < kMotors; ++m) {
      adc_[m] = draw_.Word() % 1024;
      const std::uint16_t step = draw_.Word();
      step_[m] = (how & 8) != 0 ? step : static_cast<std::uint16_t>(step % 64 - 32);
    }
  }

  /// Completes a memory access like the chip: parameters are stored, or loaded (here: the
  /// defaults).
  void Memorise() {
    if (board_.memory == Memory::kLoad) {
      SetDefaults(board_.parameters);
      Prepare(board_);
    }
    board_.memory = Memory::kIdle;
  }

  void Ticks(int count, std::uint8_t elapsed) {
    for (int i = 0; i < count && ticks_ < kMaxTicks; ++i, ++ticks_) {
      Inputs in{};
      in.elapsed = elapsed > 0 ? elapsed : std::uint8_t{1};
      in.driver_fault = driver_fault_;
      for (std::size_t m = 0; m < kMotors; ++m) {
        encoder_[m] = static_cast<std::uint16_t>(encoder_[m] + step_[m]);
        in.encoder[m] = encoder_[m];
        // no converter repeats the same number
        in.adc[m] = static_cast<std::uint16_t>(adc_[m] ^ (frozen_ ? 0 : ticks_ % 2));
      }
      const Before before(board_);
      Tick(in, board_);
      CheckTick(before);
      Feel(board_);
      if (board_.mode != before.mode) CheckParameters();  // some may have been captured
      if (ticks_ % 4 == 0) CheckFrame();
      DoSlowWork(board_);
      for (const Watch& watch : board_.watches) {
        Must(std::isfinite(watch.winding_rise_k) && std::isfinite(watch.housing_rise_k),
             "temperatures are numbers");
      }
    }
  }

  /// State of a board before a tick, for the checks after it.
  struct Before {
    explicit Before(const Board& board)
        : mode(board.mode),
          powered(IsPowered(board)),
          may_go(board.ready || board.armed),
          told(board.command_due),
          board_faults(board.board_faults),
          width{board.loops[0].width, board.loops[1].width} {}
    Mode mode;
    bool powered, may_go, told;
    std::uint8_t board_faults;
    std::int16_t width[kMotors];
  };

  void CheckTick(const Before& before) const {
    const Board& now = board_;
    const bool powered = IsPowered(now);
    const bool taken = before.told;
    Must(!now.command_due, "a tick does what it was told");
    Must(!powered || (now.armed && !now.stopped && (now.board_faults & kDriverFault) == 0),
         "what has power is armed, and neither stopped nor its driver faulty");
    if (powered && !before.powered) {
      const Command& command = now.command;
      Must(taken && command.arm == Arm::kGo && command.mode != Mode::kOff && before.may_go &&
               IsHealthy(now),
           "power comes by a command to a healthy board, in two steps");
    }
    Must(before.mode == Mode::kOff || now.mode == before.mode || taken || now.mode == Mode::kOff ||
             now.mode == Mode::kHold,
         "of its own accord a board holds, or is off");
    const int told = before.board_faults & now.board_faults;  // refusals are new in this tick
    if (now.faults[0] != 0 || now.faults[1] != 0 || told != 0) {
      Must(!powered || now.mode == Mode::kHold, "who is not well holds, or is off");
    }
    if (powered && now.heard && now.silence >= kTimeoutTicks && !taken) {
      Must(now.timeout && (now.mode == Mode::kHold || now.mode == Mode::kImpedance),
           "who hears nothing holds");
    }
    for (std::size_t m = 0; m < kMotors; ++m) {
      const MotorLoop& motor = now.loops[m];
      const float most = now.parameters.motor[m][kDutyLimit] * float{kFullWidth};
      Must(std::isfinite(motor.drive) && std::isfinite(motor.set_point_n) &&
               std::isfinite(motor.pid.integral) && std::isfinite(motor.pid.error_before) &&
               std::isfinite(motor.tension_counts) && std::isfinite(motor.counts_per_tick),
           "a motor's numbers are numbers");
      // A control law that takes over keeps the duties during this tick.
      const bool stays = taken && motor.width == before.width[m];
      Must(stays || motor.width == static_cast<std::int16_t>(motor.drive),
           "the duty is what was decided");
      Must(stays || std::abs(motor.drive) <= most, "a duty is within its limit");
      Must(powered || (motor.drive == 0 && motor.width == 0), "without power there is no duty");
      Must(stays || motor.drive <= 0 || motor.tension_counts < now.numbers[m].limit_counts,
           "at the limit of tension nothing is wound in");
      if (now.faults[m] == 0) continue;
      Must(motor.width == 0 || ((now.faults[m] & kOverTension) != 0 && motor.width < 0 &&
                                motor.width >= -3 * kFullWidth / 10),
           "a motor that is not well brakes, or pays out because it pulls too much");
    }
  }

  /// Checks the parameters; after a capture, L0 is a measured value.
  void CheckParameters() const {
    for (std::uint8_t m = 0; m < kMotors; ++m) {
      const float* const p = board_.parameters.motor[m];
      for (std::uint8_t i = 0; i < kMotorParameters; ++i) {
        Must(i == kLengthOffset ? std::isfinite(p[i]) : IsWithin(MotorRange(i), p[i]),
             "a motor's parameter is in its range");
      }
      const LoopNumbers numbers = NumbersOf(p);
      Must(std::memcmp(&numbers, &board_.numbers[m], sizeof numbers) == 0,
           "what a loop uses follows from its parameters");
      Must(LimitsOf(p).over_counts == board_.limits[m].over_counts &&
               LimitsOf(p).stall_width == board_.limits[m].stall_width,
           "what is watched follows from the parameters");
    }
    for (std::uint8_t i = 0; i < kBoardParameters; ++i) {
      Must(IsWithin(BoardRange(i), board_.parameters.board[i]),
           "a board's parameter is in its range");
    }
  }

  void CheckFrame() {
    std::uint8_t frame[kFrameSize];
    std::uint8_t again[kFrameSize];
    MakeFrame(board_, frame);
    Must(IsFrame(frame, sizeof frame, board_.boot.board), "a frame is of the board that says it");
    for (std::uint8_t b = 0; ticks_ % 16 == 0 && b <= kNobody; ++b) {
      Must(b == board_.boot.board || !IsFrame(frame, sizeof frame, b), "a frame is of one board");
    }
    Must(IsReply(frame) == board_.reply_due, "a frame is a reply while one is due");
    if (IsReply(frame)) {
      Encode(DecodeReply(frame), board_.boot.board, again);
    } else {
      Encode(DecodeStatus(frame), board_.boot.board, again);
      Must(DecodeStatus(frame).mode == (board_.stopped ? Mode::kStopped : board_.mode),
           "a status says the mode");
    }
    Must(std::memcmp(frame, again, sizeof frame) == 0, "a frame that is understood is the same");
  }

  Draw draw_;
  Board board_{};
  std::uint16_t adc_[kMotors] = {100, 100}, encoder_[kMotors] = {0, 0}, step_[kMotors] = {0, 0};
  bool frozen_ = false, driver_fault_ = false;
  std::uint8_t sequence_ = 0;
  int ticks_ = 0;
};

}  // namespace
}  // namespace taut::board

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  taut::board::Life(data, size).Go();
  return 0;
}
