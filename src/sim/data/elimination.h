/// Elimination order of bodies by minimum degree in a sparse linear system, with fill-in. Scalar
/// code without the standard library, shared by all instruction sets.
#pragma once

#include <stdint.h>

namespace taut::sim {

/// Pattern of the nonzero 6x6 blocks of a matrix over bodies, including fill-in. Bodies are
/// numbered in elimination order.
struct BlockPattern {
  /// Largest number of bodies with a table of all blocks. In larger patterns, `Find` searches for
  /// block numbers, so that the memory is proportional to the number of blocks.
  static constexpr int kMostInTable = 128;

  int* slot;         ///< [i * count + j]: number of block (i, j), or -1; unused in large patterns.
  int* below;        ///< [first_below[k] ...]: rows below the diagonal in column k, ascending.
  int* first_below;  ///< count + 1 elements.
  /// Numbers of bodies, of blocks in the lower triangle (stored first), and of all blocks.
  int count, lower_count, block_count;

  /// Returns the number of a block of the pattern, without the table.
  int Find(int i, int j) const noexcept;
};

/// Adjacency matrix of bodies that interact: one bit per pair, `words` words per body.
struct BodyGraph {
  uint64_t* bits;
  int count, words;

  static int WordsFor(int count) noexcept { return (count + 63) / 64; }
  uint64_t* Row(int i) const noexcept { return bits + static_cast<int64_t>(i) * words; }
  void Clear() noexcept;
  void Join(int i, int j) noexcept;
};

/// Orders bodies by minimum degree (ties: smallest number first). Sets `order` (k-th body to
/// eliminate), `place` (its inverse) and `pattern`; overwrites the graph. Returns false if more
/// than `block_capacity` blocks would be needed.
bool Eliminate(BodyGraph& graph, int block_capacity, int* order, int* place,
               BlockPattern& pattern) noexcept;

}  // namespace taut::sim
