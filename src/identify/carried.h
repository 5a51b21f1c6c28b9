/// Check of measured forces against the applied load: a cut around bodies whose crossing members
/// are measured (docs/theory/identification.md, section 6).
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "identify/computed.h"
#include "taut/identify.h"

namespace taut::identify {

/// Member that crosses the cut, with its force along a line from a body inside to one outside.
struct CutMember {
  /// Channels of its force, tension > 0; any one of them suffices.
  std::vector<std::string> channels;
  int inside = 0, outside = kWorld;  ///< Bodies at its ends.
  Vec3 from_m, to_m;                 ///< Its ends there, in the described pose.
};

struct Cut {
  std::set<int> bodies;
  std::vector<CutMember> members;
  std::vector<std::string> wrong;  ///< Other connections of the bodies, one sentence each.
};

Cut CutAbout(const ModelDef& def, const std::vector<std::string>& bodies);

/// Forces of an experiment that are compared at one rest, by channel: force and standard deviation
/// [N].
struct MeasuredForces {
  std::string where;
  double time = 0;  ///< Time of the rest, as in `EachRest`.
  std::map<std::string, std::pair<double, double>> by_channel;
};

/// Reports errors if the cut is invalid or a crossing member was never measured.
void CheckCut(const FitCarried& asked, const FitExperiment& one,
              const std::vector<MeasuredForces>& measured, Diagnostics& out);

CarriedLoad CarriedBy(const FitCarried& asked, const FitExperiment& one,
                      const std::vector<double>& moments_s,
                      const std::vector<MeasuredForces>& measured);

}  // namespace taut::identify
