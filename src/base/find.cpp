#include "taut/find.h"

#include <algorithm>
#include <string>
#include <vector>

namespace taut {
namespace {

template <class Element>
std::optional<int> Find(const std::vector<Element>& elements, MessageId id, const char* kind,
                        std::string_view name, Diagnostics* out) {
  const auto found = std::find_if(elements.begin(), elements.end(),
                                  [&](const Element& one) { return one.name == name; });
  if (found != elements.end()) return static_cast<int>(found - elements.begin());
  if (out != nullptr) {
    std::vector<std::string> names;
    for (const Element& one : elements) names.push_back(one.name);
    out->Error(id, {}, std::string("there is no ") + kind + " \"" + std::string(name) + "\"",
               names.empty() ? std::string("the model has no ") + kind : DidYouMean(name, names));
  }
  return std::nullopt;
}

}  // namespace

std::optional<int> FindBody(const ModelDef& def, std::string_view name, Diagnostics* out) {
  return Find(def.bodies, "name.no_body", "body", name, out);
}
std::optional<int> FindNode(const ModelDef& def, std::string_view name, Diagnostics* out) {
  return Find(def.nodes, "name.no_node", "node", name, out);
}
std::optional<int> FindCable(const ModelDef& def, std::string_view name, Diagnostics* out) {
  return Find(def.cables, "name.no_cable", "cable", name, out);
}
std::optional<int> FindJoint(const ModelDef& def, std::string_view name, Diagnostics* out) {
  return Find(def.joints, "name.no_joint", "joint", name, out);
}
std::optional<int> FindMotion(const ModelDef& def, std::string_view name, Diagnostics* out) {
  return Find(def.motions, "name.no_motion", "motion", name, out);
}

}  // namespace taut
