/// The order in which bodies are eliminated from a linear system, and the blocks that this fills.
/// Scalar code without the standard library, the same for every instruction set.
#pragma once

#include <stdint.h>

namespace taut::sim {

/// Which 6x6 blocks of a matrix over bodies there are, fill-in included. Bodies are numbered in the
/// order of elimination.
struct BlockPattern {
  int* slot;         ///< [i * count + j]: number of block (i, j), or -1.
  int* below;        ///< [first_below[k] ...]: rows under the diagonal of column k, rising.
  int* first_below;  ///< count + 1 of them.
  int count, lower_count, block_count;  ///< Bodies; blocks of the lower triangle, which come first.
};

/// Who acts on whom: a bit a pair of bodies, `words` words a body.
struct BodyGraph {
  uint64_t* bits;
  int count, words;

  static int WordsFor(int count) noexcept { return (count + 63) / 64; }
  uint64_t* Row(int i) const noexcept { return bits + static_cast<int64_t>(i) * words; }
  void Clear() noexcept;
  void Join(int i, int j) noexcept;
};

/// Minimum degree, the lowest number first among equals. Fills `order` (the k-th to be eliminated),
/// `place` (its inverse) and `pattern`; spends the graph. False if there would be more blocks than
/// `block_capacity`.
bool Eliminate(BodyGraph& graph, int block_capacity, int* order, int* place,
               BlockPattern& pattern) noexcept;

}  // namespace taut::sim
