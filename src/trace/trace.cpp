#include "taut/trace.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cmath>
#include <cstring>

#include "trace/readers.h"

namespace taut {

std::optional<Trace> trace::WithFiniteSpans(const std::string& path, std::optional<Trace> trace,
                                            Diagnostics& out) {
  constexpr double kMostTime_s = 1e100;
  if (!trace || trace->time_s.empty()) return trace;
  for (const double time_s : {trace->time_s.front(), trace->time_s.back()}) {  // times increase
    if (std::abs(time_s) <= kMostTime_s) continue;
    out.Error("trace.times_too_large", {path}, fmt::format("the time {} s is out of range", time_s),
              "expected at most 1e100 s");
    return std::nullopt;
  }
  return trace;
}

void WarnIfUnfinished(const Trace& trace, const std::string& path, const std::string& use,
                      Diagnostics& out) {
  if (!trace.unfinished) return;
  out.Warning("trace.unfinished", {path}, "the trace is unfinished", "the recorded part is " + use);
}

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
  if (path.ends_with(".h5")) return trace::WithFiniteSpans(path, trace::ReadHdf5(path, out), out);
  if (path.ends_with(".csv") || path.ends_with(".csv.gz")) {
    return trace::WithFiniteSpans(path, trace::ReadCsv(path, out), out);
  }
  if (path.ends_with(".mcap")) return trace::WithFiniteSpans(path, trace::ReadMcap(path, out), out);
  out.Error(
      "trace.unknown_format", {path}, "unknown trace format",
      "expected .h5, .csv, .csv.gz or .mcap; for a log of another program, write a mapping with "
      "`taut new mapping` and pass it to `--map`");
  return std::nullopt;
}

}  // namespace taut
