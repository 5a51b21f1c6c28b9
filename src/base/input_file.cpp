#include "base/input_file.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "base/open_input.h"
#include "taut/shipped.h"

namespace taut::base {
std::optional<std::string> ReadInputFile(const std::string& path, std::size_t most_bytes,
                                         const std::string& hint, Diagnostics& out,
                                         NamedBy named_by) {
  const auto refuse = [&](std::string what, const std::string& hint_of = {}) {
    out.Error("file.not_readable", {path, 0, 0}, std::move(what), hint_of);
    return std::nullopt;
  };
  const auto unreadable = [&](std::string what, int error) {
    out.Unreadable("file.not_readable", {path, 0, 0}, std::move(what) + OpenError(error),
                   named_by == NamedBy::kUser && error == ENOENT ? SimilarInput(path) : "");
    return std::nullopt;
  };
  std::error_code ignored;
  const auto size_limit = [&] {
    return refuse("the file is larger than " + std::to_string(most_bytes / 1'000'000) + " MB",
                  hint);
  };
  if (std::filesystem::is_directory(path, ignored)) {
    const std::filesystem::path inputs = std::filesystem::path(path) / "inputs.yaml";
    return refuse("the path is a directory, not a file",
                  std::filesystem::exists(inputs, ignored)
                      ? "the experiment of this run is in " + inputs.string()
                      : "");
  }
  if (std::filesystem::is_regular_file(path, ignored)) {
    if (std::filesystem::file_size(path, ignored) > most_bytes && !ignored) return size_limit();
  } else if (named_by == NamedBy::kFile && std::filesystem::exists(path, ignored)) {
    return refuse("the path is a pipe, socket or device (expected a regular file)");
  }
  const OpenFile file = OpenToRead(path);
  if (!file) return unreadable("cannot open: ", errno);
  std::string text;
  for (std::array<char, 65536> chunk; text.size() <= most_bytes;) {
    const ssize_t count = read(file.get(), chunk.data(), chunk.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return unreadable("cannot read: ", errno);
    if (count == 0) break;
    text.append(chunk.data(), static_cast<std::size_t>(count));
  }
  if (text.size() <= most_bytes) return text;
  return size_limit();
}

}  // namespace taut::base
