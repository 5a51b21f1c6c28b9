/// Hash (fingerprint) of texts and numbers.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace taut::base {

/// FNV-1a (64 bit), Fowler, Noll, Vo: http://www.isthe.com/chongo/tech/comp/fnv/
class Fnv1a {
 public:
  void Add(std::string_view bytes) {
    for (const char byte : bytes) {
      hash_ = (hash_ ^ static_cast<unsigned char>(byte)) * 1099511628211u;
    }
  }
  /// Adds a text with its length, so that the boundary between two texts matters.
  void AddText(std::string_view text) {
    Add(std::to_string(text.size()) + ":");
    Add(text);
  }
  /// Adds the bits of a number. Zeros of both signs are equal, and so are all NaNs, because files
  /// do not preserve these differences.
  void AddNumber(double x) {
    AddText(x != x ? "nan" : std::to_string(__builtin_bit_cast(std::uint64_t, x + 0.0)));
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 14695981039346656037u;
};

/// Returns 16 hexadecimal digits.
std::string HashText(std::uint64_t hash);

}  // namespace taut::base
