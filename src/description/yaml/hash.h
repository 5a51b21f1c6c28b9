/// A fingerprint of what a run depends on.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "taut/spec.h"

namespace taut::description {

/// FNV-1a (64 bit) of the bytes of the files and of the overrides, in order. Where the files are
/// and what they are called does not matter. A file that cannot be read counts as empty.
std::uint64_t HashInputs(const std::vector<std::string>& files, const Overrides& overrides);

}  // namespace taut::description
