/// World that restarts repeatedly from a given state, in plain or dual numbers.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/batch/batch_inside.h"
#include "simd/dual.h"

namespace taut::linear {

/// Tag that makes `Plain` a separate type. The step has other instances of the same templates,
/// compiled with other options.
struct OutsideOfSteps {};
using Plain = simd::Wide<1, OutsideOfSteps>;
using simd::Dual;

template <class Num>
class World {
 public:
  /// `at`: batch of the same model. Its world 0 is the start.
  World(std::shared_ptr<const Model> model, const WorldBatch& at, double tolerance_m_per_s = 1e-10);

  /// Returns to the start and clears all derivatives.
  void Reset();
  /// Makes the current state the start.
  void StartHere() { snapshot_ = batch_.Save(0); }
  Num Get(int row) const noexcept;
  void Set(int row, Num x) noexcept;
  /// Adds `amount` * `unit` to a row of plain numbers, or `unit` to the derivative of a row of dual
  /// numbers.
  void Add(int row, double amount, double unit) noexcept;

  void Step(double step_s);
  /// Updates the cable readings.
  void Sense();

  const sim::Layout& layout() const noexcept { return inside_->layout; }
  const sim::View& view() const noexcept { return inside_->view; }
  const ModelDef& def() const noexcept { return batch_.model().def(); }
  /// Returns whether there is any contact.
  bool touches() const { return !batch_.Contacts(0).empty(); }
  /// Returns false if this build or machine does not support derivatives.
  bool good() const noexcept { return good_; }
  std::uint32_t status_bits() const { return batch_.Status(0).bits; }

 private:
  WorldBatch batch_;
  BatchInside::Impl* inside_;
  std::vector<std::uint8_t> snapshot_;
  bool good_ = true;
};

template <>
World<Plain>::World(std::shared_ptr<const Model> model, const WorldBatch& at, double tolerance);
template <>
World<Dual>::World(std::shared_ptr<const Model> model, const WorldBatch& at, double tolerance);
template <>
void World<Plain>::Step(double step_s);
template <>
void World<Dual>::Step(double step_s);

extern template class World<Plain>;
extern template class World<Dual>;

}  // namespace taut::linear
