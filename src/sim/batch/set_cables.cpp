// Setters for the cables of a world: rest lengths, targets, bends.
#include "math/cable_wheel.h"
#include "sim/batch/batch_impl.h"

namespace taut {

void WorldBatch::Impl::ForgetBends(int world) noexcept {
  for (int i = 0; i < view.touch_rod_count; ++i) at(world, layout.touch_side + i) = 0.0;
  for (int i = 0; i < view.Count(sim::Per::kBend); ++i) {
    set(world, layout.bend + sim::kWidthWrapPoint * i, sim::kNoWrapPoint);
  }
  for (int c = 0; c < view.cable_count; ++c) {
    const sim::CableTable& cable = view.cables[c];
    if (cable.touch < 0) continue;
    for (int i = 0; i < cable.span_count; ++i) {
      at(world, layout.span_rest + cable.first_span + i) = i == 0 ? at(world, layout.rest + c) : 0;
      if (i > 0) at(world, layout.span_tension + cable.first_span + i) = 0;
    }
    for (int i = 0; i + 1 < cable.span_count; ++i) {
      at(world, layout.slip_place + cable.first_slip + i) = kNotHeld;
      at(world, layout.slip_along + cable.first_slip + i) = kNotHeld;
      at(world, layout.slip_height + cable.first_slip + i) = kNotHeld;
    }
  }
}

void WorldBatch::SetRestLengthTarget(int world, int cable, double rest_length_m) noexcept {
  impl_->CheckCable(__func__, world, cable);
  impl_->at(world, impl_->layout.target + cable) = rest_length_m;
  const int motor = impl_->view.cables[cable].motor;
  if (motor >= 0) impl_->Order(world, motor, &sim::MotorOrders<double>::by_duty, 0.0);
}

void WorldBatch::SetRestLength(int world, int cable, double rest_length_m) noexcept {
  Impl& d = *impl_;
  d.CheckCable(__func__, world, cable);
  const sim::CableTable& table = d.view.cables[cable];
  for (int i = 0; i < table.span_count; ++i) {
    d.at(world, d.layout.span_rest + table.first_span + i) *=
        rest_length_m / d.at(world, d.layout.rest + cable);
  }
  d.at(world, d.layout.rest + cable) = rest_length_m;
  d.at(world, d.layout.target + cable) = rest_length_m;
  d.at(world, d.layout.rest_rate + cable) = 0.0;
  d.StopMotor(world, cable);
  d.ForgetMeans(world);
}

}  // namespace taut
