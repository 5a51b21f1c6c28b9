#include "interrupt.h"

#include <csignal>

namespace taut::cli {

std::atomic<bool> interrupt_asked{false};

namespace {

extern "C" void AskInterrupt(int) { interrupt_asked = true; }

}  // namespace

void CatchInterrupts() {
  std::signal(SIGINT, AskInterrupt);
  std::signal(SIGTERM, AskInterrupt);
  if (std::signal(SIGHUP, AskInterrupt) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

}  // namespace taut::cli
