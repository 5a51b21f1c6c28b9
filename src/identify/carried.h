/// Check of measured forces against the applied load. It cuts the robot around some bodies; all
/// members that cross the cut must be measured (docs/theory/identification.md, section 6).
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "identify/computed.h"
#include "taut/identify.h"

namespace taut::identify {

/// Member that crosses the cut. Its force acts along the line from the inner body to the outer
/// body.
struct CutMember {
  /// Channels of its force (tension is positive). One of them must be measured.
  std::vector<std::string> channels;
  int inside = 0, outside = kWorld;  ///< Bodies at the member's ends.
  Vec3 from_m, to_m;                 ///< Its ends on these bodies, in the described pose.
};

struct Cut {
  std::set<int> bodies;
  std::vector<CutMember> members;
  std::vector<std::string> wrong;  ///< Connections that the check does not support, one sentence
                                   ///< each.
};

Cut CutAbout(const ModelDef& def, const std::vector<std::string>& bodies);

/// Measured forces at one equilibrium. Map from channel to force and standard deviation [N].
struct MeasuredForces {
  std::string where;
  double time = 0;  ///< Time of the equilibrium, as in `EachRest`.
  std::map<std::string, std::pair<double, double>> by_channel;
};

/// Reports errors if the cut is invalid or a crossing member was never measured.
void CheckCut(const FitCarried& asked, const FitExperiment& one,
              const std::vector<MeasuredForces>& measured, Diagnostics& out);

CarriedLoad CarriedBy(const FitCarried& asked, const FitExperiment& one,
                      const std::vector<double>& moments_s,
                      const std::vector<MeasuredForces>& measured);

}  // namespace taut::identify
