// Fuzz target of logs: every guessed mapping is a valid mapping file, and reads the log or
// complains.
#include <string>

#include "fuzz/fuzz_folder.h"
#include "taut/compare.h"
#include "taut/guess_mapping.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using taut::fuzz::Must;
  static const taut::fuzz::Folder folder;
  static const taut::RobotNames robot{{"a0-c0", "a1-c1"}, {"strut"}, {"a0", "c0"}, {"knee"}};
  taut::Diagnostics out;
  const std::string log = folder.Write("t.csv", data, size);
  const auto guess = GuessMapping(log, robot, out);
  Must(guess.has_value() == out.ok(), "a guess or complaints");
  if (!guess) return 0;
  const auto* const text = reinterpret_cast<const std::uint8_t*>(guess->text.data());
  const std::string path = folder.Write("m.json", text, guess->text.size());
  const auto mapping = taut::LoadMapping(path, out);
  Must(mapping.has_value(), "a guessed mapping is valid: " + out.Format() + guess->text);
  const auto trace = ReadMapped(log, *mapping, path, out);
  Must(trace.has_value() == out.ok(), "a trace or complaints");
  return 0;
}
