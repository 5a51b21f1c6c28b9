/// Hash of the input files and overrides of a run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "taut/spec.h"

namespace taut::description {

/// Returns the 64-bit FNV-1a hash of the contents of the files and the overrides, in order. Paths
/// do not affect the hash. Deleted files and pipes that were already read count as empty. Returns
/// nothing and reports an error if reading fails.
std::optional<std::uint64_t> HashInputs(const std::vector<std::string>& files,
                                        const Overrides& overrides, Diagnostics& out);

}  // namespace taut::description
