// Fuzz target of CSV traces; a readable trace is compared with a copy of itself and written again.
#include <bit>

#include "fuzz/fuzz_folder.h"
#include "taut/compare.h"

namespace {

using taut::Diagnostics;
using taut::Trace;
using taut::fuzz::Must;

bool Same(double a, double b) { return a == b || (a != a && b != b); }

void CheckTrace(const Trace& trace, const taut::fuzz::Folder& folder) {
  Must(trace.values.size() == trace.channels.size(), "a column a channel");
  for (const auto& column : trace.values) {
    Must(column.size() == trace.time_s.size(), "as many values as times");
  }
  const taut::Comparison itself = Compare(trace, trace, {});
  Must(ComparisonTable(itself, "a", "b").size() + ComparisonJson(itself, "a", "b").size() > 0,
       "a comparison can be shown");
  for (const auto& channel : itself.channels) {
    Must(!(channel.rmse > 0), "a trace equals itself in " + channel.name);
  }
  const std::string path = folder.Path("again.csv");
  Diagnostics out;
  const auto writer = CreateCsvTrace(path, trace.channels, out);
  if (!writer) return;  // channel names that taut does not write
  std::vector<double> row(trace.channels.size());
  for (std::size_t i = 0; i < trace.time_s.size(); ++i) {
    for (std::size_t c = 0; c < row.size(); ++c) row[c] = trace.values[c][i];
    Must(writer->Append(trace.time_s[i], row.data()), "a row can be written");
  }
  Must(writer->Finish(), "a trace can be written");
  const auto again = ReadTrace(path, out);
  Must(again && again->time_s == trace.time_s && again->values.size() == row.size(),
       "what was written can be read: " + out.Format());
  for (std::size_t c = 0; c < row.size(); ++c) {
    for (std::size_t i = 0; i < trace.time_s.size(); ++i) {
      Must(Same(again->values[c][i], trace.values[c][i]), "what was read is what was written");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const taut::fuzz::Folder folder;
  // gzip is detected by its first bytes, so one target covers both kinds of file.
  Diagnostics out;
  const auto trace = taut::ReadTrace(folder.Write("t.csv", data, size), out);
  Must(trace.has_value() == out.ok(), "a trace or complaints");
  if (trace) CheckTrace(*trace, folder);
  return 0;
}
