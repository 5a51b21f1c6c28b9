/// What differs between two texts, for people.
#pragma once

#include <string>

namespace taut::learn {

/// "  - old line" and "  + new line" for each line that is only in one of them, long lines cut
/// around the first difference, at most twenty.
std::string Difference(const std::string& old_text, const std::string& new_text);

}  // namespace taut::learn
