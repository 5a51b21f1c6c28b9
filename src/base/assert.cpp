#include "base/assert.h"

#ifdef TAUT_ASSERTS

#include <cstdio>
#include <cstdlib>

namespace taut::base {

void AssertionFailed(const char* file, int line, const char* condition) noexcept {
  std::fprintf(stderr, "%s:%d: assertion failed: %s\n", file, line, condition);
  std::abort();
}

}  // namespace taut::base

#endif
