/// Pseudorandom numbers from a seed, the same on every machine, so that scenes are reproducible.
#pragma once

#include <cstdint>

#include "tests/scenes/solids.h"

namespace taut::scenes {

/// SplitMix64. Source: G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number
/// generators", OOPSLA 2014, doi:10.1145/2660193.2660195.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : state_(seed) {}

  /// Returns a number in [low, high).
  double Within(double low, double high) {
    return low + (high - low) * static_cast<double>(Bits() >> 11) * 0x1p-53;
  }
  /// Returns a vector with each component in [-size, size).
  Vec3 Jolt(double size) {
    const double x = Within(-size, size), y = Within(-size, size), z = Within(-size, size);
    return {x, y, z};
  }
  /// Returns a unit vector, uniformly distributed over all directions.
  Vec3 Direction() {
    while (true) {
      const Vec3 v = Jolt(1);
      const double length = LengthOf(v);
      if (length > 0.1 && length < 1) return Scaled(1 / length, v);
    }
  }

 private:
  std::uint64_t Bits() {
    state_ += 0x9e3779b97f4a7c15;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

}  // namespace taut::scenes
