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
      return "files of this kind are for `" + std::string(known.reader) + "`";
    }
    all += (all.empty() ? "" : ", ") + std::string(known.kind);
  }
  return "there are the kinds " + all;
}

}  // namespace taut::description
