/// The version of taut. It stands here and nowhere else: CMake and script/release read it.
#pragma once

namespace taut {

inline constexpr const char* kVersion = "0.2.0";

}  // namespace taut
