/// Error after a failed explicit memory allocation.
#pragma once

namespace taut::base {

/// Throws std::bad_alloc. This function is in a separate file, because callers may be compiled
/// without exceptions (cmake/browser.cmake).
[[noreturn]] void OutOfMemory();

}  // namespace taut::base
