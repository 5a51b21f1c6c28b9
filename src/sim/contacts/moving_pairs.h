/// Pairs of shapes of moving bodies: keys of their contacts and combined materials.
///
/// The number of such pairs grows with the square of a model, so no table stores them. The keys of
/// these pairs follow from the numbers of shapes of the bodies in each row
/// (View::shape_pairs_before). Scalar code, compiled once for all instruction sets.
#pragma once

#include "sim/data/view.h"

namespace taut::sim {

/// Returns the key of the first possible contact of two bodies. The pair of their i-th and k-th
/// shapes is number i * (shapes of b) + k, and every pair has kMaxPointsPerPair keys.
std::uint32_t FirstKeyOf(const View& m, MovingPair bodies) noexcept;

/// Returns one past the largest key of a contact.
std::uint32_t KeyEnd(const View& m) noexcept;

/// Returns a pair of two shapes with its combined coefficients. `key`: key of the first contact of
/// the pair.
ShapePairTable PairOf(const View& m, int shape_a, int shape_b, std::uint32_t key) noexcept;

/// Returns the pair to which a contact key belongs. The key must be at least
/// View::first_pair_id and less than KeyEnd.
ShapePairTable PairOfKey(const View& m, std::uint32_t key) noexcept;

/// Returns whether two bodies are kept apart, by exclusion or because both are kinematic. `a` must
/// be less than `b`.
bool AreApart(const View& m, int a, int b) noexcept;

/// Returns two bodies, given in ascending order, in the order of their contacts.
[[gnu::always_inline]] inline MovingPair Ordered(const View& m, int first, int second) noexcept {
  const bool led = m.motion_count > 0 && m.motion_of_body[first] >= 0;
  return led ? MovingPair{second, first} : MovingPair{first, second};
}

}  // namespace taut::sim
