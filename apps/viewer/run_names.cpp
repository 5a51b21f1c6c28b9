#include "run_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace taut::viewer {
namespace {

namespace fs = std::filesystem;

/// Returns the last `parts` components of a path, or all if it has fewer.
std::string Tail(const std::string& path, std::size_t parts) {
  const fs::path whole = fs::absolute(path).lexically_normal();
  fs::path tail;
  for (fs::path rest = whole; parts > 0 && rest.has_filename(); rest = rest.parent_path()) {
    tail = tail.empty() ? rest.filename() : rest.filename() / tail;
    --parts;
  }
  return tail.generic_string();
}

std::string NameOf(const NamedTrace& named, std::size_t parts) {
  std::string place = Tail(named.path, parts);
  for (const char* key : {"measured", "experiment"}) {
    const std::string name = Said(*named.trace, key);
    if (!name.empty()) return fmt::format("{} ({})", name, place);
  }
  return place;
}

}  // namespace

std::string Said(const Trace& trace, std::string_view key) {
  const auto found = std::find_if(trace.metadata.begin(), trace.metadata.end(),
                                  [&](const auto& pair) { return pair.first == key; });
  return found == trace.metadata.end() ? "" : found->second;
}

std::vector<std::string> RunNames(const std::vector<NamedTrace>& traces) {
  constexpr std::size_t kFolderAndFile = 2, kLongest = 64;
  std::vector<std::string> names;
  for (const NamedTrace& named : traces) names.push_back(NameOf(named, kFolderAndFile));
  for (std::size_t parts = kFolderAndFile + 1; parts <= kLongest; ++parts) {
    const std::vector<std::string> before = names;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (std::count(before.begin(), before.end(), before[i]) > 1) {
        names[i] = NameOf(traces[i], parts);
      }
    }
    if (names == before) break;
  }
  // Runs that still share a name are the same file.
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto end = names.begin() + static_cast<std::ptrdiff_t>(i);
    const std::string name = names[i];
    int number = 1;
    while (std::find(names.begin(), end, names[i]) != end) {
      names[i] = fmt::format("{} #{}", name, ++number);
    }
  }
  return names;
}

}  // namespace taut::viewer
