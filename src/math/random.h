/// Random numbers that are a function of what they are for: seed, stream, index. Nothing is drawn
/// "next", so that no order of evaluation, no number of threads and no interruption changes them.
/// The same bits on every machine: integers, + - * /, sqrt, and our own logarithm.
#pragma once

#include <array>
#include <cstdint>

namespace taut::math {

/// Philox4x32-10: ten rounds that turn a counter and a key into 128 random bits.
/// Source: J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, "Parallel random numbers: as easy
/// as 1, 2, 3", SC'11, doi:10.1145/2063384.2063405; tested with the authors' known answers.
std::array<std::uint32_t, 4> Philox(std::array<std::uint32_t, 4> counter,
                                    std::array<std::uint32_t, 2> key) noexcept;

/// What one use needs: as many numbers as it asks for. Streams are separate whatever their numbers.
class Random {
 public:
  /// `stream`: what it is for. `index`: the how-manieth time.
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
