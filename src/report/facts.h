/// Quantities that all forms of the run summary contain.
#pragma once

#include <cstddef>
#include <string>

#include "taut/run.h"

namespace taut::report {

/// Returns whether the run reached the phase's end.
inline bool Complete(const RunSummary& summary, const PhaseSpec& phase) {
  return phase.to_s <= summary.simulated_s * (1.0 + 1e-9);
}

/// Returns the ratio of simulated to wall-clock time; 0 if no time has passed.
inline double RealTimeFactor(const RunSummary& summary) {
  return summary.wall_s > 0.0 ? summary.simulated_s / summary.wall_s : 0.0;
}

/// Returns "ok" or the description of the problem.
inline std::string StatusText(const RunSummary& summary) {
  if (summary.status.bits == kStatusOk) return "ok";
  return summary.status_text.empty() ? "status bits " + std::to_string(summary.status.bits)
                                     : summary.status_text;
}

/// Returns a description of contacts that the trace lacks; empty if there are none.
inline std::string LeftOutText(const RunSummary& summary) {
  const LeftOutContacts& left = summary.left_out;
  if (left.contacts == 0) return {};
  return std::to_string(left.contacts) + " contacts in " + std::to_string(left.rows) +
         " rows were not recorded; set record.contacts: " + std::to_string(left.most_touching) +
         " to record all";
}

}  // namespace taut::report
