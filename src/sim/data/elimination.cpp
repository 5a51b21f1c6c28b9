#include "sim/data/elimination.h"

#include "base/assert.h"

namespace taut::sim {
namespace {

int BitsIn(const uint64_t* row, int words) noexcept {
  int count = 0;
  for (int i = 0; i < words; ++i) count += __builtin_popcountll(row[i]);
  return count;
}
bool Has(const uint64_t* row, int i) noexcept { return (row[i / 64] >> (i % 64) & 1) != 0; }
void Take(uint64_t* row, int i) noexcept { row[i / 64] &= ~(uint64_t{1} << (i % 64)); }

/// Calls f(i) for each bit of a row, in ascending order.
template <class F>
void ForEachBit(const uint64_t* row, int words, F f) noexcept {
  for (int w = 0; w < words; ++w) {
    for (uint64_t bits = row[w]; bits != 0; bits &= bits - 1) f(64 * w + __builtin_ctzll(bits));
  }
}

}  // namespace

void BodyGraph::Clear() noexcept {
  for (int64_t i = 0; i < static_cast<int64_t>(count) * words; ++i) bits[i] = 0;
}

void BodyGraph::Join(int i, int j) noexcept {
  TAUT_ASSERT(0 <= i && i < count && 0 <= j && j < count);
  if (i == j) return;
  Row(i)[j / 64] |= uint64_t{1} << (j % 64);
  Row(j)[i / 64] |= uint64_t{1} << (i % 64);
}

bool Eliminate(BodyGraph& graph, int block_capacity, int* order, int* place,
               BlockPattern& pattern) noexcept {
  const int n = graph.count, words = graph.words;
  for (int i = 0; i < n; ++i) place[i] = -1;
  int lower = n;
  for (int k = 0; k < n; ++k) {
    int best = -1, least = n;
    for (int i = 0; i < n; ++i) {
      if (place[i] >= 0) continue;
      const int degree = BitsIn(graph.Row(i), words);
      if (degree < least) best = i, least = degree;
    }
    TAUT_ASSERT(best >= 0);  // degrees are below n
    order[k] = best;
    place[best] = k;
    lower += least;
    const uint64_t* const row = graph.Row(best);
    // The neighbors of the eliminated body become neighbors of each other. The row of the
    // eliminated body stays as the pattern of its column below the diagonal.
    ForEachBit(row, words, [&](int i) {
      uint64_t* const other = graph.Row(i);
      for (int w = 0; w < words; ++w) other[w] |= row[w];
      Take(other, i);
      Take(other, best);
    });
  }
  pattern.count = n;
  pattern.lower_count = lower;
  pattern.block_count = 2 * lower - n;
  if (pattern.block_count > block_capacity) return false;
  // Blocks of the lower triangle are numbered column by column, then those of the upper triangle
  // row by row.
  int used = 0;
  for (int k = 0; k < n; ++k) {
    pattern.first_below[k] = used;
    const uint64_t* const bits = graph.Row(order[k]);
    for (int i = k + 1; i < n; ++i) {
      if (Has(bits, order[i])) pattern.below[used++] = i;
    }
  }
  pattern.first_below[n] = used;
  TAUT_ASSERT(used == lower - n);
  if (n > BlockPattern::kMostInTable) return true;
  for (int i = 0; i < n * n; ++i) pattern.slot[i] = -1;
  for (int k = 0; k < n; ++k) {
    const int first = pattern.first_below[k];
    pattern.slot[k * n + k] = k + first;
    for (int q = first; q < pattern.first_below[k + 1]; ++q) {
      const int i = pattern.below[q];
      pattern.slot[i * n + k] = k + q + 1;
      pattern.slot[k * n + i] = lower + q;
    }
  }
  return true;
}

int BlockPattern::Find(int i, int j) const noexcept {
  const int column = i < j ? i : j, row = i < j ? j : i;
  int first = first_below[column], end = first_below[column + 1];
  if (i == j) return column + first;
  while (end - first > 1) {
    const int middle = first + (end - first) / 2;
    (below[middle] <= row ? first : end) = middle;
  }
  TAUT_ASSERT(first < end && below[first] == row);
  return i < j ? lower_count + first : column + first + 1;
}

}  // namespace taut::sim
