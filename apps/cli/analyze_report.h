/// What `taut analyze` has found, and how it prints it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/analysis.h"
#include "taut/inverse_statics.h"
#include "taut/safety.h"
#include "taut/spec.h"

namespace taut::cli {

/// A load case: where the robot stands under it, what its members carry there.
struct CaseResult {
  LoadCaseSpec loads;
  Equilibrium at;
  ModelDef def;  ///< As it stands.
  std::vector<MemberLoad> members;
  std::vector<Reaction> anchors;
  /// What holds cables that end in the world, a place each.
  struct End {
    std::string name;  ///< Of the node there.
    Vec3 point_m, force_n;
  };
  std::vector<End> ends;
  /// Forces that friction and redundant supports leave open there.
  struct Open {
    std::vector<TouchDef> touches;
    ForceIntervals forces;
  };
  std::optional<Open> open;
  std::optional<Modes> modes;
  std::optional<double> least_stiffness_n_per_m;
  Move move;  ///< From the described pose.

  /// Returns the member with the least safety factor (buckling, yield, strength), and the first
  /// cable that gets slack as the load grows; null without such a member.
  const MemberLoad* LeastSafe() const;
  const MemberLoad* FirstSlack() const;
};

/// Each of the cases by itself.
std::vector<CaseResult> SolveCases(const ModelDef& def, const std::vector<LoadCaseSpec>& cases,
                                   bool with_modes);

struct AnalysisResult {
  std::string file;
  RobotSpec robot;
  std::vector<std::string> notes;  ///< Of what a reader should know, in sentences.
  ForceAnalysis forces;            ///< As described.
  std::vector<CaseResult> cases;
  bool Found() const;  ///< Whether every case has an equilibrium.
};

/// What members can carry by themselves.
std::string ForceTables(const ModelDef& def, const ForceAnalysis& forces);

/// `most_modes`: of each case at most so many rows.
std::string AnalysisTables(const AnalysisResult& result, int most_modes);
/// All of it, in full precision.
std::string AnalysisJson(const AnalysisResult& result, int most_modes);

/// Joints that hold the robot in the world: of them the loads are reactions.
bool IsSupport(const ModelDef& def, const JointDef& joint);

}  // namespace taut::cli
