/// Instruction sets for which the step of a simulation is compiled.
///
/// Threads: any number may call these functions at once.
#pragma once

#include <string_view>
#include <vector>

#include "taut/world_batch.h"

namespace taut {

struct InstructionSet {
  std::string_view name;  ///< As in TAUT_SIMD and in Python's `simd`.
  Simd simd = Simd::kScalar;
  bool is_built = false;   ///< Whether this build contains code for it.
  bool runs_here = false;  ///< Whether it is built and this processor supports it.
};

/// Returns all instruction sets that taut supports, on any processor.
std::vector<InstructionSet> InstructionSets();

}  // namespace taut
