/// What numbers of the boards' protocol are called: parameters, modes, faults, answers
/// (docs/hardware/protocol.md).
///
/// Threads: any number may call these.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "taut/board/board.h"
#include "taut/diagnostics.h"
#include "taut/link/state.h"

namespace taut::link {

struct ParameterInfo {
  const char* key;  ///< Ends in its unit.
  board::Range range;
};
/// By their numbers.
std::span<const ParameterInfo> MotorParameters();
std::span<const ParameterInfo> BoardParameters();

/// Which parameter of which board, and of which of its motors.
struct ParameterPlace {
  int board = 0;
  int index = 0;  ///< `board::kMotors`: of the board itself.
  std::uint8_t parameter = 0;
};

/// That of a motor, of whichever board.
constexpr ParameterPlace PlaceOf(int motor, std::uint8_t parameter) {
  return {motor / board::kMotors, motor % board::kMotors, parameter};
}

/// A value for a parameter.
struct Setting {
  ParameterPlace place;
  float value = 0;
};

/// A parameter by its name, and a value for it.
struct ParameterValue {
  bool of_motor = false;  ///< Else of the board.
  std::uint8_t parameter = 0;
  float value = 0;
};
/// Reads "duty_limit=0.5". Nothing and a complaint, which begins with `what`, if it is none or out
/// of its range.
std::optional<ParameterValue> ReadParameter(const std::string& text, const std::string& what,
                                            Diagnostics& out);
/// For all motors, or all boards, of a robot of so many.
std::vector<Setting> ForAll(const ParameterValue& value, int motors);

const char* ModeName(board::Mode mode);
std::optional<board::Mode> ModeOf(const std::string& name);
/// "over_tension, stall"; empty: none.
std::string MotorFaultNames(unsigned bits);
std::string BoardFaultNames(unsigned bits);
std::string ResetCauseNames(unsigned bits);
/// What is wrong with a board and its motors, empty if nothing is.
std::string FaultsOf(const State& state, int board, const std::vector<std::string>& cables);
/// All that is wrong with a board and its motors: "outer_top_1: stall; board: bus_stuck"; "no
/// faults". `cables`: names of the motors.
std::string FaultText(const State& state, int board, const std::vector<std::string>& cables);
/// "out of the parameter's range".
const char* AnswerText(board::Answer answer);

}  // namespace taut::link
