// Reads a trace from text. zlib reads plain files as they are, so compressed or not is one path.
#include <fmt/format.h>
#include <sys/stat.h>
#include <zlib.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <memory>
#include <string_view>

#include "trace/channel_names.h"
#include "trace/readers.h"
#include "trace/unpack_limit.h"

namespace taut::trace {
namespace {

constexpr std::size_t kMaxErrors = 20;
constexpr std::size_t kMaxLineBytes = 8 << 20;

std::string_view Trim(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// Takes the lines of one file and makes a trace of them.
class CsvParser {
 public:
  CsvParser(const std::string& path, Diagnostics& out) : path_(path), out_(out) {}

  /// False: too many errors to go on.
  bool Line(std::string_view line) {
    ++line_;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line_ == 1) return Header(line);
    if (line.empty()) {
      empty_line_ = empty_line_ == 0 ? line_ : empty_line_;
      return true;
    }
    if (empty_line_ > 0) return Error(empty_line_, 0, "an empty line between rows");
    Row(line);
    return error_count_ < kMaxErrors;
  }

  /// How many it was given.
  int lines() const { return line_; }

  std::optional<Trace> Take() {
    if (line_ == 0) Error(1, 0, "has no header line");
    if (error_count_ > 0) return std::nullopt;
    return std::move(trace_);
  }

 private:
  bool Header(std::string_view line) {
    if (line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);  // byte order mark
    std::size_t column = 0;
    ForEachCell(line, [&](std::string_view cell, int) {
      if (column++ > 0) {
        trace_.channels.push_back({std::string(cell), UnitOfName(cell)});
      } else if (cell != "time_s") {
        Error(1, 1, fmt::format("the first column is \"{}\"", cell),
              "the first column of a trace is time_s");
      }
    });
    trace_.values.resize(trace_.channels.size());
    if (error_count_ == 0 && !CheckChannelNames(path_, trace_.channels, out_)) ++error_count_;
    return error_count_ == 0;
  }

  void Row(std::string_view line) {
    row_.clear();
    bool good = true;
    ForEachCell(line, [&](std::string_view cell, int column) {
      double number = 0.0;
      const auto [end, failure] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
      if (failure == std::errc::result_out_of_range) {
        good = Error(line_, column, fmt::format("number \"{}\" is out of range", cell));
      } else if (failure != std::errc() || end != cell.data() + cell.size()) {
        good = Error(line_, column, fmt::format("\"{}\" is not a number", cell),
                     cell.empty() ? "write nan for a missing value" : "");
      }
      row_.push_back(number);
    });
    if (row_.size() != trace_.channels.size() + 1) {
      good = Error(line_, 0,
                   fmt::format("{} values where the header names {}", row_.size(),
                               trace_.channels.size() + 1));
    }
    if (!good) return;
    if (!std::isfinite(row_[0]) || (!trace_.time_s.empty() && !(row_[0] > trace_.time_s.back()))) {
      Error(line_, 1, fmt::format("time {} does not come after the row before", row_[0]),
            "times must rise");
      return;
    }
    trace_.time_s.push_back(row_[0]);
    for (std::size_t i = 0; i < trace_.channels.size(); ++i) {
      trace_.values[i].push_back(row_[i + 1]);
    }
  }

  /// Calls `use(cell, column)`; `column` counts bytes from 1.
  template <class Use>
  void ForEachCell(std::string_view line, const Use& use) {
    for (std::size_t from = 0; from <= line.size();) {
      const std::size_t to = std::min(line.find(',', from), line.size());
      use(Trim(line.substr(from, to - from)), static_cast<int>(from) + 1);
      from = to + 1;
    }
  }

  /// Always false.
  bool Error(int line, int column, std::string what, std::string hint = {}) {
    if (++error_count_ <= kMaxErrors) {
      out_.Error({path_, line, column}, std::move(what), std::move(hint));
    }
    return false;
  }

  const std::string& path_;
  Diagnostics& out_;
  Trace trace_;
  std::vector<double> row_;
  int line_ = 0;
  int empty_line_ = 0;  ///< The first of those that only the end of the file may have.
  std::size_t error_count_ = 0;
};

/// Why no more can be unpacked; empty at the end of the file.
std::string WhyItEnds(gzFile file, const std::string& path) {
  int code = 0;
  std::string_view why = gzerror(file, &code);
  if (code == Z_OK || code == Z_STREAM_END) return {};
  if (code == Z_ERRNO) return fmt::format("cannot be read: {}", std::strerror(errno));
  if (code == Z_BUF_ERROR) return "is cut off after this line: its packed data goes on";
  if (why.starts_with(path + ": ")) why.remove_prefix(path.size() + 2);
  return fmt::format("is damaged after this line: {}", why);
}

/// Hands every line that has its end to `parser`. What follows the last line end was cut off.
/// False, with a diagnostic, if the file cannot be read to its end.
bool ReadLines(gzFile file, double file_bytes, CsvParser& parser, const std::string& path,
               Diagnostics& out) {
  std::string text;
  double unpacked_bytes = 0;
  char block[1 << 16];
  for (;;) {
    const int count = gzread(file, block, sizeof block);
    if (count <= 0) {
      const std::string why = WhyItEnds(file, path);
      if (why.empty()) return true;
      out.Error({path, parser.lines()}, why, "`zcat` into a .csv keeps what is there");
      return false;
    }
    unpacked_bytes += count;
    if (unpacked_bytes > MostUnpackedBytes(file_bytes)) {
      out.Error({path}, fmt::format("unpacks to {}", kUnpackLimit),
                "if it is what it should be, unpack it with `gunzip` first");
      return false;
    }
    text.append(block, static_cast<std::size_t>(count));
    std::size_t from = 0;
    for (std::size_t to; (to = text.find('\n', from)) != text.npos; from = to + 1) {
      if (!parser.Line(std::string_view(text).substr(from, to - from))) return true;
    }
    text.erase(0, from);
    if (text.size() > kMaxLineBytes) {
      out.Error({path}, "is not a CSV file: no line end in 8 MB");
      return false;
    }
  }
}

}  // namespace

std::optional<Trace> ReadCsv(const std::string& path, Diagnostics& out) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (file == nullptr) {
    out.Error({path}, fmt::format("cannot be opened: {}", std::strerror(errno)));
    return std::nullopt;
  }
  struct stat info {};
  const double bytes = stat(path.c_str(), &info) == 0 ? static_cast<double>(info.st_size) : 0.0;
  CsvParser parser(path, out);
  if (!ReadLines(file.get(), bytes, parser, path, out)) return std::nullopt;
  return parser.Take();
}

}  // namespace taut::trace
