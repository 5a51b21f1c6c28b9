/// Version of taut. CMake and script/release read it from this file.
#pragma once

namespace taut {

inline constexpr const char* kVersion = "0.2.0";

}  // namespace taut
