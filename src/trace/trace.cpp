#include "taut/trace.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>

#include "trace/readers.h"

namespace taut {

std::optional<std::size_t> Trace::Find(const std::string& name) const {
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (channels[i].name == name) return i;
  }
  return std::nullopt;
}

std::optional<Trace> ReadTrace(const std::string& path, Diagnostics& out) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0) {
    out.Error("file.not_readable", {path}, fmt::format("cannot open: {}", std::strerror(errno)));
    return std::nullopt;
  }
  if (!S_ISREG(info.st_mode)) {
    out.Error("file.not_regular", {path}, "the trace is not a regular file");
    return std::nullopt;
  }
  if (path.ends_with(".h5")) return trace::ReadHdf5(path, out);
  if (path.ends_with(".csv") || path.ends_with(".csv.gz")) return trace::ReadCsv(path, out);
  if (path.ends_with(".mcap")) return trace::ReadMcap(path, out);
  out.Error(
      "trace.unknown_format", {path}, "unknown trace format",
      "expected .h5, .csv, .csv.gz or .mcap; `taut new mapping` writes a mapping for a log of "
      "another program, for `--map`");
  return std::nullopt;
}

}  // namespace taut
