/// Loads and stores of rows (one number per lane) as SIMD registers, and allocation from a memory
/// block.
#pragma once

#include "simd/wide.h"

namespace taut::plant {

template <class W>
TAUT_INLINE W Load(const double* row, int i) noexcept {
  W x;
  __builtin_memcpy(&x, row + i * W::kLanes, sizeof(double) * W::kLanes);
  return x;
}
template <class W>
TAUT_INLINE void Store(double* row, int i, W x) noexcept {
  __builtin_memcpy(row + i * W::kLanes, &x, sizeof(double) * W::kLanes);
}

/// Allocates `count` objects from the caller's memory block and advances `end`.
template <class T>
T* Take(char*& end, int count) noexcept {
  T* const first = reinterpret_cast<T*>(end);
  end += sizeof(T) * static_cast<size_t>(count);
  return first;
}

}  // namespace taut::plant
