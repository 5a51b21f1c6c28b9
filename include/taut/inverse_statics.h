/// Which forces hold a robot in a pose: those that cost least, with the rest lengths and motor
/// commands that make them, and between which limits forces lie where several sets of them hold it
/// (docs/theory/inverse_statics.md).
///
/// SI units, W frame; the pose is that in which the model is described (`RobotAt` gives a model in
/// another one). Bodies bear their loads; cables pull; joints, supports and bars carry what they
/// must; what touches pushes, with Coulomb's friction.
///
/// Wrong options are complaints. Threads: all functions are pure; any number may run at once.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/model_def.h"
#include "taut/spec.h"
#include "taut/statics.h"

namespace taut {

/// A place where a body touches what pushes it.
struct TouchDef {
  int body = 0;
  int other = kWorld;     ///< The other body, which is pushed back.
  Vec3 point_m, normal;   ///< The normal points to `body`; unit vector.
  double friction = 0.0;  ///< Coefficient at rest, >= 0.
};

/// Where spheres, rods, boxes and convex bodies that collide are within `within_m` of the terrain's
/// planes, or in them. A rod has two such places, a box up to eight; those of a body's parts that
/// are at the same place are one.
std::vector<TouchDef> FindTouches(const ModelDef& def, double within_m);

/// Of a cable, all that hold.
struct CableBounds {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double at_least_n = 0.0, at_most_n = kNone;              ///< Of its tension, >= 0.
  double at_least_n_per_m = 0.0, at_most_n_per_m = kNone;  ///< Of its force density.
};

/// Of which the sum over the cables is to be least.
enum class HoldingCost {
  kTension,       ///< T^2
  kEnergy,        ///< T^2 / (2 k)
  kForceDensity,  ///< q^2, q = T / l
};

struct HoldingOptions {
  HoldingCost minimise = HoldingCost::kForceDensity;
  std::vector<CableBounds> bounds;  ///< Per cable; empty: that none pushes.
  std::vector<TouchDef> touches;
  /// Per cable, the rest lengths from which motors count; empty: as described.
  std::vector<double> calibration_rest_m;
};

/// What forces cannot balance at a body, in W; the torque about its centre of mass.
struct Unbalanced {
  int body = 0;
  Vec3 force_n, torque_n_m;
};

struct HoldingForces {
  bool found = false;
  std::string why;  ///< If not.
  std::vector<double> cable_tension_n, cable_force_density_n_per_m;
  std::vector<double> rest_length_m;  ///< l - T / k.
  std::vector<double> command_m;      ///< From the calibration on; lengthening is positive.
  std::vector<double> bar_force_n;    ///< Per joint, tension > 0; 0 of those that are no bars.
  std::vector<double> bar_rest_m;     ///< Per joint, l - N / k; 0 likewise.
  std::vector<JointLoad> joint_loads;
  std::vector<Vec3> touch_force_n;  ///< On `body`; of `HoldingOptions::touches`.
  std::vector<int> at_bound;        ///< Cables that would go beyond a bound.
  double cost = 0;                  ///< Of `minimise` [N^2, J, N^2/m^2].
  double residual_n = 0;            ///< What the largest force on a body is off by rounding.
  /// If not found: what the nearest forces leave, in least squares, torques by the body's reach.
  /// The most first; none: rounding alone.
  std::vector<Unbalanced> left;
  std::vector<std::string> notes;  ///< What takes no part, and what no cable can do.
};

/// The forces that hold the robot as described and cost least. Tensions do not follow from rest
/// lengths here, nor bars' forces from theirs: the result says which those have to be. A load
/// case's lengthenings count as warmth does: rest lengths have them, commands do not. It may not
/// have settlements: they are part of the pose.
HoldingForces FindHoldingForces(const ModelDef& def, const LoadCaseSpec& loads,
                                const HoldingOptions& options, Diagnostics& out);

/// Between which a force may be; infinite where nothing limits it, as in a jam.
struct ForceInterval {
  double low_n = 0, high_n = 0;
  /// The ends are true ones or up to this much too far out.
  double uncertain_n = 0;
};

struct IntervalOptions {
  std::vector<TouchDef> touches;
  /// Whether cables and bars have the forces that follow from their rest lengths, as described.
  /// Else they have any that hold, cables within `bounds`.
  bool known_tensions = true;
  std::vector<CableBounds> bounds;  ///< Per cable; empty: that none pushes.
  /// What may be left unbalanced, as a share of the largest load.
  double tolerance = 1e-6;
};

struct ForceIntervals {
  bool found = false;                ///< Whether any forces hold it.
  std::string why;                   ///< If not.
  int undetermined = 0;              ///< Of how many forces it does not say what they are.
  std::vector<ForceInterval> touch;  ///< Normal forces, per touch.
  std::vector<ForceInterval> cable;  ///< Tensions; of known ones both ends are the same.
  std::vector<ForceInterval> joint_x, joint_y,
      joint_z;                   ///< Forces of joints on their body b, in W.
  std::vector<Unbalanced> left;  ///< As in `HoldingForces`.
  std::vector<std::string> notes;
};

/// The limits of the forces that can hold the robot as described, each by itself, by linear
/// programming with planes at the friction cones that are added until the cones are exact.
ForceIntervals FindForceIntervals(const ModelDef& def, const LoadCaseSpec& loads,
                                  const IntervalOptions& options, Diagnostics& out);

}  // namespace taut
