/// One block of memory for a step, handed out in pieces that know their ends.
///
/// Two checks stand behind every index: builds with assertions compare it with the piece's count,
/// and under AddressSanitizer a zone behind every piece must not be touched. Without both a piece
/// is a pointer.
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

/// Elements of one type, one behind the other: a pointer that in builds with assertions knows its
/// end.
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
  // Of any integer: with one type the index of a pointer would fit others as well.
  template <class Index>
  TAUT_INLINE T& operator[](Index i) const noexcept {
#ifdef TAUT_ASSERTS
    TAUT_ASSERT(0 <= static_cast<ptrdiff_t>(i) && static_cast<ptrdiff_t>(i) < count_);
#endif
    return first_[i];
  }
  /// What is left from element `i` on.
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

/// Memory that is handed out piece by piece, each aligned to 64 bytes. Without memory only the
/// sizes count: adding to a null pointer would be undefined.
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
  /// Overwrites all that was handed out; the pieces have to be taken again, which costs nothing
  /// but under AddressSanitizer.
  void Fill(unsigned char byte) const noexcept {
#ifdef TAUT_ADDRESS_SANITIZER
    __asan_unpoison_memory_region(memory, used);
#endif
    __builtin_memset(memory, byte, used);
  }
};

}  // namespace taut::sim
