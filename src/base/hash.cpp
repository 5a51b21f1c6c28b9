#include "base/hash.h"

namespace taut::base {

std::string HashText(std::uint64_t hash) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string out(16, '0');
  for (auto digit = out.rbegin(); digit != out.rend(); ++digit, hash >>= 4) {
    *digit = kDigits[hash & 15];
  }
  return out;
}

}  // namespace taut::base
