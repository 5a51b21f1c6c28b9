/// What is around the snapshot of a world, so that only what was written here is read.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "env/plan.h"

namespace taut::env {

/// The same for environments that understand each other's snapshots.
std::uint64_t KindOf(const Plan& plan);

std::vector<std::uint8_t> Sealed(std::uint64_t kind, const std::vector<std::uint8_t>& saved);
/// What was sealed. Nothing, and a complaint, if it is of another kind or not as it was.
std::optional<std::span<const std::uint8_t>> Unsealed(std::uint64_t kind,
                                                      std::span<const std::uint8_t> sealed,
                                                      Diagnostics& out);

}  // namespace taut::env
