#include "description/yaml/yaml_hash.h"

#include <filesystem>
#include <limits>

#include "base/hash.h"
#include "base/input_file.h"

namespace taut::description {

std::optional<std::uint64_t> HashInputs(const std::vector<std::string>& files,
                                        const Overrides& overrides, Diagnostics& out) {
  constexpr auto kAnySize = std::numeric_limits<std::size_t>::max();
  base::Fnv1a hash;
  for (const std::string& path : files) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) {
      hash.AddText("");
      continue;
    }
    const auto text = base::ReadInputFile(path, kAnySize, "", out);
    if (!text) return std::nullopt;
    hash.AddText(*text);
  }
  for (const auto& [name, expression] : overrides) {
    hash.AddText(name);
    hash.AddText(expression);
  }
  return hash.value();
}

}  // namespace taut::description
