// Reader of lines. zlib reads compressed and uncompressed files.
#include "trace/csv_lines.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

#include "base/open_input.h"
#include "trace/text_encoding.h"
#include "trace/unpack_limit.h"

namespace taut::trace {
namespace {

constexpr std::size_t kMaxLineBytes = 8 << 20;

/// Returns the reason why reading ended; empty at the end of the file.
std::string WhyItEnds(gzFile file) {
  int code = 0;
  std::string_view why = gzerror(file, &code);
  if (code == Z_OK || code == Z_STREAM_END) return {};
  if (code == Z_ERRNO) return fmt::format("cannot read: {}", std::strerror(errno));
  if (code == Z_BUF_ERROR)
    return "the file is truncated after this line: its compressed data is incomplete";
  // zlib begins with "<fd:4>: ", in place of a path.
  if (why.starts_with("<fd:")) why.remove_prefix(std::min(why.find(' ') + 1, why.size()));
  return fmt::format("the file is damaged after this line: {}", why);
}

bool ReadLines(gzFile file, double file_bytes, CsvTail tail,
               const std::function<bool(std::string_view)>& use, const std::string& path,
               TextEncoding encoding, Diagnostics& out) {
  int lines = 0;
  std::string text;
  ToUtf8 to_utf8(encoding);
  double unpacked_bytes = 0;
  char block[1 << 16];
  for (;;) {
    const int count = gzread(file, block, sizeof block);
    if (count <= 0) {
      const std::string why = WhyItEnds(file);
      if (why.empty()) {
        to_utf8.Append({}, text);
        if (tail == CsvTail::kLine && !text.empty()) use(text);
        return true;
      }
      out.Error("csv.damaged_gzip", {path, lines}, why,
                "save the readable part with `zcat` into a .csv");
      return false;
    }
    unpacked_bytes += count;
    if (unpacked_bytes > MostUnpackedBytes(file_bytes)) {
      out.Error("trace.too_large", {path}, fmt::format("the file unpacks to {}", kUnpackLimit),
                "if this size is intended, unpack it with `gunzip` first");
      return false;
    }
    to_utf8.Append(std::string_view(block, static_cast<std::size_t>(count)), text);
    std::size_t from = 0;
    for (std::size_t to; (to = text.find('\n', from)) != text.npos; from = to + 1) {
      ++lines;
      if (!use(std::string_view(text).substr(from, to - from))) return true;
    }
    text.erase(0, from);
    if (text.size() > kMaxLineBytes) {
      out.Error("csv.no_line_end", {path}, "the file is not CSV: it has no line end within 8 MB");
      return false;
    }
  }
}

}  // namespace

std::string_view Trim(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

bool ReadCsvLines(const std::string& path, CsvTail tail,
                  const std::function<bool(std::string_view)>& use, Diagnostics& out,
                  TextEncoding encoding) {
  base::OpenFile opened = base::OpenToRead(path);
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(
      opened ? gzdopen(opened.get(), "rb") : nullptr, gzclose);
  if (file == nullptr) {
    out.Error("file.not_readable", {path}, "cannot open: " + base::OpenError(errno));
    return false;
  }
  opened.Release();  // closed with `file`
  struct stat info {};
  const double bytes = stat(path.c_str(), &info) == 0 ? static_cast<double>(info.st_size) : 0.0;
  return ReadLines(file.get(), bytes, tail, use, path, encoding, out);
}

}  // namespace taut::trace
