/// Look-up of model elements by name. Each function returns the index of an element, which other
/// functions of taut take as argument.
///
///   const auto cable = taut::FindCable(model->def(), "outer_top_1", &found);
///
/// If there is no such element, a function returns nothing and reports an error with the closest
/// name to `out`, if given. A search takes time proportional to the number of elements: search
/// once, before the loop.
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
/// Finds the motion of a kinematic body.
std::optional<int> FindMotion(const ModelDef& def, std::string_view name,
                              Diagnostics* out = nullptr);

}  // namespace taut
