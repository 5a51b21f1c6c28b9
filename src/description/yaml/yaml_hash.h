/// Fingerprint (hash) of the input files and overrides of a run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "taut/spec.h"

namespace taut::description {

/// Returns the 64-bit FNV-1a hash of the bytes of the files and of the overrides, in order. Names
/// and folders of the files are not included. An unreadable file counts as empty.
std::uint64_t HashInputs(const std::vector<std::string>& files, const Overrides& overrides);

}  // namespace taut::description
