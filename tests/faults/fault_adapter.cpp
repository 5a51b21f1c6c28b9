// Adapter with six boards for script/faults: prints its device. For each input line it prints
// whether motors have power, 1 or 0; it ends at the end of the input. Argument: speed at which the
// first motor is turned by hand [m/s].
#include <cstdio>
#include <cstdlib>

#include "link/hostile_adapter.h"

int main(int argc, char** argv) {
  const taut::link::HostileAdapter adapter(taut::link::Hostility::kNone,
                                           argc > 1 ? std::atof(argv[1]) : 0.0);
  std::printf("%s\n", adapter.device().c_str());
  std::fflush(stdout);
  for (int c = std::getchar(); c != EOF; c = std::getchar()) {
    if (c != '\n') continue;
    std::printf("%d\n", adapter.AnyPower() ? 1 : 0);
    std::fflush(stdout);
  }
}
