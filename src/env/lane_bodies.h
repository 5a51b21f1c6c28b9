/// Poses and velocities of the bodies of all lanes of a group.
#pragma once

#include <cstddef>
#include <vector>

#include "plant/body_channels.h"
#include "plant/lane_kernel.h"
#include "sim/batch/batch_inside.h"

namespace taut::env {

class LaneBodies {
 public:
  /// `batch` must have one group and outlive this object.
  explicit LaneBodies(WorldBatch& batch)
      : batch_(batch),
        kernel_(plant::LaneKernelOf(batch.lanes())),
        lanes_(static_cast<std::size_t>(batch.lanes())),
        count_(batch.model().def().bodies.size()),
        rows_(kNumbers * count_ * lanes_) {
    const BatchInside::Impl& inside = BatchInside::Of(batch);
    const sim::Layout& layout = inside.layout;
    const auto row = [&](int first) { return count_ > 0 ? &inside.at(0, first) : nullptr; };
    from_ = {static_cast<int>(count_),  row(layout.pos), row(layout.quat),
             row(layout.vel),           row(layout.mom), row(layout.inv_inertia),
             inside.model->q_WP0.data()};
    for (int b = 0; b < from_.count; ++b) {
      if (inside.view.HasMotion(b)) moved_.push_back(b);
    }
  }

  /// Reads the current states.
  void Read() {
    kernel_.bodies(from_, rows_.data());
    for (const int body : moved_) {
      for (std::size_t j = 0; j < lanes_; ++j) ReadMoved(static_cast<std::size_t>(body), j);
    }
  }

  std::size_t count() const noexcept { return count_; }
  Vec3 position_m(std::size_t lane, std::size_t body) const noexcept { return At(lane, body, 0); }
  Quat orientation(std::size_t lane, std::size_t body) const noexcept {
    const double* const q = Row(body, 3) + lane;
    return {q[0], q[lanes_], q[2 * lanes_], q[3 * lanes_]};
  }
  Vec3 velocity_m_per_s(std::size_t lane, std::size_t body) const noexcept {
    return At(lane, body, 7);
  }
  /// Returns the values of a channel for all lanes. `channel`: index in `BodyChannels`. The pointer
  /// remains valid.
  const double* Row(std::size_t body, std::size_t channel) const noexcept {
    return rows_.data() + (kNumbers * body + channel) * lanes_;
  }

 private:
  static constexpr std::size_t kNumbers = std::tuple_size_v<plant::BodyNumbers>;

  Vec3 At(std::size_t lane, std::size_t body, std::size_t channel) const noexcept {
    const double* const v = Row(body, channel) + lane;
    return {v[0], v[lanes_], v[2 * lanes_]};
  }
  void ReadMoved(std::size_t body, std::size_t lane) {
    plant::BodyNumbers numbers;
    plant::PutBody(batch_.Body(static_cast<int>(lane), static_cast<int>(body)), numbers.data());
    for (std::size_t k = 0; k < kNumbers; ++k) {
      rows_[(kNumbers * body + k) * lanes_ + lane] = numbers[k];
    }
  }

  WorldBatch& batch_;
  const plant::LaneKernel& kernel_;
  std::size_t lanes_, count_;
  std::vector<double> rows_;
  plant::BodyRows from_;
  std::vector<int> moved_;  ///< Indices of kinematic bodies.
};

}  // namespace taut::env
