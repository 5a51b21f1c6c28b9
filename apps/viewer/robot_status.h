/// How a robot is, as RobotStatus of web/protocol/messages.json says it.
#pragma once

#include <string>
#include <vector>

#include "scene.h"
#include "taut/link/state.h"

namespace taut::viewer {

/// Values of `board::kGains` gains, by motor; NaN: not known yet.
using Gains = std::vector<std::vector<double>>;

/// All that is wrong, in words, what matters most first. `age_s`: since a cycle ended, by the
/// wall's clock.
std::vector<std::string> AlarmsOf(const link::State& state, const std::vector<std::string>& cables,
                                  const std::string& port, double age_s);

/// Without time, alarms, recording and events.
Json StatusJson(const link::State& state, const std::vector<std::string>& cables,
                const Gains& gains);

}  // namespace taut::viewer
