/// Counter-based random numbers: functions of seed, stream and index. There is no sequential state,
/// so the order of evaluation, the number of threads and interruptions have no effect. The numbers
/// have the same bits on every machine, because only integers, + - * /, sqrt and taut's logarithm
/// are used.
#pragma once

#include <array>
#include <cstdint>

namespace taut::math {

/// Philox4x32-10: converts a counter and a key into 128 random bits in ten rounds.
/// Source: J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, "Parallel random numbers: as easy as
/// 1, 2, 3", SC'11, doi:10.1145/2063384.2063405; tested with the authors' known answers.
std::array<std::uint32_t, 4> Philox(std::array<std::uint32_t, 4> counter,
                                    std::array<std::uint32_t, 2> key) noexcept;

/// Random numbers for one use, in any quantity. Different streams are independent.
class Random {
 public:
  /// `stream`: purpose of the numbers; `index`: number of the use.
  Random(std::uint64_t seed, std::uint32_t stream, std::uint64_t index) noexcept
      : seed_(seed), index_(index), stream_(stream) {}

  std::uint64_t Bits() noexcept;
  double Uniform() noexcept;                         ///< In [0, 1), a multiple of 2^-53.
  double Uniform(double low, double high) noexcept;  ///< In [low, high].
  double Normal() noexcept;                          ///< Mean 0, variance 1.

 private:
  double Tail(bool negative) noexcept;

  std::uint64_t seed_, index_;
  std::uint32_t stream_, block_ = 0;
  std::uint64_t spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace taut::math
