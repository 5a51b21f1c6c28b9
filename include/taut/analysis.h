/// What holds a structure up: its static equilibrium, its stiffness there, its modes, and what its
/// members can carry by themselves (docs/theory/statics.md).
///
/// SI units, W frame. Motions are those of the bodies that move, six each, in their order: three
/// translations of the centre of mass [m], then three small turns about W's axes [rad]. Neither
/// masses nor a step matter to statics: masses are there as weights only.
///
/// Inputs that have no answer are answered with `why`, never asserted; models must be such that
/// `Model::Compile` takes them. Threads: all functions are pure; any number may run at once.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "taut/batch.h"
#include "taut/model_def.h"
#include "taut/spec.h"
#include "taut/start.h"
#include "taut/statics.h"

namespace taut {

/// A matrix, row after row.
struct Matrix {
  int rows = 0, columns = 0;
  std::vector<double> values;
  Matrix() = default;
  Matrix(int row_count, int column_count)
      : rows(row_count),
        columns(column_count),
        values(static_cast<std::size_t>(row_count) * static_cast<std::size_t>(column_count)) {}
  double& operator()(int row, int column) { return values[Index(row, column)]; }
  double operator()(int row, int column) const { return values[Index(row, column)]; }

 private:
  std::size_t Index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

struct EquilibriumOptions {
  /// What a body may have left, as a share of the largest force on any (of 1 N, if that is less).
  double tolerance = 1e-9;
  int most_iterations = 500;  ///< Linear systems, all together.
  bool contact = true;        ///< Whether the terrain's planes bear what stands on them.
  /// Where to begin, and the cables' rest lengths there; nothing: as described.
  std::optional<Pose> from;
};

/// How an equilibrium was found.
enum class EquilibriumWay { kNewton, kLoadSteps, kRelaxation };

struct Equilibrium {
  bool found = false;
  std::string why;                      ///< If not.
  std::vector<std::string> left_out;    ///< What of the model takes no part, in words.
  Pose pose;                            ///< The last that was looked at, if it was not found.
  std::vector<double> cable_tension_n;  ///< Per cable; where friction parts it, of its first span.
  std::vector<double> bar_force_n;      ///< Per joint; tension > 0; 0 of joints that are no bars.
  std::vector<JointLoad> joint_loads;   ///< Per joint; of supports, what holds the robot there.
  std::vector<ContactState> contacts;   ///< That bear something; normal forces alone.
  double residual_n = 0;                ///< The largest force that is left on a body; torques by
                                        ///< the body's reach.
  int iterations = 0;
  EquilibriumWay way = EquilibriumWay::kNewton;
};

/// The pose near the one that is described in which all forces balance: cables, bars, springs of
/// joints, weight, loads, and planes that push and have no friction. Of several it is a stable one,
/// but for a start that is in equilibrium already. By Newton's method on the potential energy with
/// a trust region, loads in steps where that fails, and dynamic relaxation at last.
Equilibrium FindEquilibrium(const ModelDef& def, const LoadCaseSpec& loads = {},
                            const EquilibriumOptions& options = {});

/// `def` as it is described in a pose, at rest; `RobotAt` for the numbers alone.
ModelDef ModelAt(const ModelDef& def, const Pose& pose);

/// Stiffness and mass as described, in the motions of the bodies that move (docs/theory/statics.md,
/// section 3). What is held is not eliminated.
struct Tangent {
  std::vector<int> bodies;  ///< Six motions each.
  /// The negative derivative of the forces [N/m, N, N m/rad], symmetric: of cables that are taut,
  /// bars, springs of joints, weight, loads, and of what holds (`held`) under its forces.
  Matrix stiffness;
  Matrix geometric;  ///< The part of it that forces make: zero where nothing is under tension.
  Matrix mass;       ///< [kg, kg m, kg m^2]
  /// A row a direction that joints and bearing planes hold: held * motions = 0. Orthonormal.
  Matrix held;
  /// A column a motion that something can resist: orthonormal. Left out are turns of bodies that
  /// all hangs on the centre of mass of, and of rods about their axis.
  Matrix effective;
  int free_turns = 0;                 ///< How many motions `effective` leaves out.
  std::vector<int> slack_cables;      ///< Which contribute nothing.
  std::vector<std::string> left_out;  ///< What of the model takes no part, in words.
};

/// As described, under these loads. Where they do not balance it is the second derivative of the
/// energy with turns as exp(theta), which the forces' is but for half of what is left.
Tangent FindTangent(const ModelDef& def, const LoadCaseSpec& loads = {});

/// One way to vibrate, or to move without force.
struct Mode {
  enum class Kind {
    kRigid,      ///< As a whole: nothing resists it.
    kMechanism,  ///< Members let it be, and forces do not stiffen it.
    kElastic,
    kUnstable,  ///< It runs away.
  };
  Kind kind = Kind::kElastic;
  double frequency_hz = 0;  ///< Of elastic ones; of unstable ones how fast they grow, less than
                            ///< zero [1/s] / 2 pi; else 0.
  double eigenvalue_per_s2 = 0;  ///< (2 pi frequency)^2.
  /// Per body of the model, 0 of those that stand still. Scaled so that the largest translation of
  /// any is 1 m; a turn by its reach counts as one.
  std::vector<Vec3> translation_m, turn_rad;
};

struct Modes {
  std::string why;          ///< If there are none: what is wrong.
  std::vector<Mode> modes;  ///< Rigid ones first, then by their eigenvalue, ascending.
  int rigid = 0, mechanisms = 0, unstable = 0;
  /// The largest eigenvalue that counts as zero and the least that does not, of those that are not
  /// rigid [1/s^2]; 0 if there are none.
  double largest_dropped = 0, smallest_kept = 0;
};

/// Small undamped vibrations about what is described, which should be an equilibrium (`ModelAt`
/// what `FindEquilibrium` gives): K v = omega^2 M v in what joints and bearing planes leave free.
Modes FindModes(const ModelDef& def, const LoadCaseSpec& loads = {});

}  // namespace taut
