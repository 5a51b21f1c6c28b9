/// Look-up of model elements by name. Each function returns the index of an element, as used by
/// other functions of taut.
///
///   const auto cable = taut::FindCable(model->def(), "outer_top_1", &found);
///
/// If no such element exists, a function returns nothing. If `out` is given, it gets an error with
/// the most similar name. The search time is proportional to the number of elements, so search
/// before a loop, not in it.
///
/// Threads: all functions are pure; any number may run concurrently.
#pragma once

#include <optional>
#include <string_view>

#include "taut/diagnostics.h"
#include "taut/model_def.h"

namespace taut {

std::optional<int> FindBody(const ModelDef& def, std::string_view name, Diagnostics* out = nullptr);
std::optional<int> FindNode(const ModelDef& def, std::string_view name, Diagnostics* out = nullptr);
std::optional<int> FindCable(const ModelDef& def, std::string_view name,
                             Diagnostics* out = nullptr);
std::optional<int> FindJoint(const ModelDef& def, std::string_view name,
                             Diagnostics* out = nullptr);
/// Finds the prescribed motion of a kinematic body.
std::optional<int> FindMotion(const ModelDef& def, std::string_view name,
                              Diagnostics* out = nullptr);

}  // namespace taut
