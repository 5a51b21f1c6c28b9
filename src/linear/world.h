/// A world that starts from a given state again and again, in numbers of one's choice: plain ones,
/// or such with a derivative.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/batch/batch_inside.h"
#include "simd/dual.h"

namespace taut::linear {

/// A plain number; the tag keeps its functions apart from those of the step.
struct OutsideOfSteps {};
using Plain = simd::Wide<1, OutsideOfSteps>;
using simd::Dual;

template <class Num>
class World {
 public:
  /// `at`: world 0 of a batch of that model. Its snapshot is where this one starts.
  World(std::shared_ptr<const Model> model, const Batch& at, double tolerance_m_per_s = 1e-10);

  /// Back to the start; no derivative of anything.
  void Reset();
  /// The start is as the world is now.
  void StartHere() { snapshot_ = batch_.Save(0); }
  Num Get(int row) const noexcept;
  void Set(int row, Num x) noexcept;
  /// The part of a row in a direction: what of it changes per unit. Plain: x += amount * unit.
  void Add(int row, double amount, double unit) noexcept;

  void Step(double step_s);
  /// What is seen of the cables, now.
  void Sense();

  const sim::Layout& layout() const noexcept { return inside_->layout; }
  const sim::View& view() const noexcept { return inside_->view; }
  const ModelDef& def() const noexcept { return batch_.model().def(); }
  /// Whether anything touches anything.
  bool touches() const { return !batch_.Contacts(0).empty(); }
  /// False where the machine has no lanes for derivatives.
  bool good() const noexcept { return good_; }
  std::uint32_t status_bits() const { return batch_.Status(0).bits; }

 private:
  Batch batch_;
  BatchInside::Impl* inside_;
  std::vector<std::uint8_t> snapshot_;
  bool good_ = true;
};

template <>
World<Plain>::World(std::shared_ptr<const Model> model, const Batch& at, double tolerance);
template <>
World<Dual>::World(std::shared_ptr<const Model> model, const Batch& at, double tolerance);
template <>
void World<Plain>::Step(double step_s);
template <>
void World<Dual>::Step(double step_s);

extern template class World<Plain>;
extern template class World<Dual>;

}  // namespace taut::linear
