/// A tower of three-strut prisms with a plate on each: a stack whose loads pass through cables.
#pragma once

#include "tests/scenes/ball.h"
#include "tests/scenes/box.h"
#include "tests/scenes/chance.h"
#include "tests/scenes/prism3.h"

namespace taut::scenes {

struct PrismTower {
  int levels = 4;
  std::uint64_t seed = 1;  ///< Seed for the position of each plate.
  double plate_kg = 0.1;
  Material material{0.6, 0.6, 0.0};

  ModelDef Def() const {
    ModelDef def;
    def.name = "prism_tower";
    AddGround(def, material);
    Chance chance(seed);
    const Vec3 half{0.13, 0.13, 0.005};
    double high_m = 0;
    for (int level = 0; level < levels; ++level) {
      Prism3 prism;
      prism.clearance_m = high_m + 0.0005;
      prism.damping_n_s_per_m = 2;
      prism.material = material;
      Append(def, prism.Def(), std::to_string(level) + ".");
      high_m = prism.clearance_m + prism.height_m + 2 * prism.rod_radius_m + 0.0005;
      const double a = chance.Within(-0.5, 0.5);
      AddBox(def, std::to_string(level) + ".plate", plate_kg, half, {0, 0, high_m + half.z},
             Turn({0, 0, 1}, a), material);
      high_m += 2 * half.z;
    }
    return def;
  }

 private:
  /// Appends bodies, capsules, nodes and cables of another model, which has no other elements.
  static void Append(ModelDef& def, const ModelDef& part, const std::string& prefix) {
    const int first = static_cast<int>(def.bodies.size());
    const auto moved = [&](auto item) {
      item.name = prefix + item.name;
      return item;
    };
    for (const BodyDef& b : part.bodies) def.bodies.push_back(moved(b));
    for (const CapsuleDef& c : part.capsules) {
      def.capsules.push_back(moved(c));
      def.capsules.back().body += first;
    }
    for (const NodeDef& n : part.nodes) {
      def.nodes.push_back(moved(n));
      def.nodes.back().body += first;
    }
    for (const CableDef& c : part.cables) {
      def.cables.push_back(moved(c));
      for (AttachmentDef& a : def.cables.back().attachments) a.body += first;
    }
  }
};

}  // namespace taut::scenes
