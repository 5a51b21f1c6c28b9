/// Whether measured forces carry the load that is applied: a cut about bodies, whose members are
/// measured. docs/theory/identification.md, section 6.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "identify/computed.h"
#include "taut/identify.h"

namespace taut::identify {

/// A force along a line that pulls a body inside towards what is outside.
struct CutMember {
  std::vector<std::string> channels;  ///< Any of which has its force, tension > 0.
  int inside = 0, outside = kWorld;   ///< Bodies,
  Vec3 from_m, to_m;                  ///< and its ends there, as described.
};

struct Cut {
  std::set<int> bodies;
  std::vector<CutMember> members;
  std::vector<std::string> wrong;  ///< What else holds the bodies, one sentence each.
};

Cut CutAbout(const ModelDef& def, const std::vector<std::string>& bodies);

/// What was compared of an experiment at one rest: force [N] and its sd by channel.
struct MeasuredForces {
  std::string where;
  double time = 0;  ///< Of the rest, as of `EachRest`.
  std::map<std::string, std::pair<double, double>> by_channel;
};

/// Complaints if the cut is none, or members of it were never measured.
void CheckCut(const FitCarried& asked, const FitExperiment& one,
              const std::vector<MeasuredForces>& measured, Diagnostics& out);

CarriedLoad CarriedBy(const FitCarried& asked, const FitExperiment& one,
                      const std::vector<double>& moments_s,
                      const std::vector<MeasuredForces>& measured);

}  // namespace taut::identify
