/// Inverse statics: least cable tensions, rest lengths and motor commands that hold a robot in a
/// pose, and intervals of statically indeterminate forces (docs/theory/inverse_statics.md).
///
/// SI units, W frame; the pose is the described pose of the model (`RobotAt` returns a model in
/// another one). Cables pull; joints, supports and bars transmit any force; contacts push, with
/// Coulomb friction.
///
/// Invalid options are reported as errors. Threads: all functions are pure; any number may run
/// concurrently.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/model_def.h"
#include "taut/spec.h"
#include "taut/statics.h"

namespace taut {

/// Contact point of a body.
struct TouchDef {
  int body = 0;
  int other = kWorld;     ///< The other body, which gets the opposite force.
  Vec3 point_m, normal;   ///< Normal: unit vector toward `body`.
  double friction = 0.0;  ///< Static friction coefficient, >= 0.
};

/// Finds the contact points of colliding spheres, rods, boxes and convex bodies within `within_m`
/// of the terrain's planes, or below them. A rod has up to two points, a box up to eight;
/// coincident points of a body are merged.
std::vector<TouchDef> FindTouches(const ModelDef& def, double within_m);

/// Bounds of a cable's tension and force density; all apply.
struct CableBounds {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double at_least_n = 0.0, at_most_n = kNone;              ///< Tension, >= 0.
  double at_least_n_per_m = 0.0, at_most_n_per_m = kNone;  ///< Force density.
};

/// Objective: term that is summed over the cables and minimized (eq. 3).
enum class HoldingCost {
  kTension,       ///< T^2
  kEnergy,        ///< T^2 / (2 k)
  kForceDensity,  ///< q^2, q = T / l
};

struct HoldingOptions {
  HoldingCost minimise = HoldingCost::kForceDensity;
  std::vector<CableBounds> bounds;  ///< Per cable; empty: tensions >= 0 only.
  std::vector<TouchDef> touches;
  /// Per cable, rest lengths at a motor command of 0; empty: the described ones.
  std::vector<double> calibration_rest_m;
};

/// Residual force and torque on a body, in W; the torque about its center of mass.
struct Unbalanced {
  int body = 0;
  Vec3 force_n, torque_n_m;
};

struct HoldingForces {
  bool found = false;
  std::string why;  ///< Reason, if not found.
  std::vector<double> cable_tension_n, cable_force_density_n_per_m;
  std::vector<double> rest_length_m;  ///< l - T / k.
  std::vector<double> command_m;      ///< Relative to the calibration; lengthening is positive.
  std::vector<double> bar_force_n;    ///< Per joint, tension > 0; 0 for joints other than bars.
  std::vector<double> bar_rest_m;     ///< Per joint, l - N / k; 0 for joints other than bars.
  std::vector<JointLoad> joint_loads;
  std::vector<Vec3> touch_force_n;  ///< On `body`; per entry of `HoldingOptions::touches`.
  std::vector<int> at_bound;        ///< Cables whose tension is at a bound.
  double cost = 0;                  ///< Value of `minimise` [N^2, J, N^2/m^2].
  double residual_n = 0;            ///< Largest imbalance on a body, due to rounding.
  /// If not found: residuals of the least-squares solution (torques divided by the body's reach),
  /// largest first; empty if only rounding errors remain.
  std::vector<Unbalanced> left;
  std::vector<std::string> notes;  ///< Ignored parts of the model, and infeasible rest lengths.
};

/// Computes the forces of least cost that hold the robot in the described pose. Rest lengths of
/// cables and bars are results, not inputs. Lengthenings of the load case are treated as thermal:
/// part of the rest lengths, not of the commands. The load case must not have settlements, which
/// are part of the pose.
HoldingForces FindHoldingForces(const ModelDef& def, const LoadCaseSpec& loads,
                                const HoldingOptions& options, Diagnostics& out);

/// Interval of a force; infinite without a limit, as in a jam.
struct ForceInterval {
  double low_n = 0, high_n = 0;
  /// The interval is never too short; its ends may be too far out by up to this.
  double uncertain_n = 0;
};

struct IntervalOptions {
  std::vector<TouchDef> touches;
  /// Whether forces of cables and bars follow from their described rest lengths; otherwise they are
  /// unknown, cables within `bounds`.
  bool known_tensions = true;
  std::vector<CableBounds> bounds;  ///< Per cable; empty: tensions >= 0 only.
  /// Allowed imbalance, relative to the largest load.
  double tolerance = 1e-6;
};

struct ForceIntervals {
  bool found = false;                ///< Whether any admissible forces hold the pose.
  std::string why;                   ///< Reason, if not found.
  int undetermined = 0;              ///< Degree of static indeterminacy (dimension of y in eq. 2).
  std::vector<ForceInterval> touch;  ///< Normal forces, per contact point.
  std::vector<ForceInterval> cable;  ///< Tensions; both ends are equal for known ones.
  /// Forces of joints on their body b, in W.
  std::vector<ForceInterval> joint_x, joint_y, joint_z;
  std::vector<Unbalanced> left;  ///< As in `HoldingForces`.
  std::vector<std::string> notes;
};

/// Computes the interval of each force over all admissible forces that hold the robot in the
/// described pose, each force separately: the ends may not be attained together. Method: linear
/// programming with tangent planes of the friction cones, added until the cones are accurate
/// (Kelley's cutting-plane method).
ForceIntervals FindForceIntervals(const ModelDef& def, const LoadCaseSpec& loads,
                                  const IntervalOptions& options, Diagnostics& out);

}  // namespace taut
