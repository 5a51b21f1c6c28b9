/// Where memory that was asked for by hand is not to be had.
#pragma once

namespace taut::base {

/// Throws std::bad_alloc. By itself, because who calls it may be compiled without exceptions
/// (cmake/browser.cmake).
[[noreturn]] void OutOfMemory();

}  // namespace taut::base
