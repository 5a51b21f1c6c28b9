/// Limit of the unpacked size of a trace. A few kB of deflate can expand to gigabytes, which is
/// never intended and would take minutes to read.
#pragma once

#include <algorithm>

namespace taut::trace {

/// Traces up to this size [bytes] are read at any compression ratio.
inline constexpr double kAlwaysUnpackedBytes = 256.0 * (1 << 20);
/// Larger traces may be larger than their file by this factor. Typical compression ratios are 2 to
/// 10, or 50 for a robot at rest. The limit of deflate is 1032.
inline constexpr double kMostUnpackedPerByte = 100.0;

inline constexpr char kUnpackLimit[] = "more than 256 MiB and more than 100 times its size";

inline double MostUnpackedBytes(double file_bytes) {
  return std::max(kAlwaysUnpackedBytes, kMostUnpackedPerByte * file_bytes);
}

}  // namespace taut::trace
