/// Inverse statics: minimal cable tensions, rest lengths and motor commands that hold a robot in a
/// pose, and intervals of statically indeterminate forces (docs/theory/inverse_statics.md).
///
/// SI units, world frame W. The pose is the described pose of the model; `RobotAt` returns a model
/// in another pose. Cables pull; joints, supports and bars transmit any force; contacts push, with
/// Coulomb friction.
///
/// Errors describe invalid options. Threads: all functions are pure and thread safe.
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
  int other = kWorld;     ///< Other body; the opposite force acts on it.
  Vec3 point_m, normal;   ///< Contact point; unit normal, toward `body`.
  double friction = 0.0;  ///< Static friction coefficient, >= 0.
};

/// Finds the contact points of colliding spheres, rods, boxes and convex bodies at or below planes
/// of the terrain, up to `within_m` above them. A rod has up to two points, a box up to eight.
/// Coincident points of a body are merged.
std::vector<TouchDef> FindTouches(const ModelDef& def, double within_m);

/// Bounds of tension and force density of a cable. All bounds apply together.
struct CableBounds {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double at_least_n = 0.0, at_most_n = kNone;              ///< Bounds of the tension, >= 0.
  double at_least_n_per_m = 0.0, at_most_n_per_m = kNone;  ///< Bounds of the force density.
};

/// Quantity to minimize, summed over the cables (eq. 3).
enum class HoldingCost {
  kTension,       ///< Squared tension T^2.
  kEnergy,        ///< Elastic energy T^2 / (2 k).
  kForceDensity,  ///< Squared force density q^2, q = T / l.
};

struct HoldingOptions {
  HoldingCost minimise = HoldingCost::kForceDensity;
  std::vector<CableBounds> bounds;  ///< One per cable; empty: all tensions >= 0.
  std::vector<TouchDef> touches;
  /// One per cable: rest length at motor command 0. Empty: the described rest lengths.
  std::vector<double> calibration_rest_m;
};

/// Residual force and torque on a body, in W. The torque is about the center of mass.
struct Unbalanced {
  int body = 0;
  Vec3 force_n, torque_n_m;
};

struct HoldingForces {
  bool found = false;
  std::string why;  ///< Reason, if not found.
  std::vector<double> cable_tension_n, cable_force_density_n_per_m;
  std::vector<double> rest_length_m;  ///< Per cable: l - T / k, with the length l in the pose.
  /// Motor command: rest length minus `calibration_rest_m`; lengthening is positive.
  std::vector<double> command_m;
  std::vector<double> bar_force_n;  ///< One per joint; tension > 0; 0 for joints that are not bars.
  /// Rest length l - N / k, one per joint; 0 for joints that are not bars.
  std::vector<double> bar_rest_m;
  std::vector<JointLoad> joint_loads;
  /// Force on `body`, one per entry of `HoldingOptions::touches`.
  std::vector<Vec3> touch_force_n;
  std::vector<int> at_bound;  ///< Cables with a tension at a bound.
  double cost = 0;            ///< Value of the minimized sum [N^2, J, N^2/m^2].
  double residual_n = 0;      ///< Largest residual on a body, from rounding.
  /// If not found: residuals of the least-squares solution, largest first. For the order, torques
  /// are divided by the largest lever arm on the body. Empty if only rounding errors remain.
  std::vector<Unbalanced> left;
  /// Descriptions of ignored parts of the model and of infeasible rest lengths.
  std::vector<std::string> notes;
};

/// Computes the forces of least cost that hold the robot in the described pose. Rest lengths of
/// cables and bars are results, not inputs. Lengthenings in the load case act like thermal
/// expansion: they change the rest lengths but not the commands. The load case must not contain
/// settlements, since the pose already includes them.
HoldingForces FindHoldingForces(const ModelDef& def, const LoadCaseSpec& loads,
                                const HoldingOptions& options, Diagnostics& out);

/// Interval of a force. An end is infinite if the force is unbounded, for example when bodies jam.
struct ForceInterval {
  double low_n = 0, high_n = 0;
  /// Each end may lie outside the exact interval by up to this force; never inside it.
  double uncertain_n = 0;
};

struct IntervalOptions {
  std::vector<TouchDef> touches;
  /// Whether the described rest lengths determine the forces of cables and bars. False: these
  /// forces are unknown, and `bounds` limits the cables.
  bool known_tensions = true;
  std::vector<CableBounds> bounds;  ///< One per cable; empty: all tensions >= 0.
  /// Allowed residual, relative to the largest load.
  double tolerance = 1e-6;
};

struct ForceIntervals {
  bool found = false;                ///< Whether some admissible forces hold the pose.
  std::string why;                   ///< Reason, if not found.
  int undetermined = 0;              ///< Degree of static indeterminacy (dimension of y in eq. 2).
  std::vector<ForceInterval> touch;  ///< Normal forces, one per contact point.
  std::vector<ForceInterval> cable;  ///< Tensions; both ends are equal for known tensions.
  /// Forces of the joints on their body b, in W.
  std::vector<ForceInterval> joint_x, joint_y, joint_z;
  std::vector<Unbalanced> left;  ///< Residuals, as in `HoldingForces::left`.
  std::vector<std::string> notes;
};

/// Computes the interval of each force over all admissible forces that hold the robot in the
/// described pose. Each force is treated separately, so the ends of different intervals need not
/// occur together. Method: linear programs; tangent planes of the friction cones are added until
/// the cones are accurate (Kelley's cutting-plane method).
ForceIntervals FindForceIntervals(const ModelDef& def, const LoadCaseSpec& loads,
                                  const IntervalOptions& options, Diagnostics& out);

}  // namespace taut
