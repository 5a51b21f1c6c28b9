// Fuzz target of gait files. An accepted gait is written and read back.
#include "taut/gait.h"

#include "fuzz/refusals.h"
#include "fuzz/small_folder.h"
#include "fuzz/text_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using taut::fuzz::Must;
  static const taut::fuzz::SmallFolder folder;
  taut::Diagnostics out;
  const auto gait = taut::LoadGait(folder.Write("gaits/input.yaml", data, size), out);
  taut::fuzz::CheckReading(gait.has_value(), out);
  if (!gait) return 0;
  const std::string text = GaitYaml(*gait);
  taut::Diagnostics again;
  const auto same = taut::LoadGait(folder.Write("again.yaml", text.data(), text.size()), again);
  Must(same.has_value(), "the written file can be read: " + again.Format() + text);
  Must(GaitYaml(*same) == text, "reading and writing gives the same text");
  return 0;
}
