// Parameters of single worlds (masses, stiffnesses, friction, gravity) and the limits of their
// values.
#include <cmath>
#include <string>

#include "base/brief.h"
#include "sim/batch/batch_impl.h"

namespace taut {
namespace {

/// Returns the condition that `value` violates, with the unit, or null.
const char* BoundViolatedBy(Parameter parameter, double value) noexcept {
  const bool finite = std::isfinite(value);
  switch (parameter) {
    case Parameter::kBodyMass:
      return finite && value > 0 ? nullptr : "a positive number [kg]";
    case Parameter::kCableStiffness:
      return finite && value > 0 ? nullptr : "a positive number [N/m]";
    case Parameter::kCableDamping:
      return finite && value >= 0 ? nullptr : "zero or a positive number [N s/m]";
    case Parameter::kFrictionScale:
      return finite && value >= 0 ? nullptr : "zero or a positive number";
    default:
      return finite ? nullptr : "a finite number [m/s^2]";
  }
}

bool IsWithoutMass(const ModelDef& def, Parameter parameter, int index) noexcept {
  return parameter == Parameter::kBodyMass && def.bodies[static_cast<std::size_t>(index)].fixed;
}

}  // namespace

int WorldBatch::Impl::ParameterRow(const char* function, int world, Parameter parameter,
                                   int index) const noexcept {
  switch (parameter) {
    case Parameter::kBodyMass:
      CheckBody(function, world, index);
      return layout.mass + index;
    case Parameter::kCableStiffness:
      CheckCable(function, world, index);
      return layout.stiffness + index;
    case Parameter::kCableDamping:
      CheckCable(function, world, index);
      return layout.damping + index;
    default:
      break;
  }
  CheckWorld(function, world);
  sim::CheckIndex(function, "parameter of the world", index, 1);
  switch (parameter) {
    case Parameter::kFrictionScale:
      return layout.friction_scale;
    case Parameter::kGravityX:
      return layout.gravity;
    case Parameter::kGravityY:
      return layout.gravity + 1;
    default:
      return layout.gravity + 2;
  }
}

std::string WorldBatch::ParameterError(Parameter parameter, int index, double value) const {
  impl_->ParameterRow(__func__, 0, parameter, index);
  if (IsWithoutMass(model().def(), parameter, index)) return {};
  const char* const violated = BoundViolatedBy(parameter, value);
  if (violated == nullptr) return {};
  return std::string("must be ") + violated + ", got " + base::Brief(value);
}

bool WorldBatch::SetParameter(int world, Parameter parameter, int index, double value) noexcept {
  Impl& d = *impl_;
  const int row = d.ParameterRow(__func__, world, parameter, index);
  if (IsWithoutMass(d.model->def(), parameter, index)) return true;
  if (BoundViolatedBy(parameter, value) != nullptr) return false;
  if (parameter == Parameter::kBodyMass) {
    const BodyState state = Body(world, index);
    d.SetMass(world, index, value);
    d.JudgeStiffness(world);
    SetBodyState(world, index, state);  // keeps the velocity and updates the momentum
    return true;
  }
  d.at(world, row) = value;
  const bool of_cable =
      parameter == Parameter::kCableStiffness || parameter == Parameter::kCableDamping;
  if (of_cable) d.ForgetMeans(world);
  d.group(world).sensed = false;
  d.JudgeStiffness(world);
  return true;
}

double WorldBatch::GetParameter(int world, Parameter parameter, int index) const noexcept {
  return impl_->at(world, impl_->ParameterRow(__func__, world, parameter, index));
}

}  // namespace taut
