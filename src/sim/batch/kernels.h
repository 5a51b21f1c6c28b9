/// Instruction sets of the step that are linked into the program: all of TAUT_INSTRUCTION_SETS
/// (target taut_lanes), or only the scalar one (target taut_one_lane).
#pragma once

#include <string_view>

#include "sim/data/group.h"
#include "taut/world_batch.h"

namespace taut::sim {

/// Returns the kernel of an instruction set, or null if the program or the machine lacks it.
const Kernel* KernelOf(Simd simd);
/// Returns whether the program contains the instruction set with this name.
bool IsBuilt(std::string_view name);

}  // namespace taut::sim
