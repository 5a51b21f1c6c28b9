// The firmware compiled by avr-gcc on six emulated boards: its cost, and equality with the same
// code run natively
#include <cstring>

#include "tests/virtual_robot/firmware_fixture.h"

namespace taut::virtual_robot {
namespace {

using board::Mode;

/// Durations of a board's ticks, by the mode in which they end
class Stopwatch {
 public:
  explicit Stopwatch(Board& board) {
    board.on_marker = [this](std::uint64_t cycle, std::uint8_t mark) {
      if ((mark & 0xf0) == 0x10) begun_ = cycle;
      if ((mark & 0xf0) == 0x20)
        times[mark & 7].push_back(static_cast<double>(cycle - begun_) / 16.0);
    };
  }
  double Mean(Mode mode) {
    const auto& all = times[static_cast<int>(mode)];
    double sum = 0;
    for (const double t : all) sum += t;
    return sum / static_cast<double>(all.size());
  }
  double Most(Mode mode) {
    const auto& all = times[static_cast<int>(mode)];
    return all.empty() ? 0.0 : *std::max_element(all.begin(), all.end());
  }
  std::map<int, std::vector<double>> times;  ///< [us]

 private:
  std::uint64_t begun_ = 0;
};

TEST(Firmware, FitsTheChip) {
  EXPECT_LE(Firmware()->flash.size(), 16384u);
  ::testing::Test::RecordProperty("flash_bytes", static_cast<int>(Firmware()->flash.size()));
}

TEST(Firmware, TellsWhoItIs) {
  BenchPlant plant;
  Robot robot(plant, {.program = Firmware()});
  Master master(robot);
  master.Begin();
  master.Run(0.05);
  for (std::uint8_t b = 0; b < board::kBoards; ++b) {
    const auto reply = master.Ask(b, {board::Request::kAsk, 0xf0, board::kMotors, 0, 0});
    ASSERT_TRUE(reply.has_value()) << int{b};
    const board::Info info = board::DecodeInfo(reply->payload);
    EXPECT_EQ(info.board, b);
    EXPECT_EQ(info.protocol_min, board::kProtocolVersion);
    EXPECT_EQ(info.parameters_version, board::kParametersVersion);
    EXPECT_EQ(info.nonce, 1);
  }
  EXPECT_EQ(master.bad_frames, 0);
}

TEST(Firmware, KeepsItsTimesAndItsMemory) {
  BenchPlant plant;
  Robot robot(plant, {.program = Firmware()});
  std::vector<std::unique_ptr<Stopwatch>> watches;
  for (int b = 0; b < robot.board_count(); ++b)
    watches.push_back(std::make_unique<Stopwatch>(robot.board(b)));
  Master master(robot);
  master.Begin();
  master.Run(0.05);
  master.Reference();
  master.ArmInto(Mode::kHold);
  master.say.mode = Mode::kPosition;
  for (int i = 0; i < board::kCables; ++i)
    master.say.values[i] = static_cast<std::int16_t>(i % 2 == 0 ? 3000 : -2000);
  master.Run(1.0);  // at full speed for half of it
  master.say.mode = Mode::kImpedance;
  master.say.capture = true;
  for (auto& value : master.say.values) value = 0;
  master.Run(0.1);
  master.say.capture = false;
  for (int second = 0; second < 2; ++second) {
    for (auto& value : master.say.values) value = second == 0 ? 2000 : -2000;
    master.Run(1.0);
  }
  EXPECT_EQ(master.bad_frames, 0);
  double position = 0, impedance = 0;
  for (int b = 0; b < robot.board_count(); ++b) {
    Stopwatch& watch = *watches[static_cast<std::size_t>(b)];
    EXPECT_LE(watch.Most(Mode::kPosition), 600) << b;
    EXPECT_LE(watch.Most(Mode::kImpedance), 1000) << b;
    EXPECT_LE(watch.Mean(Mode::kPosition), 400) << b;
    EXPECT_LE(watch.Mean(Mode::kImpedance), 800) << b;
    position = std::max(position, watch.Most(Mode::kPosition));
    impedance = std::max(impedance, watch.Most(Mode::kImpedance));
    EXPECT_EQ(master.more[b][static_cast<int>(board::More::kOverruns)], 0) << b;
    EXPECT_EQ(master.status[b].mode, Mode::kImpedance) << b;
    EXPECT_FALSE(master.status[b].faulty) << b;
    EXPECT_LE(robot.board(b).StaticMemory() + robot.board(b).DeepestStack(), 1228) << b;
    std::printf("board %d: position %.0f (%.0f), impedance %.0f (%.0f) us, memory %d + %d\n", b,
                watch.Mean(Mode::kPosition), watch.Most(Mode::kPosition),
                watch.Mean(Mode::kImpedance), watch.Most(Mode::kImpedance),
                robot.board(b).StaticMemory(), robot.board(b).DeepestStack());
  }
  std::printf("cycle %.2f ms, most %.1f N\n",
              static_cast<double>(master.longest) / static_cast<double>(kMillisecond),
              plant.most_n);
}

/// Returns a motor's loop as in an AVR's memory, without padding.
std::vector<std::uint8_t> Packed(const board::MotorLoop& loop) {
  std::vector<std::uint8_t> bytes;
  const auto put = [&bytes](const auto& value) {
    const auto* const at = reinterpret_cast<const std::uint8_t*>(&value);
    bytes.insert(bytes.end(), at, at + sizeof value);
  };
  put(loop.encoder), put(loop.step), put(loop.counts), put(loop.tension_counts);
  put(loop.counts_per_tick);
  put(loop.tension_n), put(loop.rest_length_m), put(loop.length_m), put(loop.rate_m_per_s);
  put(loop.target_counts), put(loop.velocity_input_m_per_s), put(loop.drive_input), put(loop.gains);
  put(loop.pid), put(loop.set_point_n), put(loop.drive), put(loop.width);
  return bytes;
}

// Each broadcast and each reading of a board is also given to the same headers compiled for this
// processor: after every tick each word of both motors' loops has the same bits.
TEST(Firmware, HasTheBitsOfItsNativeTwin) {
  BenchPlant plant;
  Robot robot(plant, {.program = Firmware()});
  const Symbol at_board = SymbolOf("board"), at_inputs = SymbolOf("inputs");
  board::Board twin;
  board::SetDefaults(twin.parameters);
  board::Boot boot;
  boot.nonce = 1;
  board::Start(boot, twin);
  Board& emulated = robot.board(0);
  Master master(robot);
  std::size_t taken = 0;
  long words = 0, wrong = 0, ticks = 0;
  emulated.on_marker = [&](std::uint64_t, std::uint8_t mark) {
    if (mark == 0x40) {
      ASSERT_LT(taken, master.sent.size() + 1);
      // the current broadcast is appended to the list only after it has arrived everywhere; until
      // then the master's encoding is repeated
      std::uint8_t frame[board::kCyclicSize];
      if (taken < master.sent.size()) {
        std::copy(master.sent[taken].begin(), master.sent[taken].end(), frame);
      } else {
        board::Encode(master.say, frame);
      }
      ++taken;
      board::Receive(frame, sizeof frame, true, twin);
    }
    if ((mark & 0xf0) != 0x20) return;
    ++ticks;
    board::Inputs in{};
    const auto word = [&](int i) {
      return static_cast<std::uint16_t>(
          emulated.Memory(static_cast<std::uint16_t>(at_inputs.address + i)) |
          emulated.Memory(static_cast<std::uint16_t>(at_inputs.address + i + 1)) << 8);
    };
    for (int m = 0; m < board::kMotors; ++m)
      in.adc[m] = word(2 * m), in.encoder[m] = word(4 + 2 * m);
    in.driver_fault = emulated.Memory(static_cast<std::uint16_t>(at_inputs.address + 8)) != 0;
    in.elapsed = emulated.Memory(static_cast<std::uint16_t>(at_inputs.address + 9));
    board::Tick(in, twin);
    std::uint16_t at = static_cast<std::uint16_t>(
        at_board.address + 4 * (2 * board::kMotorParameters + board::kBoardParameters));
    for (const board::MotorLoop& loop : twin.loops) {
      const std::vector<std::uint8_t> bytes = Packed(loop);
      bool same = true;
      for (const std::uint8_t byte : bytes) same = (byte == emulated.Memory(at++)) && same;
      words += static_cast<long>(bytes.size() / 4);
      wrong += same ? 0 : 1;
    }
    twin.status_due = false;
    board::Feel(twin);
  };
  master.Begin();
  master.Run(0.05);
  master.ArmInto(Mode::kHold);
  master.Run(0.3);
  master.ArmInto(Mode::kImpedance);
  for (int i = 0; i < 8; ++i) {
    for (auto& value : master.say.values)
      value = static_cast<std::int16_t>(i % 2 == 0 ? 700 * i : -900 * i);
    master.Run(0.1);
  }
  EXPECT_GT(ticks, 1000);
  EXPECT_GT(words, 25000);
  EXPECT_EQ(wrong, 0) << "of " << 2 * ticks << " loops";
  EXPECT_EQ(twin.mode, Mode::kImpedance);
  EXPECT_NE(twin.loops[0].drive, 0.0f);
}

}  // namespace
}  // namespace taut::virtual_robot
