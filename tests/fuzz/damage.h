/// Random damage to texts.
#pragma once

#include <iterator>
#include <random>
#include <string>

namespace taut::test {

class Damage {
 public:
  explicit Damage(unsigned seed) : random_(seed) {}

  std::string To(std::string text) {
    for (int i = Below(4); i >= 0; --i) Once(text);
    return text;
  }

 private:
  int Below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }

  void Once(std::string& text) {
    static const char* const kPieces[] = {
        "0",     "-1",   ".nan",       ".inf",    "1e308",    "1e-320",     "[",
        "]",     "{",    "}",          ": ",      "- ",       "\n",         "  ",
        "&a ",   "*a ",  "<<: *cable", "null",    "~",        "'",          "\"",
        "#",     "? ",   "| ",         "!!int ",  "segments", "edge_m / 0", "copies: 9999",
        "nodes", "\t",   "\xff",       "%",       "@",        "---\n",      "right",
        "tip",   "[[]]", "{}",         "radius_m"};
    const int at = Below(static_cast<int>(text.size()) + 1);
    switch (Below(5)) {
      case 0:
        text.erase(at, 1 + Below(3));
        break;
      case 1:
        text.erase(at, 1 + Below(60));
        break;
      case 2:
        text.insert(at, kPieces[Below(std::size(kPieces))]);
        break;
      case 3: {  // move a line
        const std::size_t begin = text.rfind('\n', at), end = text.find('\n', at);
        if (begin == std::string::npos || end == std::string::npos) break;
        const std::string line = text.substr(begin, end - begin);
        const std::size_t to = text.find('\n', Below(static_cast<int>(text.size())));
        if (to != std::string::npos) text.insert(to, line);
        break;
      }
      default:
        text[at % static_cast<int>(text.size())] = static_cast<char>(32 + Below(95));
        break;
    }
    if (text.empty()) text = " ";
  }

  std::mt19937 random_;
};

}  // namespace taut::test
