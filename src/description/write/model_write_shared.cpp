// Queries and messages that the steps of the model writer share.
#include <algorithm>

#include "description/write/model_write.h"

namespace taut::description {

void RefuseModel(Diagnostics& out, const std::string& what, const std::string& hint) {
  out.Error("write.not_expressible", {},
            "a model file cannot describe this robot completely: " + what, hint);
}

bool IsTerrain(const ModelDef& def, int body) {
  const auto at_body = [&](const auto& part) { return part.body == body; };
  return std::any_of(def.motions.begin(), def.motions.end(), at_body) &&
         std::none_of(def.nodes.begin(), def.nodes.end(), at_body) &&
         std::none_of(def.capsules.begin(), def.capsules.end(), at_body);
}

bool IsAnchored(const ModelDef& def, int body) {
  const BodyDef& b = def.bodies[static_cast<std::size_t>(body)];
  const bool moved = std::any_of(def.motions.begin(), def.motions.end(),
                                 [&](const MotionDef& motion) { return motion.body == body; });
  return b.fixed && !(moved && b.mass_kg > 0);
}

int NodeAt(const WrittenModel& model, int body, const Vec3& p) {
  for (std::size_t n = 0; n < model.nodes.size(); ++n) {
    const Vec3& at = model.nodes[n].position_m;
    if (model.nodes[n].body == body && at.x == p.x && at.y == p.y && at.z == p.z) {
      return static_cast<int>(n);
    }
  }
  return -1;
}

void Build(std::vector<WrittenBuilder>& list, const std::string& text, int on) {
  const auto same = std::find_if(list.begin(), list.end(),
                                 [&](const WrittenBuilder& b) { return b.text == text; });
  if (same == list.end()) {
    list.push_back({text, {on}});
  } else {
    same->on.push_back(on);
  }
}

}  // namespace taut::description
