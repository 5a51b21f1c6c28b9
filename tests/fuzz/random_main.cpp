// TARGET_random_fuzz --inputs N [--seconds S] [--seed S] [--first I] [--found PREFIX]
// [--bases=F]...
//
// TARGET_random_fuzz FILE...
//
// script/fuzz TARGET --plain runs it. Status: 0 good, 1 an input failed, 2 usage, 130 Ctrl-C.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <string_view>

#include "fuzz/fuzz_folder.h"
#include "fuzz/random_inputs.h"

/// Custom mutator of the target; null if it has none.
extern "C" __attribute__((weak)) std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data,
                                                                     std::size_t size,
                                                                     std::size_t max_size,
                                                                     unsigned seed);

namespace {

template <class Number>
bool Read(std::string_view text, Number& to) {
  const auto end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, to);
  return error == std::errc() && stop == end && to >= 0;
}

/// Adds the files of a folder and of the folders in it, in the order of their paths.
bool AddBases(std::string_view folder, taut::fuzz::Inputs& bases) {
  namespace fs = std::filesystem;
  std::error_code failed;
  std::vector<std::string> paths;
  for (fs::recursive_directory_iterator at(folder, failed), end; !failed && at != end;
       at.increment(failed)) {
    if (at->is_regular_file()) paths.push_back(at->path().string());
  }
  std::sort(paths.begin(), paths.end());
  for (const std::string& path : paths) {
    const std::string text = taut::fuzz::ReadAll(path);
    if (!text.empty()) bases.emplace_back(text.begin(), text.end());
  }
  return !failed;
}

bool ReadOption(std::string_view name, std::string_view value, taut::fuzz::Campaign& campaign) {
  if (name == "--inputs") return Read(value, campaign.count);
  if (name == "--seconds") return Read(value, campaign.seconds);
  if (name == "--seed") return Read(value, campaign.seed);
  if (name == "--first") return Read(value, campaign.first);
  campaign.found_prefix = value;
  return name == "--found";
}

}  // namespace

int main(int argc, char** argv) {
  taut::fuzz::Campaign campaign;
  campaign.count = std::numeric_limits<long>::max();
  if (LLVMFuzzerCustomMutator != nullptr) campaign.mutator = LLVMFuzzerCustomMutator;
  bool files = false;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (!argument.starts_with("--")) {
      taut::fuzz::TryFile(argv[i], campaign.timeout_s, LLVMFuzzerTestOneInput);
      files = true;
    } else if (argument.starts_with("--bases=")) {
      if (AddBases(argument.substr(8), campaign.bases)) continue;
      std::fprintf(stderr, "cannot read the folder of %s\n", argv[i]);
      return 2;
    } else if (i + 1 == argc || !ReadOption(argument, argv[++i], campaign)) {
      std::fprintf(stderr, "bad option or value: %s\n", argv[i]);
      return 2;
    }
  }
  return files ? 0 : taut::fuzz::TryRandomInputs(campaign, LLVMFuzzerTestOneInput);
}
