/// States, inputs and outputs of the linearized system, and their places in a world.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "linear/linear_tick.h"
#include "linear/linear_world.h"
#include "math/vec.h"
#include "simd/vec3.h"
#include "taut/state_space.h"

namespace taut::linear {

/// Signals of one kind are compared with each other.
enum class SignalKind { kPlace, kTurn, kVelocity, kSpin, kLength, kRate, kForce, kOther };

/// State, input or output; states and inputs can be changed by small amounts.
struct Coordinate {
  enum class Of { kRows, kMemory, kTarget, kVelocityInput };
  LinearSignal signal;
  SignalKind kind = SignalKind::kOther;
  Of of = Of::kRows;
  std::vector<std::pair<int, double>> rows;  ///< Affected rows, with the change of each per unit.
  int index = 0;                             ///< Index within its kind if it is not in a row.
  int quat_row = -1;                         ///< Quaternion to normalize after a change, or -1.
  double small = 1e-6;                       ///< Size of a change for differences [its unit].
  bool may_go = false;                       ///< Left out if nothing depends on it.
};

/// All coordinates: motions of bodies, and the memory of a world and its controllers from tick to
/// tick.
class Coordinates {
 public:
  Coordinates(const World<Plain>& at, const Tick<Plain>& tick);

  const std::vector<Coordinate>& states() const noexcept { return states_; }
  const std::vector<Coordinate>& inputs() const noexcept { return inputs_; }
  const std::vector<Coordinate>& outputs() const noexcept { return outputs_; }

  /// Returns the states of a world, in order; motions of bodies as small changes from the start.
  template <class Num>
  std::vector<Num> States(const World<Num>& world, const TickMemory<Num>& memory) const;
  /// Returns the outputs of a world after `Sense`.
  template <class Num>
  std::vector<Num> Outputs(const World<Num>& world) const;

 private:
  struct Mover {
    int body;
    Vec3 position_m;
    Quat orientation;
  };
  void AddBodies(const World<Plain>& at);
  void AddRows(const World<Plain>& at);
  void AddMemory(const World<Plain>& at, const Tick<Plain>& tick);
  void AddInputs(const World<Plain>& at, const Tick<Plain>& tick);
  void AddOutputs(const World<Plain>& at);
  Coordinate& State(std::string name, std::string unit, SignalKind kind, double small);

  /// Limits changes of lengths [m] and rotations [rad] so that no cable becomes slack.
  double Less(double small) const { return std::min(small, std::max(1e-8, 0.1 * stretch_m_)); }

  double stretch_m_ = 1.0;  ///< Least stretch of any taut cable.
  std::vector<Mover> movers_;
  std::vector<int> nodes_;  ///< Nodes of moving bodies.
  std::size_t first_row_state_ = 0;
  std::vector<Coordinate> states_, inputs_, outputs_;
};

}  // namespace taut::linear
