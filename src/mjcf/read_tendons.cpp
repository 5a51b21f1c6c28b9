// Reader of spatial tendons.
#include <algorithm>
#include <cmath>

#include "mjcf/mjcf_scene.h"

namespace taut::mjcf {
namespace {

/// Reads `springlength` of all layers. One number sets both lengths, as in MuJoCo.
void ReadSpringLength(const Layers& layers, Tendon& tendon, Diagnostics& out) {
  double* const l = tendon.springlength;
  for (const Element* const layer : layers.all()) {
    const Layers one({layer}, out);
    const auto n = one.Numbers("springlength", {}, 1, 2);
    if (n.empty()) continue;
    l[0] = n[0], l[1] = n.back();
  }
  if (l[0] == -1 && l[1] == -1) return;
  if (l[0] > l[1] || l[1] < 0) {
    layers.Error("mjcf.springlength", "springlength",
                 "springlength must neither decrease nor be negative",
                 "-1 stands for the length at the start");
  }
}

}  // namespace

void ReadTendons(const Element& root, const Defaults& defaults, Scene& scene, Diagnostics& out) {
  for (const Element* const section : Sections(root, "tendon")) {
    for (const Element& e : section->children) {
      if (e.name != "spatial") continue;
      const Layers layers = defaults.Over(e, "", out);
      Tendon tendon;
      tendon.at = e.at;
      const int index = static_cast<int>(scene.tendons.size());
      tendon.name = layers.Text("name", "tendon_" + std::to_string(index));
      Register(scene.tendon_by_name, e, index, out);
      if (const Attribute* const cls = e.Find("class")) tendon.tag = cls->value;
      for (const Element& site : e.children) {
        if (site.name != "site") continue;
        tendon.sites.push_back(Find(scene.site_by_name, site, "site", "site", out));
      }
      if (tendon.sites.size() < 2 && e.children.size() == tendon.sites.size()) {
        out.Error("mjcf.few_sites", e.at, e.Called() + " has fewer than two sites");
      }
      tendon.stiffness = layers.Numbers("stiffness", {0}, 1, 3)[0];
      tendon.damping = layers.Numbers("damping", {0}, 1, 3)[0];
      for (const char* polynomial : {"stiffness", "damping"}) {
        const auto n = layers.Numbers(polynomial, {0, 0, 0}, 1, 3);
        if (n[1] == 0 && n[2] == 0) continue;
        layers.Error("mjcf.polynomial", polynomial,
                     std::string(polynomial) +
                         " with a nonzero second or third coefficient is not supported");
      }
      ReadSpringLength(layers, tendon, out);
      tendon.friction = scene.has_dry_friction ? layers.Number("frictionloss", 0) : 0;
      if (layers.Number("armature", 0) != 0) {
        layers.Error("mjcf.armature", "armature", "armature of a tendon is not supported");
      }
      for (const char* key : {"stiffness", "damping", "frictionloss"}) {
        if (layers.Numbers(key, {0}, 1, 3)[0] < 0) {
          layers.Error("mjcf.negative", key, std::string(key) + " must not be negative");
        }
      }
      tendon.range = layers.Range("limited", "range", scene.settings);
      if (layers.Range("actuatorfrclimited", "actuatorfrcrange", scene.settings)) {
        layers.Error("mjcf.actuatorfrcrange", "actuatorfrcrange",
                     "actuatorfrcrange is not supported", "use forcerange of the actuator");
      }
      scene.tendons.push_back(std::move(tendon));
    }
  }
}

}  // namespace taut::mjcf
