/// Diverse worlds of one model, and hashes of their runs.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/physics/world.h"
#include "tests/scenes/block_on_slope.h"
#include "tests/scenes/hanging_mass.h"
#include "tests/scenes/jumble.h"
#include "tests/scenes/prism3.h"
#include "tests/scenes/tetraspine3.h"
#include "tests/scenes/walker.h"

namespace taut::test {

/// Pseudorandom numbers that are the same on every machine.
class Dice {
 public:
  explicit Dice(int seed) : state_(0x9e3779b97f4a7c15u * static_cast<std::uint64_t>(seed + 1)) {}
  /// Returns a number between -size and size.
  double Roll(double size) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    const auto top = static_cast<double>(state_ >> 11);  // 53 bits
    return size * (top / 4503599627370496.0 - 1);        // 2^52
  }
  Vec3 Roll3(double size) {
    const double x = Roll(size), y = Roll(size), z = Roll(size);
    return {x, y, z};
  }

 private:
  std::uint64_t state_;
};

/// Returns a spine whose cables are wound by motors with different parameters, on two supplies.
inline ModelDef MotorizedSpine() {
  ModelDef def = scenes::Tetraspine().Def();
  def.name = "tetraspine3_motors";
  int number = 0;
  for (CableDef& cable : def.cables) {
    DcMotorDef motor;
    motor.gear_ratio = number % 3 == 0 ? 43 : 76;
    motor.gear_efficiency = 0.4 + 0.05 * number;
    motor.backlash_rad = number % 4 == 1 ? 0.03 : 0;
    motor.supply = number % 2 == 0 ? "left" : "right";
    motor.supply_resistance_ohm = number % 2 == 0 ? 0.3 : 2;
    cable.actuator.kind = ActuatorDef::Kind::kDcMotor;
    cable.actuator.dc_motor = motor;
    ++number;
  }
  return def;
}

inline std::vector<ModelDef> VariedModels() {
  scenes::Prism3 prism;
  prism.clearance_m = 0.02;
  scenes::BlockOnSlope block;
  block.slope.angle_rad = 0.3;
  ModelDef along_slip = scenes::Tetraspine().Def();
  along_slip.name = "tetraspine3_along_slip";
  along_slip.friction_law = FrictionLaw::kAlongSlip;
  for (CableDef& cable : along_slip.cables) cable.damping_law = DampingLaw::kClamped;
  // In a wedge, a box touches both planes, with different corners in each world: directions and
  // numbers of contacts differ between lanes.
  ModelDef wedge = scenes::BlockOnSlope{{.angle_rad = 0.6}}.Def();
  wedge.name = "block_in_wedge";
  wedge.planes.push_back(wedge.planes[0]);
  wedge.planes[1].normal.x *= -1;
  ModelDef wedge_along_slip = wedge;
  wedge_along_slip.name = "block_in_wedge_along_slip";
  wedge_along_slip.friction_law = FrictionLaw::kAlongSlip;
  return {wedge,
          wedge_along_slip,
          scenes::Tetraspine().Def(),
          along_slip,
          prism.Def(),
          block.Def(),
          scenes::Jumble().Def(),
          MotorizedSpine(),
          scenes::Walker().Def()};
}

/// Sets the start of world `world` as determined by `seed`: places, velocities, parameters.
inline void Scatter(WorldBatch& batch, int world, int seed) {
  const ModelDef& def = batch.model().def();
  Dice dice(seed);
  const int bodies = static_cast<int>(def.bodies.size());
  const Vec3 together = dice.Roll3(0.2);
  const bool jointed = !def.joints.empty();  // then all bodies move alike
  const Vec3 speed = jointed ? dice.Roll3(0.5) : Vec3{};
  for (int b = 0; b < bodies; ++b) {
    batch.SetParameter(world, Parameter::kBodyMass, b,
                       def.bodies[static_cast<std::size_t>(b)].mass_kg * (1 + dice.Roll(0.2)));
    BodyState state = batch.Body(world, b);
    // Every third world stays upright at its place; the others start higher and oblique.
    if (seed % 3 != 0 && jointed) {
      state.position_m = state.position_m + together + Vec3{0, 0, 0.2};
    } else if (seed % 3 != 0) {
      state.position_m = state.position_m + together + dice.Roll3(0.01) + Vec3{0, 0, 0.2};
      state.orientation = scenes::Turn({0, 0, 1}, dice.Roll(3)) * state.orientation;
      if (seed % 3 == 2)
        state.orientation = scenes::Turn({1, 0, 0}, dice.Roll(3)) * state.orientation;
    }
    state.velocity_m_per_s = jointed ? speed : dice.Roll3(0.5);
    if (!jointed) state.angular_velocity_rad_per_s = dice.Roll3(2);
    batch.SetBodyState(world, b, state);
  }
  for (int c = 0; c < static_cast<int>(def.cables.size()); ++c) {
    const CableDef& cable = def.cables[static_cast<std::size_t>(c)];
    const double damping = cable.damping_n_s_per_m * (1 + dice.Roll(0.9));
    batch.SetParameter(world, Parameter::kCableDamping, c, damping);
    double stiffness = cable.stiffness_n_per_m * (1 + dice.Roll(0.5));
    if (seed % 4 == 3 && c % 2 == 0) {
      // Too stiff for explicit forces: neighbors use the other cable scheme. The tension is
      // preserved.
      const double tension = std::max(
          stiffness * (batch.Cable(world, c).length_m - batch.Cable(world, c).rest_length_m), 0.0);
      stiffness *= 1e4;
      if (tension > 0) {
        batch.SetRestLength(world, c, batch.Cable(world, c).length_m - tension / stiffness);
      }
    }
    batch.SetParameter(world, Parameter::kCableStiffness, c, stiffness);
  }
  batch.SetParameter(world, Parameter::kFrictionScale, 0, 1 + dice.Roll(0.9));
  batch.SetParameter(world, Parameter::kGravityX, 0, dice.Roll(1));
}

/// Sets new commands and forces, as during a run; not all worlds get some every time.
inline void Disturb(WorldBatch& batch, int world, int seed, int when) {
  const ModelDef& def = batch.model().def();
  Dice dice(1000 * seed + when);
  if ((seed + when) % 2 == 0) {
    for (int c = 0; c < static_cast<int>(def.cables.size()); ++c) {
      batch.SetRestLengthTarget(
          world, c, def.cables[static_cast<std::size_t>(c)].rest_length_m * (1 + dice.Roll(0.2)));
    }
  }
  for (int c = 0; c < static_cast<int>(def.cables.size()); ++c) {
    if (!def.cables[static_cast<std::size_t>(c)].actuator.dc_motor) continue;
    if ((seed + when + c) % 3 == 0) batch.SetDuty(world, c, dice.Roll(1));
    batch.SetMotorEnabled(world, c, (seed + when + c) % 5 != 0);
  }
  if ((seed + when) % 3 == 0 && !def.nodes.empty()) {
    const int node = static_cast<int>((seed + 5 * when) % static_cast<int>(def.nodes.size()));
    batch.SetNodeForce(world, node, (seed + when) % 2 == 0 ? Vec3{} : dice.Roll3(1));
  }
}

inline constexpr int kStretches = 8, kStepsAStretch = 40;
inline constexpr double kVarietyStepS = 1e-3;

/// Outcome of a seed: hashes after each stretch, and the last snapshot.
struct Outcome {
  std::vector<std::uint64_t> hashes;
  std::vector<std::uint8_t> snapshot;
};

inline Outcome Alone(const ModelDef& def, int seed, const WorldBatchOptions& options = {}) {
  WorldBatch batch = MakeBatch(def, options);
  Scatter(batch, 0, seed);
  Outcome outcome;
  for (int i = 0; i < kStretches; ++i) {
    Disturb(batch, 0, seed, i);
    batch.Step(kVarietyStepS, kStepsAStretch);
    outcome.hashes.push_back(batch.Hash(0));
  }
  outcome.snapshot = batch.Save(0);
  return outcome;
}

}  // namespace taut::test
