// Fuzz target of fault scripts of a robot's boards. The first byte is the number of motors.
#include "taut/faults.h"

#include <cmath>

#include "fuzz/refusals.h"
#include "fuzz/text_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using taut::fuzz::Must;
  static const taut::fuzz::Folder folder;
  static const std::vector<std::string> all{"outer_top_1",  "outer_left_1", "outer_right_1",
                                            "inner_top_1",  "inner_left_2", "inner_right_1",
                                            "outer_right_2"};
  // Scripts in the source tree begin with '#' or 't', which keeps all motors.
  const std::size_t count = size == 0 ? 0 : std::min<std::size_t>(data[0] % 36, all.size());
  const std::vector<std::string> cables(all.begin(), all.begin() + static_cast<long>(count));
  taut::Diagnostics out;
  const auto script = taut::LoadFaults(folder.Write("input.yaml", data, size), cables, out);
  taut::fuzz::CheckReading(script.has_value(), out);
  if (!script) return 0;
  const int boards = static_cast<int>(cables.size() + 1) / 2;
  for (const taut::FaultSpec& fault : script->faults) {
    const std::string name = taut::FaultName(fault.kind);
    Must(!name.empty(), "a kind");
    Must(fault.at_s >= 0 && std::isfinite(fault.at_s) && fault.for_s > 0, "times of " + name);
    Must(fault.board >= -1 && fault.board < boards, "board of " + name);
    Must(fault.cable >= -1 && fault.cable < static_cast<int>(cables.size()), "cable of " + name);
    Must(std::isfinite(fault.drift_ppm) && std::isfinite(fault.force_n.value_or(0)),
         "numbers of " + name);
    Must(fault.flips_per_bit >= 0 && fault.flips_per_bit <= 1, "a probability");
  }
  return 0;
}
