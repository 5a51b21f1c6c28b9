/// Random models from the bytes of a fuzzer: a sequence of numbers, vectors and materials.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "math/vec.h"
#include "tests/scenes/solids.h"

namespace taut::fuzz {

/// Draws the parts of a model, from the last byte to the first, like libFuzzer's
/// FuzzedDataProvider, with the same results for every compiler. Sizes are in the range of robots;
/// stiffnesses, masses, speeds and steps span the range of user input.
class Draw {
 public:
  explicit Draw(std::vector<std::uint8_t> from) : from_(std::move(from)) {}

  int Int(int low, int high) {
    return low + static_cast<int>(Below(static_cast<std::uint64_t>(high - low)));
  }
  bool Coin() { return Below(1) != 0; }
  double Between(double low, double high) {
    constexpr auto kMost = std::numeric_limits<std::uint64_t>::max();
    return low + (high - low) * (static_cast<double>(Below(kMost)) / static_cast<double>(kMost));
  }
  /// Log-uniform between two positive numbers.
  double Scale(double low, double high) { return std::exp(Between(std::log(low), std::log(high))); }
  Vec3 Point(double size) {
    const double x = Between(-size, size), y = Between(-size, size), z = Between(-size, size);
    return {x, y, z};
  }
  Vec3 Direction() {
    const Vec3 v = Point(1);
    const double length = std::sqrt(Dot(v, v));
    return length > 1e-3 ? (1 / length) * v : Vec3{0, 0, 1};
  }
  Quat Turn() {
    const Vec3 axis = Direction();  // in an order that does not depend on the compiler
    return scenes::Turn(axis, Between(-4, 4));
  }
  Material Surface() {
    Material m;
    m.kinetic_friction = Between(0, 1.5);
    m.static_friction = m.kinetic_friction + Between(0, 0.5);
    m.restitution = Between(0, 1);
    return m;
  }
  int Body(const ModelDef& def) { return Int(kWorld, static_cast<int>(def.bodies.size()) - 1); }

 private:
  /// 0 to `most`; 0 when all bytes are used up.
  std::uint64_t Below(std::uint64_t most) {
    std::uint64_t number = 0;
    for (int bits = 0; bits < 64 && most >> bits > 0 && !from_.empty(); bits += 8) {
      number = number << 8 | from_.back();
      from_.pop_back();
    }
    return most == std::numeric_limits<std::uint64_t>::max() ? number : number % (most + 1);
  }

  std::vector<std::uint8_t> from_;
};

/// Returns the input, consumed from its end, preceded by pseudorandom bytes seeded by it, so that a
/// short input also makes a complete model.
inline std::vector<std::uint8_t> Extended(const std::uint8_t* data, std::size_t size) {
  std::seed_seq seed(data, data + size);
  std::mt19937 random(seed);
  constexpr std::size_t kFollowing = 1 << 14;
  std::vector<std::uint8_t> bytes(kFollowing + size);
  for (std::size_t i = 0; i < kFollowing; ++i) bytes[i] = static_cast<std::uint8_t>(random());
  std::copy(data, data + size, bytes.begin() + kFollowing);
  return bytes;
}

}  // namespace taut::fuzz
