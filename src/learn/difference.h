/// Line-by-line difference (diff) of two texts for messages.
#pragma once

#include <string>

namespace taut::learn {

/// Returns "  - old line" and "  + new line" for each line that is in one text only: at most
/// twenty, long lines cut around the first difference.
std::string Difference(const std::string& old_text, const std::string& new_text);

}  // namespace taut::learn
