/// Results of `taut analyze` and their output as tables and JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/analysis.h"
#include "taut/inverse_statics.h"
#include "taut/safety.h"
#include "taut/spec.h"

namespace taut::cli {

/// Equilibrium and member forces under a load case.
struct CaseResult {
  LoadCaseSpec loads;
  Equilibrium at;
  ModelDef def;  ///< Model in the equilibrium pose.
  std::vector<MemberLoad> members;
  std::vector<Reaction> anchors;
  /// Force of the world on the cables that end at one point of the world.
  struct End {
    std::string name;  ///< Name of the node at this point.
    Vec3 point_m, force_n;
  };
  std::vector<End> ends;
  /// Forces that friction and redundant supports leave undetermined, with their intervals.
  struct Open {
    std::vector<TouchDef> touches;
    ForceIntervals forces;
  };
  std::optional<Open> open;
  std::optional<Modes> modes;
  std::optional<double> least_stiffness_n_per_m;
  Move move;  ///< Largest displacement from the described pose.

  /// Returns the member with the least safety factor (buckling, yield, strength), and the first
  /// cable that gets slack as the load grows; null without such a member.
  const MemberLoad* LeastSafe() const;
  const MemberLoad* FirstSlack() const;
};

/// Moves the ends of the supports in the world by the settlements of a load case, as in its
/// equilibrium.
void MoveSupports(ModelDef& def, const LoadCaseSpec& loads);

/// Solves each load case independently of the others.
std::vector<CaseResult> SolveCases(const ModelDef& def, const std::vector<LoadCaseSpec>& cases,
                                   bool with_modes);

struct AnalysisResult {
  std::string file;
  RobotSpec robot;
  std::vector<std::string> notes;  ///< Complete sentences for the reader.
  ForceAnalysis forces;            ///< Self-stress and mechanisms in the described pose.
  std::vector<CaseResult> cases;
  bool Found() const;  ///< Returns whether every case has an equilibrium.
};

/// Returns whether a node moves farther than the load case allows.
bool ExceedsDisplacement(const CaseResult& result);

/// Formats the load cases as a table: largest displacement, least safety factor, first slack cable,
/// sum of the vertical reactions.
std::string CaseTable(const AnalysisResult& result);
/// Returns the cells of this table; the first row is the header.
std::vector<std::vector<std::string>> CaseRows(const AnalysisResult& result);

/// Formats the verdict on the structure and a summary of at most ten lines.
std::string AnalysisSummary(const AnalysisResult& result);
/// Returns the lines of the verdict and of the summary, without the table of load cases.
std::vector<std::string> AnalysisLines(const AnalysisResult& result);

/// Returns a safety factor as text.
std::string SafetyFactorText(double factor);
/// Returns the same, or "-" without a factor.
std::string FactorCell(const std::optional<double>& factor);

/// Returns whether the structure has cables, but no state of self-stress with tension in all of
/// them.
bool LacksPrestress(const ForceAnalysis& forces);

/// Returns whether form finding may find a shape that has a self-stress with tension in all cables.
bool FormFindingMayHelp(const ForceAnalysis& forces);

/// Formats the states of self-stress and the mechanisms.
std::string ForceTables(const ModelDef& def, const ForceAnalysis& forces);

/// Formats all results; `most_modes`: maximum number of modes listed per load case.
std::string AnalysisTables(const AnalysisResult& result, int most_modes);
/// Returns all results as JSON, in full precision.
std::string AnalysisJson(const AnalysisResult& result, int most_modes);

/// Force of a support, an anchored body, a cable's end in the world, or the ground on the robot.
struct ReactionForce {
  const char* kind;  ///< "support", "anchor", "node" or "ground".
  std::string name;  ///< Name of the joint, body or node.
  Vec3 point_m, force_n, torque_n_m;
};
std::vector<ReactionForce> ReactionsOf(const CaseResult& result);

}  // namespace taut::cli
