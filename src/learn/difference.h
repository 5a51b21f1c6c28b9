/// Line-by-line difference (diff) of two texts for messages.
#pragma once

#include <string>

namespace taut::learn {

/// Returns "  - old line" and "  + new line" for lines that are in one text only. Shows at most
/// twenty lines and cuts long ones around the first difference.
std::string Difference(const std::string& old_text, const std::string& new_text);

}  // namespace taut::learn
