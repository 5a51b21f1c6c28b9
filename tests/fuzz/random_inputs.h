/// Runs a fuzz target at full speed: without libFuzzer, without sanitizers, in any build. Its
/// inputs are random bytes or mutations of given inputs, determined by a seed and the input's
/// index, so that each can be reproduced.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace taut::fuzz {

using Target = int (*)(const std::uint8_t* data, std::size_t size);
/// As libFuzzer's custom mutator: changes `data` in place and returns its new size.
using Mutator = std::size_t (*)(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                unsigned seed);
using Inputs = std::vector<std::vector<std::uint8_t>>;

/// Returns 1 to 256 bytes, by math::Random(seed, 0, index): the first number modulo 256 is the
/// length minus one, the next numbers are the bytes, eight each, the lowest first.
std::vector<std::uint8_t> RandomInput(std::uint64_t seed, std::uint64_t index);

/// Returns one of `bases`, which are not empty, after 1 to 4 mutations; of at most `kMostMutated`
/// bytes, if no base is longer. `mutator` may call `LLVMFuzzerMutate`.
std::vector<std::uint8_t> MutatedInput(std::uint64_t seed, std::uint64_t index, const Inputs& bases,
                                       Mutator mutator);
inline constexpr std::size_t kMostMutated = 4096;

/// Changes, inserts, removes or copies a few bytes.
std::size_t MutateBytes(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed);

struct Campaign {
  std::uint64_t seed = 1;
  long first = 0, count = 0;
  double seconds = 0;          ///< Time limit [s]; 0: ends after all inputs.
  unsigned timeout_s = 300;    ///< Limit of the processor time [s]; longer inputs count as hangs.
  std::string found_prefix;    ///< A failing input is written to a file named by this prefix, seed
                               ///< and index.
  bool shows_progress = true;  ///< Whether progress is written to standard error.
  Inputs bases;                ///< Inputs to mutate; empty: random bytes.
  Mutator mutator = MutateBytes;
};

/// Runs the target on the inputs. Returns 0, or 130 after Ctrl-C; the last line of standard output
/// contains the number of inputs run. An input at which the target crashes, aborts or hangs ends
/// the program with status 1, after it was reported and written to a file.
int TryRandomInputs(const Campaign& campaign, Target target);

/// Runs the target on the contents of a file. Ends the program as above.
void TryFile(const std::string& path, unsigned timeout_s, Target target);

}  // namespace taut::fuzz
