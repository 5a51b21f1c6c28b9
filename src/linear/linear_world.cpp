#include "linear/linear_world.h"

#include <algorithm>
#include <utility>

#include "linear/step_dual.h"

namespace taut::linear {
namespace {

WorldBatchOptions OptionsOf(int worlds, Simd simd, double tolerance_m_per_s) {
  WorldBatchOptions options;
  options.worlds = worlds;
  options.simd = simd;
  options.tolerance_m_per_s = tolerance_m_per_s;
  return options;
}

/// Copy of all data that a step of a group reads and writes.
struct Kept {
  std::vector<double> rows;
  std::vector<int> slots_used;
  int touches_used;

  Kept(const sim::Group& group, int row_count, std::vector<int> slots)
      : rows(group.rows, group.rows + 2 * row_count),
        slots_used(std::move(slots)),
        touches_used(group.touches_used) {}
};

}  // namespace

template <>
World<Plain>::World(std::shared_ptr<const Model> model, const WorldBatch& at, double tolerance)
    : batch_(std::move(model), OptionsOf(1, Simd::kScalar, tolerance)),
      inside_(&BatchInside::Of(batch_)),
      snapshot_(at.Save(0)) {
  Reset();
}

// The interleaved rows of two worlds hold the rows of one world with dual numbers: value,
// derivative.
template <>
World<Dual>::World(std::shared_ptr<const Model> model, const WorldBatch& at, double tolerance)
    : batch_(std::move(model), OptionsOf(2, Simd::kSse2, tolerance)),
      inside_(&BatchInside::Of(batch_)),
      snapshot_(at.Save(0)),
      good_(batch_.lanes() == 2) {
  if (!good_) return;
  inside_->kernel = &kKernelDual;
  inside_->scratch[0] = AllocateScratch(kKernelDual, inside_->view);
  Reset();
}

template <class Num>
void World<Num>::Reset() {
  batch_.Restore(0, snapshot_);
  batch_.ClearStatus(0);
  sim::Group& g = inside_->groups[0];
  for (int row = 0; g.lanes == 2 && row < layout().rows; ++row) g.rows[2 * row + 1] = 0.0;
  // Inputs may apply forces to any node.
  for (int node = 0; node < view().node_count; ++node) inside_->ForceNode(0, node);
}

template <class Num>
Num World<Num>::Get(int row) const noexcept {
  Num x;
  const sim::Group& g = inside_->groups[0];
  std::memcpy(&x, g.rows + static_cast<std::ptrdiff_t>(g.lanes) * row, sizeof(Num));
  return x;
}

template <class Num>
void World<Num>::Set(int row, Num x) noexcept {
  const sim::Group& g = inside_->groups[0];
  std::memcpy(g.rows + static_cast<std::ptrdiff_t>(g.lanes) * row, &x, sizeof(Num));
}

template <class Num>
void World<Num>::Add(int row, double amount, double unit) noexcept {
  double* const x = &inside_->groups[0].rows[static_cast<std::ptrdiff_t>(inside_->lanes()) * row];
  if constexpr (sizeof(Num) == sizeof(double)) {
    *x += amount * unit;
  } else {
    x[1] += unit;
  }
}

template <>
void World<Plain>::Step(double step_s) {
  batch_.Step(step_s);
}

/// Steps with accurate derivatives. The solver stops when the laws hold to its tolerance,
/// regardless of derivatives. So the step is repeated with one Newton step from the impulses found.
/// This repetition makes derivatives exact for linear laws: cables, joints, and contacts, because
/// bodies are lifted slightly off their contacts (state_space.cpp). The solver's compliances leave
/// a small error, which a second repetition removes (L3).
template <>
void World<Dual>::Step(double step_s) {
  sim::Group& g = inside_->groups[0];
  const sim::Layout& l = layout();
  const auto each_impulse = [&](auto&& f) {
    const int contacts = view().ContactCapacity();
    for (int i = 0; i < 3 * contacts; ++i) f(l.contact_force + i);
    for (int i = 0; i < view().joint_row_count; ++i) f(l.joint_load + i);
    for (int c = 0; c < view().cable_count; ++c) {
      if (step_s * step_s * g.rows[2 * (l.stiff_k + c)] > kStiffFrom) f(l.tension + c);
    }
  };
  const Kept before(g, l.rows, inside_->slots_used);
  batch_.Step(step_s);
  const Kept after(g, l.rows, inside_->slots_used);
  std::copy(before.rows.begin(), before.rows.end(), g.rows);
  // Keep keys, forces and slip state of the contact memory consistent.
  inside_->slots_used = after.slots_used;
  g.slots_used = inside_->slots_used.data();
  g.touches_used = after.touches_used;
  for (const sim::RowInfo& row : sim::kStateRows) {
    if (row.role != sim::Role::kMemory) continue;
    const int first = 2 * (l.*row.first), count = 2 * row.width * view().ContactCapacity();
    std::copy_n(after.rows.begin() + first, count, g.rows + first);
  }
  each_impulse([&](int row) {
    for (const int part : {0, 1}) {
      g.rows[2 * row + part] = after.rows[static_cast<std::size_t>(2 * row + part)];
    }
  });
  batch_.Step(step_s);
}

template <class Num>
void World<Num>::Sense() {
  inside_->groups[0].sensed = false;
  inside_->Sense(0);
}

template class World<Plain>;
template class World<Dual>;

}  // namespace taut::linear
