// Fuzz target of MCAP files.
#include "fuzz/fuzz_folder.h"
#include "taut/trace.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using taut::fuzz::Must;
  static const taut::fuzz::Folder folder;
  taut::Diagnostics out;
  const auto trace = taut::ReadTrace(folder.Write("t.mcap", data, size), out);
  Must(trace.has_value() == out.ok(), "a trace or complaints");
  if (!trace) return 0;
  Must(!trace->channels.empty(), "a trace has channels");
  for (const auto& column : trace->values) {
    Must(column.size() == trace->time_s.size(), "as many values as times");
  }
  for (std::size_t i = 1; i < trace->time_s.size(); ++i) {
    Must(trace->time_s[i] >= trace->time_s[i - 1], "times increase");
  }
  return 0;
}
