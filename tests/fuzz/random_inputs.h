/// A fuzz target at full speed: without libFuzzer, without sanitizers, in any build. Its inputs are
/// random numbers that follow from a seed and the input's index, so that each can be had again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace taut::fuzz {

using Target = int (*)(const std::uint8_t* data, std::size_t size);

/// 1 to 256 bytes, by math::Random(seed, 0, index): the first number's remainder by 256 is the
/// length less one, the next ones are the bytes, eight each, the lowest first.
std::vector<std::uint8_t> RandomInput(std::uint64_t seed, std::uint64_t index);

struct Campaign {
  std::uint64_t seed = 1;
  long first = 0, count = 0;
  double seconds = 0;          ///< Ends then; 0: when all have been tried.
  unsigned timeout_s = 300;    ///< Of processor time; an input that takes more hangs.
  std::string found_prefix;    ///< An input that fails is kept as this, seed and index.
  bool shows_progress = true;  ///< On standard error.
};

/// Gives the target its inputs. 0, or 130 after Ctrl-C; how many were tried is in the last line of
/// standard output. An input at which the target crashes, aborts or hangs ends the program with
/// status 1, after saying which and keeping it.
int TryRandomInputs(const Campaign& campaign, Target target);

/// Gives the target the contents of a file. Ends the program as above.
void TryFile(const std::string& path, unsigned timeout_s, Target target);

}  // namespace taut::fuzz
