#include "taut/play.h"

#include <cmath>

#include "plant/player_kinds.h"

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
  if (deaf.feedback_cpg) {
    deaf.feedback_cpg->cable_network.reset();
    deaf.feedback_cpg->goal_network.reset();
  }
  const double period_s = 1.0 / rate_hz;
  const auto player = plant::PlayerOf({{&deaf}, std::move(*resolved), period_s});
  const auto rows = static_cast<std::int64_t>(std::floor(duration_s * rate_hz + 1e-9)) + 1;
  for (std::int64_t row = 0; row < rows; ++row) {
    const double time_s = static_cast<double>(row) * period_s;
    player->Tick({AllLanes(1), &row, &time_s, &time_s}, {});
    table.time_s.push_back(time_s);
    table.rows.push_back(player->signal());
  }
  return table;
}

}  // namespace taut
