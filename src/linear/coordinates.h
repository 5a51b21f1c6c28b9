/// States, inputs and outputs of the linearized system, and their rows in a world.
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

/// Kind of a signal. Only signals of one kind are compared with each other.
enum class SignalKind { kPlace, kTurn, kVelocity, kSpin, kLength, kRate, kForce, kOther };

/// State, input or output of the linear system.
struct Coordinate {
  enum class Of { kRows, kMemory, kTarget, kVelocityInput };
  LinearSignal signal;
  SignalKind kind = SignalKind::kOther;
  Of of = Of::kRows;
  std::vector<std::pair<int, double>> rows;  ///< Affected rows, with the change of each row per
                                             ///< unit.
  int index = 0;                             ///< Index within its kind if it is not stored in a
                                             ///< row.
  int quat_row = -1;                         ///< Row of the quaternion to normalize after a change,
                                             ///< or -1.
  double small = 1e-6;                       ///< Step size of finite differences, in the unit of
                                             ///< the coordinate.
  bool may_go = false;                       ///< Whether to drop the state if nothing depends on
                                             ///< it.
};

/// All coordinates: motions of bodies, and the memory that a world and its controllers keep between
/// ticks.
class Coordinates {
 public:
  Coordinates(const World<Plain>& at, const Tick<Plain>& tick);

  const std::vector<Coordinate>& states() const noexcept { return states_; }
  const std::vector<Coordinate>& inputs() const noexcept { return inputs_; }
  const std::vector<Coordinate>& outputs() const noexcept { return outputs_; }

  /// Returns the states of a world. Poses of bodies are small changes relative to the start.
  template <class Num>
  std::vector<Num> States(const World<Num>& world, const TickMemory<Num>& memory) const;
  /// Returns the outputs of a world. Call after `Sense`.
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

  /// Limits the step size of lengths [m] and rotations [rad] so that no cable becomes slack.
  double Less(double small) const { return std::min(small, std::max(1e-8, 0.1 * stretch_m_)); }

  double stretch_m_ = 1.0;  ///< Smallest stretch of any taut cable [m].
  std::vector<Mover> movers_;
  std::vector<int> nodes_;  ///< Nodes of moving bodies.
  std::size_t first_row_state_ = 0;
  std::vector<Coordinate> states_, inputs_, outputs_;
};

}  // namespace taut::linear
