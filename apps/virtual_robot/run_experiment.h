/// An experiment on the emulated boards, in virtual time, into a run folder.
#pragma once

#include <atomic>
#include <string>

#include "apps/virtual_robot/boards_plant.h"

namespace taut::virtual_robot {

struct ExperimentRun {
  std::string out;  ///< The run's folder; `runs/NAME_on_boards` if empty.
  bool quiet = false;
  bool csv = false;  ///< Traces as text, too.
};

/// Exit status: 0 good, 1 failed, 3 bad input, 130 broken off.
int RunOnBoards(const ExperimentSpec& experiment, const BoardsOptions& options,
                const ExperimentRun& run, const std::atomic<bool>& stop, Diagnostics& out);

}  // namespace taut::virtual_robot
