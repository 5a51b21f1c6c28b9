// CSV writer for traces: one line per row. Numbers have the fewest digits from which the same
// number is read back.
#include <fmt/format.h>

#include <utility>

#include "base/number_text.h"
#include "taut/files.h"
#include "taut/trace.h"
#include "trace/channel_names.h"
#include "trace/flush_clock.h"
#include "trace/whole_csv.h"

namespace taut::trace {
namespace {

constexpr std::size_t kBlockBytes = 1 << 18;

class CsvWriter final : public TraceWriter {
 public:
  /// `whole`: publish the file when it is finished. Otherwise, publish it with its first row.
  CsvWriter(const std::string& path, std::size_t channel_count, bool whole)
      : path_(path), channel_count_(channel_count), whole_(whole), file_(path) {}

  ~CsvWriter() override {
    if (file_.published()) Finish();
  }

  bool Start(const std::vector<ChannelInfo>& channels) {
    if (!file_.Create()) return Fail(file_.why());
    text_ = "time_s";
    for (const ChannelInfo& channel : channels) text_ += "," + channel.name;
    text_ += '\n';
    return Write();
  }

  bool Append(double time_s, const double* values) override {
    if (!error_.empty()) return false;
    if (finished_) return Fail("the trace was already finished");
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
    return finished_ || !clock_.due() || Flush();
  }

  bool Finish() override {
    if (!error_.empty()) return false;
    if (std::exchange(finished_, true)) return true;
    return Flush() && ((file_.Sync() && file_.Publish()) || Fail(file_.why()));
  }

  const std::string& error() const override { return error_; }

 private:
  void AppendNumber(double number) {
    char digits[32];
    const auto end = base::ToChars(digits, digits + sizeof digits, number).ptr;
    text_.append(digits, static_cast<std::size_t>(end - digits));
  }

  bool Flush() {
    if (!Write()) return false;
    clock_.Flushed();
    return whole_ || file_.Publish() || Fail(file_.why());
  }

  bool Write() {
    if (!file_.Write(text_)) return Fail(file_.why());
    text_.clear();
    return true;
  }

  bool Fail(std::string why) {
    error_ = fmt::format("{}: cannot write: {}", path_, why);
    return false;
  }

  std::string path_, error_;
  std::size_t channel_count_;
  bool whole_;
  NewFile file_;
  bool finished_ = false;
  std::string text_;  ///< Complete lines that are not written yet.
  FlushClock clock_;
};

std::unique_ptr<TraceWriter> Create(const std::string& path,
                                    const std::vector<ChannelInfo>& channels, bool whole,
                                    Diagnostics& out) {
  if (!CheckChannelNames(path, channels, out)) return nullptr;
  auto writer = std::make_unique<CsvWriter>(path, channels.size(), whole);
  if (!writer->Start(channels)) {
    out.Error("trace.not_written", {}, writer->error());
    return nullptr;
  }
  return writer;
}

}  // namespace

std::unique_ptr<TraceWriter> CreateWholeCsvTrace(const std::string& path,
                                                 const std::vector<ChannelInfo>& channels,
                                                 Diagnostics& out) {
  return Create(path, channels, true, out);
}

}  // namespace taut::trace

namespace taut {

std::unique_ptr<TraceWriter> CreateCsvTrace(const std::string& path,
                                            const std::vector<ChannelInfo>& channels,
                                            Diagnostics& out) {
  return trace::Create(path, channels, false, out);
}

}  // namespace taut
