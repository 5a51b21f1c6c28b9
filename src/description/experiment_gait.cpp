#include <algorithm>
#include <filesystem>

#include "description/experiment_parts.h"

namespace taut::description {

std::optional<VelocityInputSpec> ReadVelocityInput(const Value& value, const Scope& scope) {
  const MapReader map(value, "velocity_input", {"gait", "period_s", "phase_s"}, scope);
  VelocityInputSpec input;
  input.clock.period_s = map.NumberOr("period_s", input.clock.period_s, Bound::kPositive);
  input.clock.phase_s = map.NumberOr("phase_s", 0.0, Bound::kNonNegative);
  const Value* file = map.Require("gait");
  if (!file) return std::nullopt;
  const std::string text = ReadText(*file, map.Path("gait"), scope);
  if (file->kind != Value::Kind::kScalar) return std::nullopt;
  const std::string path = PathBeside(file->at.file, text);
  std::error_code ignored;
  if (text.empty() || !std::filesystem::is_regular_file(path, ignored)) {
    scope.out.Error(file->at, "velocity_input.gait: there is no file \"" + path + "\"",
                    "as seen from the folder of the file that names it");
    return std::nullopt;
  }
  auto gait = LoadGait(path, scope.out);
  if (!gait) return std::nullopt;
  input.gait = std::move(*gait);
  return input;
}

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
