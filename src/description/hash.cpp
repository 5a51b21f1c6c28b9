#include "description/hash.h"

#include <fstream>
#include <iterator>
#include <string_view>

namespace taut::description {
namespace {

/// Fowler, Noll, Vo: http://www.isthe.com/chongo/tech/comp/fnv/
class Fnv1a {
 public:
  void Add(std::string_view bytes) {
    for (const char byte : bytes) {
      hash_ = (hash_ ^ static_cast<unsigned char>(byte)) * 1099511628211u;
    }
  }
  /// With its length, so that the border between two texts counts, too.
  void AddText(std::string_view text) {
    Add(std::to_string(text.size()) + ":");
    Add(text);
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 14695981039346656037u;
};

}  // namespace

std::uint64_t HashInputs(const std::vector<std::string>& files, const Overrides& overrides) {
  Fnv1a hash;
  for (const std::string& path : files) {
    std::ifstream in(path, std::ios::binary);
    hash.AddText(std::string(std::istreambuf_iterator<char>(in), {}));
  }
  for (const auto& [name, expression] : overrides) {
    hash.AddText(name);
    hash.AddText(expression);
  }
  return hash.value();
}

std::string HashText(std::uint64_t hash) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string out(16, '0');
  for (auto digit = out.rbegin(); digit != out.rend(); ++digit, hash >>= 4) {
    *digit = kDigits[hash & 15];
  }
  return out;
}

}  // namespace taut::description
