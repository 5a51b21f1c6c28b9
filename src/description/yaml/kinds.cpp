#include "description/yaml/kinds.h"

namespace taut::description {

std::string HintOfKind(std::string_view kind) {
  constexpr struct {
    std::string_view kind, reader;
  } kKinds[] = {{"model", "taut check"},       {"experiment", "taut run"},
                {"gait", "taut gait"},         {"study", "taut learn"},
                {"fit", "taut fit"},           {"catalogue", "taut size"},
                {"calibration", "taut robot"}, {"faults", "taut robot"}};
  std::string all;
  for (const auto& known : kKinds) {
    if (known.kind == kind) {
      return "use `" + std::string(known.reader) + "` for files of this kind";
    }
    all += (all.empty() ? "" : ", ") + std::string(known.kind);
  }
  return "the kinds are " + all;
}

}  // namespace taut::description
