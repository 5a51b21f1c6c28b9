// TARGET_random_fuzz --inputs N [--seconds S] [--seed S] [--first I] [--found PREFIX]
// TARGET_random_fuzz FILE...
//
// script/fuzz TARGET --plain runs it. Status: 0 good, 1 an input failed, 2 usage, 130 Ctrl-C.
#include <charconv>
#include <cstdio>
#include <limits>
#include <string_view>

#include "fuzz/random_inputs.h"

namespace {

template <class Number>
bool Read(std::string_view text, Number& to) {
  const auto end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, to);
  return error == std::errc() && stop == end && to >= 0;
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
  bool files = false;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (!argument.starts_with("--")) {
      taut::fuzz::TryFile(argv[i], campaign.timeout_s, LLVMFuzzerTestOneInput);
      files = true;
    } else if (i + 1 == argc || !ReadOption(argument, argv[++i], campaign)) {
      std::fprintf(stderr, "bad option or value: %s\n", argv[i]);
      return 2;
    }
  }
  return files ? 0 : taut::fuzz::TryRandomInputs(campaign, LLVMFuzzerTestOneInput);
}
