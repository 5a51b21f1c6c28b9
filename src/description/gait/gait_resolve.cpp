// Mapping of a gait to the cables of a robot, and the tunable numbers of a gait.
#include "description/gait/gait_keys.h"
#include "description/yaml/number_list.h"

namespace taut {

std::optional<ResolvedGait> ResolveGait(const GaitSpec& gait, const RobotSpec& robot,
                                        Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  ResolvedGait resolved;
  description::ForEachGaitKind([&](const auto& kind, auto) {
    if (gait.*kind.gait) description::Resolve(*(gait.*kind.gait), robot, resolved, out);
  });
  if (out.items().size() != errors_before) return std::nullopt;
  return resolved;
}

std::vector<GaitValue> GaitValues(GaitSpec& gait) {
  description::NumberList<GaitValue> list("");
  Keys(list, gait);
  return std::move(list.numbers);
}

}  // namespace taut
