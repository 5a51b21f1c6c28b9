// Reads a trace from HDF5 through a child process. Content of the pipe: texts as length and bytes,
// numbers in the machine's binary format.
//   error (empty: none) | cut_off | metadata count, key, text, ... | channel count, name, unit, ...
//   | row count | time | values of each channel, in blocks: error (empty: none), count, values
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

#include "trace/child_process.h"
#include "trace/hdf5_file.h"
#include "trace/readers.h"

namespace taut::trace {
namespace {

constexpr std::size_t kMemoryBytes = std::size_t{1} << 30;
constexpr std::uint64_t kBlockRows = 1 << 16;
constexpr std::uint64_t kMaxSentTextBytes = 64 << 20;
constexpr std::uint64_t kMaxCount = 1 << 20;

void SendNumber(const ChildOutput& to, std::uint64_t number) { to.Write(&number, sizeof number); }

void SendText(const ChildOutput& to, const std::string& text) {
  SendNumber(to, text.size());
  to.Write(text.data(), text.size());
}

void SendColumn(const ChildOutput& to, const Hdf5Column& column, std::uint64_t rows) {
  // Read whole chunks, since HDF5 unpacks a chunk for every block that contains a part of it.
  const std::uint64_t chunk = std::max<std::uint64_t>(column.chunk_rows, 1);
  const std::uint64_t most = std::min(rows, std::max<std::uint64_t>(kBlockRows / chunk, 1) * chunk);
  std::vector<double> block(most);
  for (std::uint64_t from = 0; from < rows; from += most) {
    const std::uint64_t count = std::min(rows - from, most);
    std::string error;
    const bool good = ReadHdf5Rows(column, from, count, block.data(), error);
    SendText(to, error);
    if (!good) return;
    SendNumber(to, count);
    to.Write(block.data(), count * sizeof(double));
  }
}

/// Child process: reads the file and sends its content.
void SendTrace(const std::string& path, const ChildOutput& to) {
  std::string error;
  const std::optional<Hdf5File> trace = OpenHdf5Trace(path, error);
  SendText(to, error);
  if (!trace) return;
  SendNumber(to, trace->cut_off ? 1 : 0);
  SendNumber(to, trace->metadata.size());
  for (const auto& [key, text] : trace->metadata) {
    SendText(to, key);
    SendText(to, text);
  }
  SendNumber(to, trace->channels.size());
  for (const Hdf5Column& channel : trace->channels) {
    SendText(to, channel.name);
    SendText(to, channel.unit);
  }
  SendNumber(to, trace->rows);
  SendColumn(to, trace->time, trace->rows);
  for (const Hdf5Column& channel : trace->channels) SendColumn(to, channel, trace->rows);
}

/// Parent process: receives and validates the content. Each function returns false at the first
/// inconsistency.
class Receiver {
 public:
  explicit Receiver(ChildProcess& child) : child_(child) {}

  bool Number(std::uint64_t& number, std::uint64_t most) {
    return child_.Read(&number, sizeof number) && number <= most;
  }

  bool Text(std::string& text) {
    std::uint64_t size = 0;
    if (!Number(size, kMaxSentTextBytes)) return false;
    text.resize(size);
    return child_.Read(text.data(), size);
  }

  bool Pairs(std::vector<std::pair<std::string, std::string>>& pairs) {
    std::uint64_t count = 0;
    if (!Number(count, kMaxCount)) return false;
    for (; count > 0; --count) {
      pairs.emplace_back();
      if (!Text(pairs.back().first) || !Text(pairs.back().second)) return false;
    }
    return true;
  }

  bool Column(std::vector<double>& values, std::uint64_t rows) {
    std::uint64_t count = 0;
    for (std::uint64_t from = 0; from < rows; from += count) {
      if (!Text(error) || !error.empty() || !Number(count, rows - from) || count == 0) return false;
      values.resize(from + count);
      if (!child_.Read(values.data() + from, count * sizeof(double))) return false;
    }
    return true;
  }

  /// Receives a trace. Returns false and sets `error` on failure; `error` is empty if the child
  /// ended early.
  bool All(Trace& trace) {
    std::uint64_t flag = 0, rows = 0;
    std::vector<std::pair<std::string, std::string>> channels;
    if (!Text(error) || !error.empty() || !Number(flag, 1) || !Pairs(trace.metadata) ||
        !Pairs(channels) || !Number(rows, UINT64_MAX)) {
      return false;
    }
    trace.unfinished = flag != 0;
    for (auto& [name, unit] : channels) trace.channels.push_back({name, unit});
    trace.values.resize(channels.size());
    if (!Column(trace.time_s, rows)) return false;
    for (std::vector<double>& column : trace.values) {
      if (!Column(column, rows)) return false;
    }
    return true;
  }

  std::string error;

 private:
  ChildProcess& child_;
};

/// Returns the number of leading rows with finite, increasing times.
std::size_t RisingRows(const std::vector<double>& time_s) {
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    if (!std::isfinite(time_s[i]) || (i > 0 && !(time_s[i] > time_s[i - 1]))) return i;
  }
  return time_s.size();
}

}  // namespace

std::optional<Trace> ReadHdf5(const std::string& path, Diagnostics& out) {
  ChildProcess child([&](const ChildOutput& to) { SendTrace(path, to); }, kMemoryBytes,
                     kChildPatience);
  Receiver receiver(child);
  Trace trace;
  if (!receiver.All(trace)) {
    std::string what = receiver.error;
    if (what.empty()) {
      const std::string how = child.End();
      what = "the trace is damaged: reading it " + (how.empty() ? "returned invalid data" : how);
    }
    out.Error("hdf5.damaged", {path}, what);
    return std::nullopt;
  }
  const std::size_t rows = RisingRows(trace.time_s);
  if (rows < trace.time_s.size() && !trace.unfinished) {
    out.Error("trace.damaged", {path},
              fmt::format("the trace is damaged: time does not increase at row {}", rows));
    return std::nullopt;
  }
  // Drop rows that an interrupted writer allocated but did not write.
  trace.time_s.resize(rows);
  for (std::vector<double>& column : trace.values) column.resize(rows);
  return trace;
}

}  // namespace taut::trace
