/// Names of the numbers in the protocol of the boards: parameters, modes, faults, answers
/// (docs/hardware/protocol.md).
///
/// Threads: any number may call these functions concurrently.
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
  const char* key;  ///< Ends with its unit.
  board::Range range;
};
/// Return all parameters, indexed by their numbers.
std::span<const ParameterInfo> MotorParameters();
std::span<const ParameterInfo> BoardParameters();

/// Parameter of a board or of one of its motors.
struct ParameterPlace {
  int board = 0;
  int index = 0;  ///< Index of the motor; `board::kMotors`: the board.
  std::uint8_t parameter = 0;
};

/// Returns board and index for a parameter of a motor. `motor` counts over all boards.
constexpr ParameterPlace PlaceOf(int motor, std::uint8_t parameter) {
  return {motor / board::kMotors, motor % board::kMotors, parameter};
}

/// Parameter of a certain board or motor, with a value.
struct Setting {
  ParameterPlace place;
  float value = 0;
};

/// Parameter of any board or motor, with a value.
struct ParameterValue {
  bool of_motor = false;  ///< Parameter of a motor instead of a board.
  std::uint8_t parameter = 0;
  float value = 0;
};
/// Parses text such as "duty_limit=0.5". If the text is invalid or the value out of range, returns
/// nothing and adds an error that begins with `what`.
std::optional<ParameterValue> ReadParameter(const std::string& text, const std::string& what,
                                            Diagnostics& out);
/// Returns settings with this value for all motors or boards of a robot with `motors` motors.
std::vector<Setting> ForAll(const ParameterValue& value, int motors);

const char* ModeName(board::Mode mode);
std::optional<board::Mode> ModeOf(const std::string& name);
/// Return the names of fault bits, such as "over_tension, stall"; empty: none.
std::string MotorFaultNames(unsigned bits);
std::string BoardFaultNames(unsigned bits);
std::string ResetCauseNames(unsigned bits);
/// Returns the faults of a board and its motors; empty if there are none.
std::string FaultsOf(const State& state, int board, const std::vector<std::string>& cables);
/// Returns the text of `FaultsOf`, such as "outer_top_1: stall; board: bus_stuck", or "no faults"
/// if there are none. `cables`: names of the motors' cables.
std::string FaultText(const State& state, int board, const std::vector<std::string>& cables);
/// Returns a description, such as "out of the parameter's range".
const char* AnswerText(board::Answer answer);

}  // namespace taut::link
