/// Envelope of a snapshot with its kind and a checksum, to reject foreign or damaged data.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "taut/diagnostics.h"

namespace taut::plant {

/// Seals the snapshots of one class, "environment" or "simulation".
class Sealing {
 public:
  /// `kind`: hash that is equal if snapshots are compatible. `differences`: hint of the error for a
  /// snapshot of another kind. Both texts must outlive this object.
  Sealing(std::string_view class_name, std::uint64_t kind, std::string_view differences)
      : class_name_(class_name), kind_(kind), differences_(differences) {}

  std::vector<std::uint8_t> Seal(const std::vector<std::uint8_t>& saved) const;
  /// Returns the contents. Returns nothing and reports an error if the snapshot has another kind or
  /// is damaged.
  std::optional<std::span<const std::uint8_t>> Open(std::span<const std::uint8_t> sealed,
                                                    Diagnostics& out) const;

 private:
  std::string_view class_name_;
  std::uint64_t kind_;
  std::string_view differences_;
};

}  // namespace taut::plant
