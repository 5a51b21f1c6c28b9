/// What one lane remembers, as bytes: the same walk over it writes them and reads them back, into
/// any lane of the same loop or of one like it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "taut/plant.h"

namespace taut::plant {

class LaneState {
 public:
  /// Writes: appends to `to`.
  LaneState(int lane, int lanes, std::vector<std::uint8_t>& to)
      : lane_(static_cast<std::size_t>(lane)), lanes_(static_cast<std::size_t>(lanes)), to_(&to) {}
  /// Reads what such a walk wrote. Zeros behind the end.
  LaneState(int lane, int lanes, std::span<const std::uint8_t> from)
      : lane_(static_cast<std::size_t>(lane)),
        lanes_(static_cast<std::size_t>(lanes)),
        from_(from) {}

  int lane() const noexcept { return static_cast<int>(lane_); }
  bool reads() const noexcept { return to_ == nullptr; }
  /// Whether as many bytes were read as there were.
  bool at_end() const noexcept { return from_.empty() && !short_; }

  /// A number. (Structs have bytes that mean nothing; their numbers are named one by one.)
  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void Value(T& x) {
    if (!reads()) {
      const std::size_t at = to_->size();
      to_->resize(at + sizeof x);
      std::memcpy(to_->data() + at, &x, sizeof x);
      return;
    }
    short_ = short_ || sizeof x > from_.size();
    if (short_) {
      x = T{};
      return;
    }
    std::memcpy(&x, from_.data(), sizeof x);
    from_ = from_.subspan(sizeof x);
  }
  void Value(Vec3& v) { Values(v.x, v.y, v.z); }
  template <class... T>
  void Values(T&... x) {
    (Value(x), ...);
  }
  /// The lane's numbers of a row, or of `count` rows one after the other.
  template <class T>
  void Row(T* row, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) Value(row[i * lanes_ + lane_]);
  }
  /// All that a vector of as many rows as fit has of the lane.
  template <class T>
  void Row(std::vector<T>& row) {
    Row(row.data(), row.size() / lanes_);
  }
  /// The lane's bit.
  void Bit(Lanes& lanes) {
    auto bit = static_cast<std::uint8_t>(lanes >> lane_ & 1u);
    Value(bit);
    lanes = (lanes & ~(Lanes{1} << lane_)) | Lanes{bit} << lane_;
  }

 private:
  std::size_t lane_, lanes_;
  std::vector<std::uint8_t>* to_ = nullptr;
  std::span<const std::uint8_t> from_;
  bool short_ = false;
};

}  // namespace taut::plant
