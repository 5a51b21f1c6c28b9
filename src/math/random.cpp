#include "math/random.h"

#include <algorithm>
#include <cmath>

#include "math/elementary.h"

namespace taut::math {
namespace {

constexpr double kTwoToMinus53 = 1.0 / 9007199254740992.0;

/// Ziggurat method: layers of equal area under exp(-x^2 / 2). In 99 % of all cases the number is in
/// the part of a layer that is completely under the curve, and costs one multiplication.
/// Source: G. Marsaglia, W. W. Tsang, "The ziggurat method for generating random variables", J.
/// Stat. Software 5(8), 2000; in the form of J. A. Doornik, "An improved ziggurat method to
/// generate normal random samples", 2005, which takes layer and position from separate bits.
struct Ziggurat {
  static constexpr int kLayers = 128;
  static constexpr double kTail = 3.442619855899;       ///< Start of the tail.
  static constexpr double kArea = 9.91256303526217e-3;  ///< Area of each layer for this start.
  double x[kLayers + 1];                                ///< Right ends of the layers.
  double sure[kLayers];  ///< Fraction of each layer that is completely under the curve.

  Ziggurat() noexcept {
    double f = Exp(-0.5 * kTail * kTail);
    x[0] = kArea / f;
    x[1] = kTail;
    x[kLayers] = 0;
    for (int i = 2; i < kLayers; ++i) {
      x[i] = std::sqrt(-2.0 * Log(kArea / x[i - 1] + f));
      f = Exp(-0.5 * x[i] * x[i]);
    }
    for (int i = 0; i < kLayers; ++i) sure[i] = x[i + 1] / x[i];
  }
};

const Ziggurat& Layers() noexcept {
  static const Ziggurat layers;
  return layers;
}

}  // namespace

std::array<std::uint32_t, 4> Philox(std::array<std::uint32_t, 4> c,
                                    std::array<std::uint32_t, 2> k) noexcept {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t{0xD2511F53u} * c[0];
    const std::uint64_t b = std::uint64_t{0xCD9E8D57u} * c[2];
    c = {static_cast<std::uint32_t>(b >> 32) ^ c[1] ^ k[0], static_cast<std::uint32_t>(b),
         static_cast<std::uint32_t>(a >> 32) ^ c[3] ^ k[1], static_cast<std::uint32_t>(a)};
    k[0] += 0x9E3779B9u;
    k[1] += 0xBB67AE85u;
  }
  return c;
}

std::uint64_t Random::Bits() noexcept {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const auto r =
      Philox({static_cast<std::uint32_t>(index_), static_cast<std::uint32_t>(index_ >> 32), stream_,
              block_++},
             {static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32)});
  spare_ = (std::uint64_t{r[3]} << 32) | r[2];
  has_spare_ = true;
  return (std::uint64_t{r[1]} << 32) | r[0];
}

double Random::Uniform() noexcept { return static_cast<double>(Bits() >> 11) * kTwoToMinus53; }

double Random::Uniform(double low, double high) noexcept {
  return std::min(high, low + Uniform() * (high - low));
}

double Random::Normal() noexcept {
  const Ziggurat& z = Layers();
  for (;;) {
    const std::uint64_t bits = Bits();
    const double u = 2.0 * (static_cast<double>(bits >> 11) * kTwoToMinus53) - 1.0;
    const auto layer = static_cast<int>(bits & (Ziggurat::kLayers - 1));
    if (std::fabs(u) < z.sure[layer]) return u * z.x[layer];
    if (layer == 0) return Tail(u < 0);
    const double x = u * z.x[layer];
    const double above = Exp(-0.5 * (z.x[layer] * z.x[layer] - x * x));
    const double below = Exp(-0.5 * (z.x[layer + 1] * z.x[layer + 1] - x * x));
    if (below + Uniform() * (above - below) < 1.0) return x;
  }
}

double Random::Tail(bool negative) noexcept {
  double x, y;
  do {
    x = Log(1.0 - Uniform()) / Ziggurat::kTail;
    y = Log(1.0 - Uniform());
  } while (-2.0 * y < x * x);
  return negative ? x - Ziggurat::kTail : Ziggurat::kTail - x;
}

}  // namespace taut::math
