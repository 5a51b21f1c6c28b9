#include "taut/link/names.h"

#include <fmt/format.h>

#include <charconv>

#include "base/bit_names.h"

namespace taut::link {
namespace {

constexpr ParameterInfo kMotorParameters[] = {
#define TAUT_INFO(name, key, value, least, greatest) {key, {value, least, greatest}},
    TAUT_MOTOR_PARAMETERS(TAUT_INFO)};
constexpr ParameterInfo kBoardParameters[] = {TAUT_BOARD_PARAMETERS(TAUT_INFO)};
#undef TAUT_INFO

constexpr struct {
  board::Mode mode;
  const char* name;
} kModes[] = {{board::Mode::kOff, "off"},           {board::Mode::kHold, "hold"},
              {board::Mode::kPosition, "position"}, {board::Mode::kImpedance, "impedance"},
              {board::Mode::kDuty, "duty"},         {board::Mode::kReply, "reply"},
              {board::Mode::kStopped, "stopped"}};

/// In the order of the bits, least significant bit first.
constexpr const char* kResetCauses[] = {"power_on", "external", "brown_out", "watchdog"};

}  // namespace

std::span<const ParameterInfo> MotorParameters() { return kMotorParameters; }
std::span<const ParameterInfo> BoardParameters() { return kBoardParameters; }

std::optional<ParameterValue> ReadParameter(const std::string& text, const std::string& what,
                                            Diagnostics& out) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  double value = 0;
  const char* const end = text.data() + text.size();
  const char* const number = text.data() + std::min(text.size(), equals) + 1;
  const auto read = equals == std::string::npos || number >= end
                        ? std::from_chars_result{number, std::errc::invalid_argument}
                        : std::from_chars(number, end, value);
  if (read.ec != std::errc() || read.ptr != end) {
    out.Error("board.bad_assignment", {}, what + " " + text + ": expected the form name=number");
    return std::nullopt;
  }
  std::vector<std::string> keys;
  for (const bool of_motor : {true, false}) {
    const auto infos = of_motor ? MotorParameters() : BoardParameters();
    for (std::size_t i = 0; i < infos.size(); ++i) {
      keys.push_back(infos[i].key);
      if (name != infos[i].key) continue;
      const board::Range& range = infos[i].range;
      if (board::IsWithin(range, static_cast<float>(value))) {
        return ParameterValue{of_motor, static_cast<std::uint8_t>(i), static_cast<float>(value)};
      }
      out.Error("board.out_of_range", {},
                fmt::format("{} {}: the value must be within {:g} .. {:g}", what, text, range.least,
                            range.greatest));
      return std::nullopt;
    }
  }
  const std::string_view close = ClosestMatch(name, keys);
  out.Error("board.unknown_parameter", {}, what + " " + text + ": boards have no parameter " + name,
            close.empty() ? "see docs/hardware/parameters.md" : DidYouMean(name, keys));
  return std::nullopt;
}

std::vector<Setting> ForAll(const ParameterValue& value, int motors) {
  std::vector<Setting> settings;
  const int boards = (motors + board::kMotors - 1) / board::kMotors;
  for (int i = 0; i < (value.of_motor ? motors : boards); ++i) {
    settings.push_back(value.of_motor ? Setting{PlaceOf(i, value.parameter), value.value}
                                      : Setting{{i, board::kMotors, value.parameter}, value.value});
  }
  return settings;
}

const char* ModeName(board::Mode mode) {
  for (const auto& [one, name] : kModes) {
    if (one == mode) return name;
  }
  return "unknown";
}

std::optional<board::Mode> ModeOf(const std::string& name) {
  for (const auto& [mode, one] : kModes) {
    if (name == one) return mode;
  }
  return std::nullopt;
}

std::string MotorFaultNames(unsigned bits) { return base::BitNames(bits, board::kMotorFaultNames); }
std::string BoardFaultNames(unsigned bits) { return base::BitNames(bits, board::kBoardFaultNames); }
std::string ResetCauseNames(unsigned bits) { return base::BitNames(bits, kResetCauses); }

std::string FaultsOf(const State& state, int board, const std::vector<std::string>& cables) {
  std::string out;
  const auto add = [&](const std::string& who, const std::string& what) {
    if (!what.empty()) out += (out.empty() ? "" : "; ") + who + ": " + what;
  };
  const std::size_t first = static_cast<std::size_t>(board) * board::kMotors;
  for (std::size_t m = first; m < first + board::kMotors && m < state.motors.size(); ++m) {
    add(m < cables.size() ? cables[m] : "motor " + std::to_string(m),
        MotorFaultNames(state.motors[m].faults));
  }
  add("board", BoardFaultNames(state.boards[static_cast<std::size_t>(board)].faults));
  return out;
}

std::string FaultText(const State& state, int board, const std::vector<std::string>& cables) {
  const std::string faults = FaultsOf(state, board, cables);
  return faults.empty() ? "no faults" : faults;
}

const char* AnswerText(board::Answer answer) {
  switch (answer) {
    case board::Answer::kGood:
      return "good";
    case board::Answer::kUnknown:
      return "there is no such parameter, action or motor";
    case board::Answer::kOutOfRange:
      return "the value is out of the parameter's range";
    case board::Answer::kNotInThisMode:
      return "not allowed in its present mode";
    case board::Answer::kBusy:
      return "its memory is being written";
    case board::Answer::kStale:
      return "it was reset after its information was read";
  }
  return "unknown answer";
}

}  // namespace taut::link
