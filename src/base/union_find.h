/// Union-find (disjoint sets). Elements that were united, directly or indirectly, have the same
/// root.
#pragma once

#include <numeric>
#include <utility>
#include <vector>

namespace taut::base {

class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  /// Returns the smallest element of the set of i.
  int Root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  void Join(int a, int b) {
    a = Root(a);
    b = Root(b);
    if (a > b) std::swap(a, b);
    parent_[b] = a;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace taut::base
