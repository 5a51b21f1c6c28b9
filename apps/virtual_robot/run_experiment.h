/// Experiments on emulated boards in virtual time, recorded in a run folder.
#pragma once

#include <atomic>
#include <string>

#include "apps/virtual_robot/boards_plant.h"

namespace taut::virtual_robot {

struct ExperimentRun {
  std::string out;  ///< The run's folder; empty: `runs/NAME_on_boards`.
  bool quiet = false;
  bool csv = false;  ///< Write traces as CSV, too.
};

/// Returns the exit status: 0 good, 1 failed, 3 bad input, 130 interrupted.
int RunOnBoards(const ExperimentSpec& experiment, const BoardsOptions& options,
                const ExperimentRun& run, const std::atomic<bool>& stop, Diagnostics& out);

}  // namespace taut::virtual_robot
