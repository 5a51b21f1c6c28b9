// Messages about wrong indices, counts and steps from callers of a WorldBatch.
#include "sim/batch/check_index.h"

#include <cstdio>
#include <cstdlib>

namespace taut::sim {

void WrongIndex(const char* function, const char* what, int index, int count) noexcept {
  if (count == 0) {
    std::fprintf(stderr, "taut: %s: there is no %s %d: the model has none\n", function, what,
                 index);
  } else {
    std::fprintf(stderr, "taut: %s: there is no %s %d: valid are 0 to %d\n", function, what, index,
                 count - 1);
  }
  std::abort();
}

void NoMotor(const char* function, int cable) noexcept {
  std::fprintf(stderr, "taut: %s: cable %d has no dc_motor\n", function, cable);
  std::abort();
}

void WrongCount(const char* function, const char* what, std::size_t given,
                std::size_t needed) noexcept {
  std::fprintf(stderr, "taut: %s: needs one %s: expected %zu, got %zu\n", function, what, needed,
               given);
  std::abort();
}

void WrongStep(const char* function, double step_s, int count) noexcept {
  if (count < 0) {
    std::fprintf(stderr, "taut: %s: there are %d steps: valid are 0 or more\n", function, count);
  } else {
    std::fprintf(stderr, "taut: %s: the step is %g s: valid are steps above 0, up to %g s\n",
                 function, step_s, kLongestStep_s);
  }
  std::abort();
}

}  // namespace taut::sim
