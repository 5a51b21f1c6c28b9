// Messages about wrong indices and counts from callers of a WorldBatch.
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

}  // namespace taut::sim
