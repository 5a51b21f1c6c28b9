/// Instruction sets for which taut compiles the simulation step.
///
/// Threads: any number may call these functions concurrently.
#pragma once

#include <string_view>
#include <vector>

#include "taut/world_batch.h"

namespace taut {

struct InstructionSet {
  std::string_view name;  ///< Name in TAUT_SIMD, and in `simd` of Python.
  Simd simd = Simd::kScalar;
  bool is_built = false;   ///< Whether this build contains code for the instruction set.
  bool runs_here = false;  ///< Whether it is built and supported by this processor.
};

/// Returns all instruction sets that taut supports, on any processor.
std::vector<InstructionSet> InstructionSets();

}  // namespace taut
