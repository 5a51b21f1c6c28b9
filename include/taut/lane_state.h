/// Serialization of the state of one lane, for `Controller::Serialize` and
/// `SensorModel::Serialize`. The same sequence of calls writes and reads the data. Reading works in
/// any lane of a plant with the same controllers and sensors.
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
  /// Creates a writer that appends bytes to `to`.
  LaneState(int lane, int lanes, std::vector<std::uint8_t>& to)
      : lane_(static_cast<std::size_t>(lane)), lanes_(static_cast<std::size_t>(lanes)), to_(&to) {}
  /// Creates a reader of bytes from a writer with the same sequence of calls. Past the end it reads
  /// zeros, and `failed()` becomes true.
  LaneState(int lane, int lanes, std::span<const std::uint8_t> from)
      : lane_(static_cast<std::size_t>(lane)),
        lanes_(static_cast<std::size_t>(lanes)),
        from_(from) {}

  int lane() const noexcept { return static_cast<int>(lane_); }
  bool reads() const noexcept { return to_ == nullptr; }
  /// Reports that the state cannot be restored: `failed()` becomes true.
  void Fail() noexcept { failed_ = true; }
  /// Returns true after `Fail` or after a read past the end.
  bool failed() const noexcept { return failed_ || short_; }
  /// Returns the number of unread bytes.
  std::size_t left() const noexcept { return from_.size(); }
  /// Returns whether all bytes were read without failure.
  bool at_end() const noexcept { return from_.empty() && !failed(); }

  /// Serializes a number. Serialize structs member by member, because their padding is undefined.
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
  /// Serializes the values of this lane in `count` consecutive rows.
  template <class T>
  void Row(T* row, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) Value(row[i * lanes_ + lane_]);
  }
  /// Serializes the values of this lane in all rows of a vector.
  template <class T>
  void Row(std::vector<T>& row) {
    Row(row.data(), row.size() / lanes_);
  }
  /// Serializes the bit of this lane.
  void Bit(Lanes& lanes) {
    auto bit = static_cast<std::uint8_t>(lanes >> lane_ & 1u);
    Value(bit);
    lanes = (lanes & ~(Lanes{1} << lane_)) | Lanes{bit} << lane_;
  }

 private:
  std::size_t lane_, lanes_;
  std::vector<std::uint8_t>* to_ = nullptr;
  std::span<const std::uint8_t> from_;
  bool short_ = false, failed_ = false;
};

}  // namespace taut::plant
