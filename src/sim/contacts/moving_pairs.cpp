#include "sim/contacts/moving_pairs.h"

#include "base/assert.h"
#include "sim/contacts/combine.h"

namespace taut::sim {
namespace {

std::uint32_t ShapesOf(const View& m, int body) noexcept {
  return static_cast<std::uint32_t>(m.first_shape[body + 1] - m.first_shape[body]);
}

/// Returns the index of the first body kept apart from `a` that is not before `b`.
int FirstApartFrom(const View& m, int a, int b) noexcept {
  int first = m.first_apart[a], end = m.first_apart[a + 1];
  while (first < end) {
    const int middle = first + (end - first) / 2;
    if (m.apart[middle].body < b) {
      first = middle + 1;
    } else {
      end = middle;
    }
  }
  return first;
}

/// Returns the number of pairs of shapes before those of two bodies, with a < b.
std::uint32_t PairsBefore(const View& m, int a, int b) noexcept {
  int shapes = m.first_shape[b] - m.first_shape[a + 1];
  const int first = m.first_apart[a], end = m.first_apart[a + 1];
  if (const int next = FirstApartFrom(m, a, b); next > first) {
    const ApartTable& last = m.apart[next - 1];
    shapes -= last.shapes_before + static_cast<int>(ShapesOf(m, last.body));
    TAUT_ASSERT(next <= end);
  }
  TAUT_ASSERT(shapes >= 0);
  return m.shape_pairs_before[a] + ShapesOf(m, a) * static_cast<std::uint32_t>(shapes);
}

std::uint32_t FirstMovingKey(const View& m) noexcept {
  return m.first_pair_id + static_cast<std::uint32_t>(kMaxPointsPerPair * m.shape_pair_count);
}

}  // namespace

std::uint32_t FirstKeyOf(const View& m, MovingPair bodies) noexcept {
  const bool ascend = bodies.a < bodies.b;
  const std::uint32_t before =
      ascend ? PairsBefore(m, bodies.a, bodies.b) : PairsBefore(m, bodies.b, bodies.a);
  return FirstMovingKey(m) + static_cast<std::uint32_t>(kMaxPointsPerPair) * before;
}

std::uint32_t KeyEnd(const View& m) noexcept {
  return FirstMovingKey(m) +
         static_cast<std::uint32_t>(kMaxPointsPerPair) * m.shape_pairs_before[m.body_count];
}

bool AreApart(const View& m, int a, int b) noexcept {
  const int first = FirstApartFrom(m, a, b);
  return first < m.first_apart[a + 1] && m.apart[first].body == b;
}

ShapePairTable PairOf(const View& m, int shape_a, int shape_b, std::uint32_t key) noexcept {
  const auto [at_rest, sliding, restitution] =
      Combined(m.friction_combine, m.restitution_combine, m.shapes[shape_a].material,
               m.shapes[shape_b].material);
  return {shape_a, shape_b, key, at_rest, sliding, restitution, 0};
}

ShapePairTable PairOfKey(const View& m, std::uint32_t key) noexcept {
  TAUT_ASSERT(m.first_pair_id <= key && key < KeyEnd(m));
  constexpr auto kPoints = static_cast<std::uint32_t>(kMaxPointsPerPair);
  std::uint32_t number = (key - m.first_pair_id) / kPoints;
  if (number < static_cast<std::uint32_t>(m.shape_pair_count)) return m.shape_pairs[number];
  number -= static_cast<std::uint32_t>(m.shape_pair_count);
  // Finds the last body whose pairs start at or before `number`: first among all bodies, then among
  // the partners in its row. The pairs of a body without partners start where those of the next
  // body start.
  const auto last = [](int first, int end, const auto& starts_before) {
    while (end - first > 1) {
      const int middle = first + (end - first) / 2;
      (starts_before(middle) ? first : end) = middle;
    }
    return first;
  };
  const int a = last(0, m.body_count, [&](int i) { return m.shape_pairs_before[i] <= number; });
  const int b = last(a + 1, m.body_count, [&](int i) { return PairsBefore(m, a, i) <= number; });
  const MovingPair bodies = Ordered(m, a, b);
  const std::uint32_t i = number - PairsBefore(m, a, b), of_b = ShapesOf(m, bodies.b);
  TAUT_ASSERT(i < ShapesOf(m, bodies.a) * of_b);
  return PairOf(m, m.body_shapes[m.first_shape[bodies.a] + static_cast<int>(i / of_b)],
                m.body_shapes[m.first_shape[bodies.b] + static_cast<int>(i % of_b)],
                key - (key - m.first_pair_id) % kPoints);
}

}  // namespace taut::sim
