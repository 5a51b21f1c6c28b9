/// Arena allocator for the memory of a step, with bounds-checked arrays.
///
/// Index checks: builds with assertions compare each index with the size of the array, and
/// AddressSanitizer builds have a red zone after every array. Other builds use a plain pointer.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "base/assert.h"
#include "math/scalar.h"

#ifdef __SANITIZE_ADDRESS__
#define TAUT_ADDRESS_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define TAUT_ADDRESS_SANITIZER
#endif
#endif

#ifdef TAUT_ADDRESS_SANITIZER
extern "C" void __asan_poison_memory_region(const volatile void* first, size_t bytes);
extern "C" void __asan_unpoison_memory_region(const volatile void* first, size_t bytes);
#endif

namespace taut::sim {

/// Array of one type: a pointer; in builds with assertions also its end.
template <class T>
class Row {
 public:
  Row() = default;
  TAUT_INLINE Row(T* first, [[maybe_unused]] ptrdiff_t count) noexcept : first_(first) {
#ifdef TAUT_ASSERTS
    count_ = count;
#endif
  }
  template <ptrdiff_t N>
  TAUT_INLINE Row(T (&all)[N]) noexcept : Row(all, N) {}
  // A template over the integer type, because with one type, pointer indexing would be ambiguous.
  template <class Index>
  TAUT_INLINE T& operator[](Index i) const noexcept {
#ifdef TAUT_ASSERTS
    TAUT_ASSERT(0 <= static_cast<ptrdiff_t>(i) && static_cast<ptrdiff_t>(i) < count_);
#endif
    return first_[i];
  }
  /// Returns the rest of the array from element `i`.
  TAUT_INLINE Row From(ptrdiff_t i) const noexcept {
#ifdef TAUT_ASSERTS
    TAUT_ASSERT(0 <= i && i <= count_);
    return Row(first_ + i, count_ - i);
#else
    return Row(first_ + i, 0);
#endif
  }
  template <class Index>
  TAUT_INLINE friend T* operator+(const Row& row, Index i) noexcept {
    return row.From(static_cast<ptrdiff_t>(i)).data();
  }
  TAUT_INLINE operator T*() const noexcept { return first_; }
  TAUT_INLINE T* data() const noexcept { return first_; }

 private:
  T* first_;
#ifdef TAUT_ASSERTS
  ptrdiff_t count_;
#endif
};

/// Allocates arrays aligned to 64 bytes. Without memory, it only adds up sizes, because arithmetic
/// on a null pointer is undefined.
struct Room {
  char* memory;
  size_t used;

  template <class T>
  Row<T> Take(int64_t count) noexcept {
    T* const first = memory == nullptr ? nullptr : reinterpret_cast<T*>(memory + used);
    const size_t bytes = static_cast<size_t>(count) * sizeof(T);
    const size_t taken = (bytes + 63) / 64 * 64;
#ifdef TAUT_ADDRESS_SANITIZER
    constexpr size_t kZone = 64;
    if (memory != nullptr) {
      __asan_poison_memory_region(memory + used + bytes, taken - bytes + kZone);
    }
    used += taken + kZone;
#else
    used += taken;
#endif
    return {first, static_cast<ptrdiff_t>(count)};
  }
  /// Overwrites all allocated arrays. Allocate the arrays again, which costs nothing except under
  /// AddressSanitizer.
  void Fill(unsigned char byte) const noexcept {
#ifdef TAUT_ADDRESS_SANITIZER
    __asan_unpoison_memory_region(memory, used);
#endif
    __builtin_memset(memory, byte, used);
  }
};

}  // namespace taut::sim
