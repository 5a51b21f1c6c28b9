/// How much a trace may unpack to. A few kB of deflate can stand for gigabytes, which nobody means
/// to send and which would keep a reader busy for minutes.
#pragma once

#include <algorithm>

namespace taut::trace {

/// What is not larger than this is read, however tightly it was packed [bytes].
inline constexpr double kAlwaysUnpackedBytes = 256.0 * (1 << 20);
/// What is larger may be this many times the file's size. Traces as runs write them pack to a half
/// or a tenth, those of a robot at rest to a fiftieth; deflate's limit is 1032.
inline constexpr double kMostUnpackedPerByte = 100.0;

inline constexpr char kUnpackLimit[] = "more than 256 MiB and than 100 times its size";

inline double MostUnpackedBytes(double file_bytes) {
  return std::max(kAlwaysUnpackedBytes, kMostUnpackedPerByte * file_bytes);
}

}  // namespace taut::trace
