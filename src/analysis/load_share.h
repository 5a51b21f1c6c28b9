/// Shares of load cases.
#pragma once

#include "math/vec.h"
#include "taut/load_case.h"

namespace taut::analysis {

/// Returns a load case with forces, settlements and changes of length multiplied by `share`. Weight
/// remains.
inline LoadCaseSpec ShareOf(const LoadCaseSpec& loads, double share) {
  LoadCaseSpec part = loads;
  for (auto& force : part.forces) force.force_n = share * force.force_n;
  for (auto& settled : part.settlements) settled.by_m = share * settled.by_m;
  for (auto& longer : part.cables) longer.by_m *= share;
  for (auto& longer : part.bars) longer.by_m *= share;
  return part;
}

}  // namespace taut::analysis
