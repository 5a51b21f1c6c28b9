// Fuzz target of mapping files, applied to a trace in NTRT's format.
#include "fuzz/fuzz_folder.h"
#include "taut/compare.h"

namespace {

taut::Trace Foreign() {
  taut::Trace trace;
  for (const char* name : {"a_tension_N", "a_rest_length_m", "segment_0_x_m", "segment_0_y_m",
                           "segment_0_z_m", "segment_0_qx", "segment_0_qy", "segment_0_qz",
                           "segment_0_qw", "push_force_N", "contact_points"}) {
    trace.channels.push_back({name, "1"});
    trace.values.push_back({1.0, -2.5});
  }
  trace.time_s = {0.0, 0.1};
  return trace;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using taut::fuzz::Must;
  static const taut::fuzz::Folder folder;
  static const taut::Trace foreign = Foreign();
  taut::Diagnostics out;
  const auto mapping = taut::LoadMapping(folder.Write("m.json", data, size), out);
  Must(mapping.has_value() == out.ok(), "a mapping or complaints");
  if (!mapping) return 0;
  const auto mapped = ApplyMapping(*mapping, foreign, "t.csv", out);
  Must(mapped.has_value() == out.ok(), "a trace or complaints");
  if (!mapped) return 0;
  Must(mapped->channels.size() == foreign.channels.size(), "channels are renamed, not dropped");
  const taut::Comparison pair = Compare(*mapped, *mapped, {});
  Must(pair.channels.size() == foreign.channels.size(), "a trace has all channels of itself");
  return 0;
}
