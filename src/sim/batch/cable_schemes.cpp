// Integration scheme of each cable of a model for a given step.
#include "taut/cable_scheme.h"

#include <algorithm>

#include "sim/data/cable_groups.h"
#include "sim/data/tables.h"

namespace taut {

std::vector<CableScheme> CableSchemes(const Model& model, double step_s) {
  const auto& tables = static_cast<const sim::Tables&>(model);
  const ModelDef& def = tables.def();
  const sim::View view = tables.View();
  const auto bodies = static_cast<std::size_t>(view.body_count);
  std::vector<int> group(bodies), size(bodies);
  std::vector<std::uint8_t> kind(bodies);
  double k_max = 0;
  for (const CableDef& cable : def.cables) k_max = std::max(k_max, cable.stiffness_n_per_m);
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  const auto moves = [&](int body) { return !def.bodies[at(body)].fixed; };
  const auto stiffness = [&](int c) {
    return std::min(tables.coupling[at(c)] * def.cables[at(c)].stiffness_n_per_m,
                    tables.largest_coupling * k_max);
  };
  const auto damps = [&](int c) { return def.cables[at(c)].damping_n_s_per_m > 0; };
  const sim::CableGroups groups{group.data(), size.data(), kind.data()};
  sim::FindGroups(view, step_s, moves, stiffness, damps, groups);
  std::vector<CableScheme> schemes;
  for (int c = 0; c < view.cable_count; ++c) {
    const bool stiff = stiffness(c) > sim::kSoftSpring / (step_s * step_s);
    CableScheme scheme = stiff ? CableScheme::kAlong : CableScheme::kExplicit;
    sim::ForEachMoved(view, view.cables[c], moves, [&](int body) {
      if (!groups.IsImplicit(body)) return;
      scheme = groups.HasSecondStage(body) ? CableScheme::kImplicitDamped : CableScheme::kImplicit;
    });
    schemes.push_back(scheme);
  }
  return schemes;
}

}  // namespace taut
