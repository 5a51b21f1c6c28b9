/// libFuzzer's mutator for targets with text input. To be included once in a target.
#pragma once

#include "fuzz/text_mutator.h"

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  return taut::fuzz::MutateText(data, size, max_size, seed);
}
