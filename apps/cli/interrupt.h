/// Interrupt by Ctrl-C (SIGINT), `kill` (SIGTERM), or closing the terminal (SIGHUP; not under
/// nohup). Commands save the results so far.
#pragma once

#include <atomic>

namespace taut::cli {

extern std::atomic<bool> interrupt_asked;

/// Installs handlers: such a signal only sets `interrupt_asked`.
void CatchInterrupts();

}  // namespace taut::cli
