/// Limit of the unpacked size of a trace. A few kB of deflate can expand to gigabytes, which are
/// never intended and would keep a reader busy for minutes.
#pragma once

#include <algorithm>

namespace taut::trace {

/// Up to this size a trace is read, whatever its compression ratio [bytes].
inline constexpr double kAlwaysUnpackedBytes = 256.0 * (1 << 20);
/// Larger traces may have this many times the file's size. Typical traces of runs compress to a
/// half or a tenth, traces of a robot at rest to a fiftieth; deflate's limit is 1032.
inline constexpr double kMostUnpackedPerByte = 100.0;

inline constexpr char kUnpackLimit[] = "more than 256 MiB and more than 100 times its size";

inline double MostUnpackedBytes(double file_bytes) {
  return std::max(kAlwaysUnpackedBytes, kMostUnpackedPerByte * file_bytes);
}

}  // namespace taut::trace
