/// Envelope of a world's snapshot with kind and checksum, to reject foreign or damaged data.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "env/plan.h"

namespace taut::env {

/// Returns a hash that is equal for environments with compatible snapshots.
std::uint64_t KindOf(const Plan& plan);

std::vector<std::uint8_t> Sealed(std::uint64_t kind, const std::vector<std::uint8_t>& saved);
/// Returns the contents. Nothing, with an error, if they are of another kind or damaged.
std::optional<std::span<const std::uint8_t>> Unsealed(std::uint64_t kind,
                                                      std::span<const std::uint8_t> sealed,
                                                      Diagnostics& out);

}  // namespace taut::env
