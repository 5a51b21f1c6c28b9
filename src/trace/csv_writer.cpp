// A trace as text: one line a row, the shortest digits that read back as the same number.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <utility>

#include "taut/trace.h"
#include "trace/channel_names.h"

namespace taut::trace {
namespace {

constexpr std::size_t kBlockBytes = 1 << 18;

/// As in the HDF5 writer: half of what the interface promises.
constexpr std::chrono::milliseconds kMaxAge{500};

class CsvWriter final : public TraceWriter {
 public:
  CsvWriter(std::string path, std::size_t channel_count)
      : path_(std::move(path)), channel_count_(channel_count) {}

  ~CsvWriter() override { Finish(); }

  bool Start(const std::vector<ChannelInfo>& channels) {
    file_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file_ < 0) return Fail(std::strerror(errno));
    text_ = "time_s";
    for (const ChannelInfo& channel : channels) text_ += "," + channel.name;
    text_ += '\n';
    return Flush();
  }

  bool Append(double time_s, const double* values) override {
    if (!error_.empty()) return false;
    if (file_ < 0) return Fail("was finished before this row");
    AppendNumber(time_s);
    for (std::size_t i = 0; i < channel_count_; ++i) {
      text_ += ',';
      AppendNumber(values[i]);
    }
    text_ += '\n';
    return text_.size() < kBlockBytes ? FlushOld() : Flush();
  }

  bool FlushOld() override {
    if (!error_.empty()) return false;
    return file_ < 0 || std::chrono::steady_clock::now() - flushed_ < kMaxAge || Flush();
  }

  bool Finish() override {
    if (file_ >= 0 && error_.empty()) Flush();
    const int file = std::exchange(file_, -1);
    if (file >= 0 && close(file) != 0 && error_.empty()) Fail(std::strerror(errno));
    return error_.empty();
  }

  const std::string& error() const override { return error_; }

 private:
  void AppendNumber(double number) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, number).ptr;
    text_.append(digits, static_cast<std::size_t>(end - digits));
  }

  bool Flush() {
    std::size_t done = 0;
    while (done < text_.size()) {
      const ssize_t count = write(file_, text_.data() + done, text_.size() - done);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) return Fail(std::strerror(errno));
      done += static_cast<std::size_t>(count);
    }
    text_.clear();
    flushed_ = std::chrono::steady_clock::now();
    return true;
  }

  bool Fail(std::string why) {
    error_ = fmt::format("{}: cannot be written: {}", path_, why);
    return false;
  }

  std::string path_, error_;
  std::size_t channel_count_;
  int file_ = -1;
  std::string text_;  ///< Whole lines, not yet written.
  std::chrono::steady_clock::time_point flushed_;
};

}  // namespace
}  // namespace taut::trace

namespace taut {

std::unique_ptr<TraceWriter> CreateCsvTrace(const std::string& path,
                                            const std::vector<ChannelInfo>& channels,
                                            Diagnostics& out) {
  if (!trace::CheckChannelNames(path, channels, out)) return nullptr;
  auto writer = std::make_unique<trace::CsvWriter>(path, channels.size());
  if (!writer->Start(channels)) {
    out.Error({}, writer->error());
    return nullptr;
  }
  return writer;
}

}  // namespace taut
