/// Fingerprint (hash) of the input files and overrides of a run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "taut/spec.h"

namespace taut::description {

/// Returns the 64-bit FNV-1a hash of the bytes of the files and of the overrides, in order. Names
/// and folders of the files are not included. A file that is gone, or a pipe that has been read,
/// counts as empty. Returns nothing and reports an error if reading fails.
std::optional<std::uint64_t> HashInputs(const std::vector<std::string>& files,
                                        const Overrides& overrides, Diagnostics& out);

}  // namespace taut::description
