#include "base/out_of_memory.h"

#include <new>

namespace taut::base {

void OutOfMemory() { throw std::bad_alloc(); }

}  // namespace taut::base
