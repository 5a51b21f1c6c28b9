/// NTRT's tags: texts with words separated by blanks, compared as sets of words.
#pragma once

#include <algorithm>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace taut::import_ntrt {

using Words = std::vector<std::string>;

inline bool Has(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

inline Words Split(const std::string& text) {
  Words words;
  std::set<std::string> known;
  std::istringstream in(text);
  for (std::string word; in >> word;) {
    if (known.insert(word).second) words.push_back(word);
  }
  return words;
}

inline bool HasAll(const Words& words, const Words& wanted) {
  return std::all_of(wanted.begin(), wanted.end(), [&](const auto& w) { return Has(words, w); });
}

inline Words Without(const Words& words, const Words& gone) {
  Words left;
  for (const std::string& word : words) {
    if (!Has(gone, word)) left.push_back(word);
  }
  return left;
}

}  // namespace taut::import_ntrt
