#include "taut/play.h"

#include <cmath>

#include "plant/gait_player.h"

namespace taut {

std::optional<TableGait> PlayGait(const GaitSpec& gait, const RobotSpec& robot, double rate_hz,
                                  double duration_s, Diagnostics& out) {
  auto resolved = ResolveGait(gait, robot, out);
  if (!resolved) return std::nullopt;
  TableGait table;
  for (const int cable : resolved->cables) {
    table.cables.push_back(robot.def.cables[static_cast<std::size_t>(cable)].name);
  }
  GaitSpec deaf = gait;
  if (deaf.cpg) deaf.cpg->feedback.reset();
  const ClockSpec clock{1.0 / rate_hz, 0.0};
  plant::GaitPlayer player(deaf, std::move(*resolved), clock);
  const auto rows = static_cast<std::int64_t>(std::floor(duration_s * rate_hz + 1e-9)) + 1;
  for (std::int64_t row = 0; row < rows; ++row) {
    const double time_s = player.next_tick_s();
    player.Act(time_s, [](int) { return 0.0; });
    table.time_s.push_back(time_s);
    table.rows.push_back(player.velocity_m_per_s());
  }
  return table;
}

}  // namespace taut
