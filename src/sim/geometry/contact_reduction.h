/// Reduction of a contact manifold to the maximum number of points of a pair (kMaxPointsPerPair).
#pragma once

#include "sim/geometry/touch_list.h"

namespace taut::sim {

class ManyTouches {
 public:
  /// Merges points with equal normals at a distance of at most `same_m`.
  ManyTouches(double same_m, double margin_m) noexcept
      : same2_(same_m * same_m), margin_m_(margin_m) {}

  /// Adds a point. `id` identifies its place, so that most points find their impulses for the warm
  /// start.
  void Add(const Vec3& point, const Vec3& normal, double gap_m, int id) noexcept {
    if (!(gap_m < margin_m_)) return;
    least_gap_m_ = Smaller(least_gap_m_, gap_m);
    for (int i = 0; i < count_; ++i) {
      const Vec3 apart = all_[i].point - point;
      if (Dot(apart, apart) <= same2_ && Dot(all_[i].normal, normal) > kSamePlane) return;
    }
    const One one{point, normal, gap_m, id};
    if (count_ < kRoom) {
      all_[count_++] = one;
      return;
    }
    int highest = 0;
    for (int i = 1; i < kRoom; ++i) {
      if (all_[i].gap_m > all_[highest].gap_m) highest = i;
    }
    if (gap_m < all_[highest].gap_m) all_[highest] = one;
  }

  double least_gap_m() const noexcept { return least_gap_m_; }

  /// Adds the points to a list. If there are too many, this function selects the nearest point,
  /// then among points of equal gap the outermost points in twelve directions. The selected points
  /// support the same loads as all points.
  void AddTo(TouchList& list) noexcept {
    if (count_ > kMaxPointsPerPair) Choose();
    bool taken[kMaxPointsPerPair] = {};
    // Points whose id is a valid feature keep this id.
    for (int round = 0; round < 2; ++round) {
      for (int i = 0; i < count_; ++i) {
        const One& one = all_[i];
        if ((one.id < kMaxPointsPerPair) != (round == 0)) continue;
        int feature = one.id % kMaxPointsPerPair;
        while (taken[feature]) feature = feature + 1 == kMaxPointsPerPair ? 0 : feature + 1;
        taken[feature] = true;
        list.Add(one.point, one.normal, one.gap_m, feature);
      }
    }
  }

 private:
  /// Normals with a larger cosine belong to one plane.
  static constexpr double kSamePlane = 1.0 - 1e-9;
  /// Gaps that differ by less than this fraction of the margin count as equal.
  static constexpr double kSameGap = 1e-2;
  static constexpr int kRoom = 96;

  struct One {
    Vec3 point, normal;
    double gap_m;
    int id;
  };

  void Choose() noexcept {
    // Sorts the points by gap; the sort is stable.
    for (int i = 1; i < count_; ++i) {
      for (int k = i; k > 0 && all_[k].gap_m < all_[k - 1].gap_m; --k) {
        const One swapped = all_[k];
        all_[k] = all_[k - 1], all_[k - 1] = swapped;
      }
    }
    const double same_m = kSameGap * Larger(margin_m_, 0.0);
    const double last_m = all_[kMaxPointsPerPair - 1].gap_m;
    int nearer = 1, end = kMaxPointsPerPair;
    while (all_[nearer].gap_m < last_m - same_m) ++nearer;
    while (end < count_ && all_[end].gap_m <= last_m + same_m) ++end;
    count_ = nearer;
    // The twelve directions are the corners of an icosahedron.
    constexpr double kGolden = 1.618033988749895;
    for (int axis = 0; axis < 3; ++axis) {
      for (int signs = 0; signs < 4; ++signs) {
        double way[3] = {0.0, 0.0, 0.0};
        way[axis] = (signs & 1) != 0 ? 1.0 : -1.0;
        way[(axis + 1) % 3] = (signs & 2) != 0 ? kGolden : -kGolden;
        int outermost = nearer;
        for (int i = nearer + 1; i < end; ++i) {
          if (Dot(Load(way), all_[i].point - all_[outermost].point) > 0.0) outermost = i;
        }
        if (outermost < count_ || count_ == kMaxPointsPerPair) continue;
        const One swapped = all_[count_];
        all_[count_++] = all_[outermost], all_[outermost] = swapped;
      }
    }
  }

  double same2_, margin_m_, least_gap_m_ = 1e300;
  One all_[kRoom];
  int count_ = 0;
};

}  // namespace taut::sim
