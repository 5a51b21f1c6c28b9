/// State of a robot as RobotStatus of web/protocol/messages.json.
#pragma once

#include <string>
#include <vector>

#include "scene.h"
#include "taut/link/state.h"

namespace taut::viewer {

/// Values of `board::kGains` gains, by motor; NaN: not known yet.
using Gains = std::vector<std::vector<double>>;

/// Returns all alarms as text, most important first. `age_s`: wall-clock time since the last cycle.
std::vector<std::string> AlarmsOf(const link::State& state, const std::vector<std::string>& cables,
                                  const std::string& port, double age_s);

/// Returns the status without time, alarms, recording and events.
Json StatusJson(const link::State& state, const std::vector<std::string>& cables,
                const Gains& gains);

}  // namespace taut::viewer
