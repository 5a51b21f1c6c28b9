/// Being asked to stop: by Ctrl-C (SIGINT), by `kill` (SIGTERM), by a terminal that is closed
/// (SIGHUP; not under nohup). What was done by then is saved.
#pragma once

#include <atomic>

namespace taut::cli {

extern std::atomic<bool> interrupt_asked;

/// From here on such a signal sets `interrupt_asked` and ends nothing.
void CatchInterrupts();

}  // namespace taut::cli
