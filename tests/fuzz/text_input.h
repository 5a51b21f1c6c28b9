/// For targets whose input is a text and nothing else: included once, it defines libFuzzer's
/// mutator.
#pragma once

#include "fuzz/text_mutator.h"

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  return taut::fuzz::MutateText(data, size, max_size, seed);
}
