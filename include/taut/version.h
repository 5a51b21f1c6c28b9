/// Version of taut, defined only here: CMake and script/release read it.
#pragma once

namespace taut {

inline constexpr const char* kVersion = "0.2.0";

}  // namespace taut
