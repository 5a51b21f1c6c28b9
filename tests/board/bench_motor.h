/// Test bench with a board: two motors that wind springs fixed at their far ends, and a PC that
/// sends broadcasts. The motors are computed in closed form, so that only the board's code is under
/// test.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "taut/board/board.h"

namespace taut::board {

struct BenchMotor {
  double stiffness_n_per_m = 227, speed_m_per_s = 0.07, time_constant_s = 0.0084;
  double stall_n = 67;
  double wound_m = 0.05;  ///< Stretch of the spring; negative: slack.
  double speed_now_m_per_s = 0;
  double encoder_sign = 1;
  bool cut = false, blocked = false;
  int adc_stuck = -1;  ///< >= 0: a constant reading.

  double Tension() const { return cut ? 0.0 : std::max(0.0, stiffness_n_per_m * wound_m); }
  void Advance(double duty, bool powered, double h) {
    const double free = powered ? duty * speed_m_per_s : 0.0;
    const double load = powered ? Tension() / stall_n * speed_m_per_s * 0.5 : 0.0;
    speed_now_m_per_s += h / time_constant_s * (free - load - speed_now_m_per_s);
    if (blocked) speed_now_m_per_s = 0;
    wound_m += h * speed_now_m_per_s;
  }
  std::uint16_t Adc() const {
    if (adc_stuck >= 0) return static_cast<std::uint16_t>(adc_stuck);
    return static_cast<std::uint16_t>(
        std::clamp(std::floor(31.5 + Tension() / 0.1567), 0.0, 741.0));
  }
  std::uint16_t Encoder() const {
    return static_cast<std::uint16_t>(
        static_cast<std::int64_t>(std::floor(encoder_sign * wound_m / 1.34e-5)));
  }
};

class Bench {
 public:
  explicit Bench(const Boot& boot = Boot()) {
    SetDefaults(board.parameters);
    Start(boot, board);
    for (int m = 0; m < kMotors; ++m) {  // the encoder's counter is 0 at the board's start
      board.loops[m].encoder = motors[m].Encoder();
      board.loops[m].tension_counts = motors[m].Adc();
    }
  }

  /// Steps one millisecond.
  void Step(std::uint8_t elapsed = 1) {
    Inputs in{};
    in.elapsed = elapsed;
    in.driver_fault = driver_fault;
    for (int m = 0; m < kMotors; ++m) {
      in.adc[m] = motors[m].Adc();
      in.encoder[m] = motors[m].Encoder();
    }
    Tick(in, board);
    Feel(board);
    DoSlowWork(board);
    for (int m = 0; m < kMotors; ++m) {
      for (int i = 0; i < 10; ++i) {
        motors[m].Advance(board.loops[m].width / double{kFullWidth}, IsPowered(board), 1e-4);
      }
      most_n = std::max(most_n, motors[m].Tension());
    }
    ++ms;
  }
  void Send(const Cyclic& message) {
    std::uint8_t frame[kCyclicSize];
    Encode(message, frame);
    Receive(frame, sizeof frame, true, board);
  }
  /// Broadcasts the contents of `say` with the next sequence number.
  void Say() {
    ++say.sequence;
    Send(say);
    say.clear_faults = false;
  }
  /// Steps with a broadcast every 10 ms.
  void Run(int milliseconds) {
    for (int i = 0; i < milliseconds; ++i) {
      if (ms % 10 == 0) Say();
      Step();
    }
  }
  void Silence(int milliseconds) {
    for (int i = 0; i < milliseconds; ++i) Step();
  }
  Answer Ask(Request request, std::uint8_t what, std::uint8_t index, std::uint32_t value = 0) {
    const Asking asking{request, what, index, value, nonce};
    std::uint8_t frame[kDoSize];
    const std::size_t size = Encode(asking, frame);
    Receive(frame, size, false, board);
    std::uint8_t out[kFrameSize];
    MakeFrame(board, out);
    reply = DecodeReply(out);
    board.reply_due = false;
    return reply.answer;
  }
  Answer Set(MotorParameter what, int motor, float value) {
    return Ask(Request::kSet, what, static_cast<std::uint8_t>(motor), internal::ToBits(value));
  }
  float Get(MotorParameter what, int motor) {
    EXPECT_EQ(Ask(Request::kAsk, what, static_cast<std::uint8_t>(motor)), Answer::kGood);
    return internal::FromBits(internal::Get32(reply.payload));
  }
  void Reference() {
    for (std::uint8_t m = 0; m < kMotors; ++m) {
      EXPECT_EQ(Ask(Request::kDo, static_cast<std::uint8_t>(Action::kSetReference), m, 0),
                Answer::kGood);
    }
  }
  /// Runs the two steps of arming, then the mode.
  void ArmInto(Mode mode, bool capture = true) {
    say.clear_faults = true;
    say.mode = Mode::kOff;
    say.arm = Arm::kReady;
    Run(20);
    say.arm = Arm::kGo;
    say.mode = mode;
    say.capture = capture;
    Run(20);
    say.capture = false;
  }

  Board board;
  BenchMotor motors[kMotors];
  Cyclic say;
  Reply reply;
  std::uint16_t nonce = 0;
  bool driver_fault = false;
  double most_n = 0;
  std::int64_t ms = 0;
};

}  // namespace taut::board
