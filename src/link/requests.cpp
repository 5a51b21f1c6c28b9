#include "taut/link/requests.h"

#include <algorithm>
#include <bit>

#include "link/frames.h"

namespace taut::link {
namespace {

constexpr int kTries = 3;
/// Time to wait for an answer. Boards process messages between two ticks. Emulated boards may be
/// slow on a busy machine, so each further attempt waits longer by the factor kLonger.
constexpr double kAnswer_s = 0.003, kLonger = 4;
/// 250 bytes of EEPROM at 3.4 ms each take 0.85 s; the rest is a safety margin.
constexpr double kMemory_s = 2.0;

board::Asking AskFor(board::Asked what) {
  return {board::Request::kAsk, static_cast<std::uint8_t>(what), board::kMotors, 0, 0};
}

std::string DescribeRequest(const board::Asking& asking) {
  const bool of_motor = asking.index < board::kMotors;
  const auto infos = of_motor ? MotorParameters() : BoardParameters();
  if (asking.request != board::Request::kDo && asking.what < infos.size()) {
    return std::string(infos[asking.what].key) +
           (of_motor ? " of motor " + std::to_string(asking.index) : "");
  }
  return "request " + std::to_string(asking.what);
}

}  // namespace

FaultReport DecodeFaults(const board::Reply& reply) {
  const std::uint8_t* const at = reply.payload;
  FaultReport report;
  for (std::size_t m = 0; m < board::kMotors; ++m) {
    report.motor[m] = at[m];
    report.referenced[m] = (at[4] >> (3 + m) & 1) != 0;
    report.temperature_c[m] = at[5 + m];
  }
  report.board = at[2];
  report.reset_cause = at[3];
  report.timeout = (at[4] & 1) != 0;
  report.stopped = (at[4] & 2) != 0;
  report.armed = (at[4] & 4) != 0;
  report.writes_memory = (at[4] & 32) != 0;
  return report;
}

std::optional<board::Reply> Requests::Ask(int board, const board::Asking& asking,
                                          Diagnostics& out) {
  const auto number = static_cast<std::uint8_t>(board);
  std::uint8_t request[board::kDoSize];
  const std::size_t size = board::Encode(asking, request);
  const std::uint8_t address = board::BoardAddress(number);
  Port& port = adapter_.port();
  const std::string who = "board " + std::to_string(board);
  double answer_s = kAnswer_s;
  for (int i = 0; i < kTries && port.is_open(); ++i, answer_s *= kLonger) {
    if (!adapter_.Write(address, {request, size})) continue;
    WaitUntil(port, port.now_s() + answer_s);
    const auto bytes = adapter_.Read(address, board::kFrameSize);
    const auto reply = bytes ? ReplyIn(*bytes, number) : std::nullopt;
    if (!reply || reply->what != asking.what || reply->index != asking.index) continue;
    if (reply->answer == board::Answer::kGood) return reply;
    out.Error("board.request_refused", {},
              who + " refuses " + DescribeRequest(asking) + ": " + AnswerText(reply->answer),
              "see docs/hardware/protocol.md");
    return std::nullopt;
  }
  out.Error("board.no_answer", {}, who + " does not answer",
            port.is_open() ? "list the boards that answer with `taut robot scan`"
                           : "the adapter is gone");
  return std::nullopt;
}

std::optional<board::Info> Requests::Info(int board, Diagnostics& out) {
  const auto reply = Ask(board, AskFor(board::Asked::kInfo), out);
  if (!reply) return std::nullopt;
  return board::DecodeInfo(reply->payload);
}

std::optional<FaultReport> Requests::Faults(int board, Diagnostics& out) {
  const auto reply = Ask(board, AskFor(board::Asked::kFaults), out);
  if (!reply) return std::nullopt;
  return DecodeFaults(*reply);
}

std::optional<CounterReport> Requests::Counters(int board, Diagnostics& out) {
  const auto reply = Ask(board, AskFor(board::Asked::kCounters), out);
  if (!reply) return std::nullopt;
  const auto at = [&](int i) { return board::internal::Get16(reply->payload + 2 * i); };
  return CounterReport{at(0), at(1), at(2), at(3)};
}

std::optional<float> Requests::Get(const ParameterPlace& place, Diagnostics& out) {
  const auto reply = Ask(
      place.board,
      {board::Request::kAsk, place.parameter, static_cast<std::uint8_t>(place.index), 0, 0}, out);
  if (!reply) return std::nullopt;
  return std::bit_cast<float>(board::internal::Get32(reply->payload));
}

bool Requests::Set(const Setting& setting, Diagnostics& out) {
  return Ask(setting.place.board, SetRequest(setting), out).has_value();
}

bool Requests::Do(int board, board::Action action, std::uint16_t nonce, Diagnostics& out) {
  return Ask(board,
             {board::Request::kDo, static_cast<std::uint8_t>(action), board::kMotors, 0, nonce},
             out)
      .has_value();
}

bool Requests::SetReference(int motor, std::int32_t counts, std::uint16_t nonce, Diagnostics& out) {
  return Ask(motor / board::kMotors,
             {board::Request::kDo, static_cast<std::uint8_t>(board::Action::kSetReference),
              static_cast<std::uint8_t>(motor % board::kMotors), static_cast<std::uint32_t>(counts),
              nonce},
             out)
      .has_value();
}

bool Requests::WaitForMemory(int board, Diagnostics& out) {
  Port& port = adapter_.port();
  const double until_s = port.now_s() + kMemory_s;
  while (port.now_s() < until_s) {
    const auto report = Faults(board, out);
    if (!report) return false;
    if (!report->writes_memory) return true;
  }
  out.Error("board.still_writing", {},
            "board " + std::to_string(board) + " is still writing its memory");
  return false;
}

std::optional<board::Status> Requests::ReadStatus(int board) {
  const auto number = static_cast<std::uint8_t>(board);
  for (int i = 0; i < kTries; ++i) {
    const auto bytes = adapter_.Read(board::BoardAddress(number), board::kFrameSize);
    if (const auto status = bytes ? StatusIn(*bytes, number) : std::nullopt) return status;
  }
  return std::nullopt;
}

}  // namespace taut::link
