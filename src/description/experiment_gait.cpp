#include <algorithm>

#include "description/experiment_parts.h"

namespace taut::description {

void CheckGaitDrives(const ControllerSpec& controller, const RobotSpec& robot, const SourceRef& at,
                     Diagnostics& out) {
  const GaitSpec& gait = controller.velocity_input->gait;
  const auto resolved = ResolveGait(gait, robot, out);
  if (!resolved) return;
  std::string idle;
  for (const int cable : resolved->cables) {
    const auto& driven = controller.impedance->cables;
    const bool is_driven =
        std::any_of(driven.begin(), driven.end(),
                    [&](const ImpedanceGains& gains) { return gains.cable == cable; });
    if (is_driven) continue;
    idle += (idle.empty() ? "" : ", ") + robot.def.cables[static_cast<std::size_t>(cable)].name;
  }
  if (idle.empty()) return;
  out.Error(at,
            "gait " + gait.name + " moves " + idle + ", which controller " + controller.name +
                " does not drive",
            "give them `gains` and `set_points`");
}

}  // namespace taut::description
