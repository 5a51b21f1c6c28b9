/// The states, inputs and outputs of the linear system, and where in a world they are.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "linear/tick.h"
#include "linear/world.h"
#include "math/vec.h"
#include "simd/vec3.h"
#include "taut/state_space.h"

namespace taut::linear {

/// Signals of one kind are judged together.
enum class SignalKind { kPlace, kTurn, kVelocity, kSpin, kLength, kRate, kForce, kOther };

/// A number that may be changed a little.
struct Coordinate {
  enum class Of { kRows, kMemory, kTarget, kVelocityInput };
  LinearSignal signal;
  SignalKind kind = SignalKind::kOther;
  Of of = Of::kRows;
  std::vector<std::pair<int, double>> rows;  ///< What of each changes per unit.
  int index = 0;                             ///< If it is in no row: which of its kind.
  int quat_row = -1;                         ///< To be a unit quaternion again.
  double small = 1e-6;                       ///< A change for differences [its unit].
  bool may_go = false;                       ///< Left out where nothing depends on it.
};

/// The motions of bodies, and what else a world and its controllers keep from tick to tick.
class Coordinates {
 public:
  Coordinates(const World<Plain>& at, const Tick<Plain>& tick);

  const std::vector<Coordinate>& states() const noexcept { return states_; }
  const std::vector<Coordinate>& inputs() const noexcept { return inputs_; }
  const std::vector<Coordinate>& outputs() const noexcept { return outputs_; }

  /// The states of a world, in their order: motions of bodies as small changes from the start.
  template <class Num>
  std::vector<Num> States(const World<Num>& world, const TickMemory<Num>& memory) const;
  /// What is seen of it; it has been sensed.
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

  /// Changes of lengths [m], turns [rad] by which no cable gets slack.
  double Less(double small) const { return std::min(small, std::max(1e-8, 0.1 * stretch_m_)); }

  double stretch_m_ = 1.0;  ///< The least of any cable that is taut.
  std::vector<Mover> movers_;
  std::vector<int> nodes_;  ///< That move.
  std::size_t first_row_state_ = 0;
  std::vector<Coordinate> states_, inputs_, outputs_;
};

}  // namespace taut::linear
