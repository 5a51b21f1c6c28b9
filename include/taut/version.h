/// The version of taut, as CMake knows it.
#pragma once

namespace taut {

inline constexpr const char* kVersion = "0.1.0";

}  // namespace taut
