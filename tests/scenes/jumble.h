/// A mixed scene: a box, a ball, a rod and a sled fall onto a floor, a wall, a ramp and a step,
/// with cables of all kinds between them. Different starts lead to different contacts.
#pragma once

#include <limits>

#include "tests/scenes/ball.h"
#include "tests/scenes/rod.h"

namespace taut::scenes {

struct Jumble {
  ModelDef Def() const {
    ModelDef def;
    def.name = "jumble";
    const Material rough{0.7, 0.5, 0.3}, smooth{0.2, 0.1, 0.6};
    Terrain(def, rough);
    BodyDef box;
    box.name = "box";
    box.mass_kg = 0.4;
    box.com_m = {0.2, 0.1, 0.45};
    box.inertia_kg_m2 = BoxInertia(0.4, {0.1, 0.06, 0.04});
    def.bodies.push_back(box);
    def.boxes.push_back({"box", 0, box.com_m, {}, {0.1, 0.06, 0.04}, rough});
    def.nodes.push_back({"box", 0, Sum(box.com_m, {0.1, 0.06, 0.04})});
    AddBall(def, "ball", 0.15, 0.05, {-0.2, 0.1, 0.4}, smooth);
    AddRod(def, "rod", 0.08, 0.01, {-0.25, -0.2, 0.3}, {0.25, -0.15, 0.5}, rough);
    Sled(def, smooth);
    Cables(def);
    return def;
  }

 private:
  static void Terrain(ModelDef& def, const Material& material) {
    AddGround(def, material);
    PlaneDef wall;
    wall.name = "wall";
    wall.normal = {-0.8, 0, 0.6};
    wall.point_m = {0.5, 0, 0};
    wall.material = material;
    def.planes.push_back(wall);
    def.terrain_boxes.push_back(
        {"ramp", {-0.6, 0, 0}, Turn({0, 1, 0}, 0.4), {0.4, 0.5, 0.1}, material});
    def.terrain_boxes.push_back({"step", {0, 0.5, 0.05}, {}, {0.5, 0.2, 0.05}, material});
  }

  static void Sled(ModelDef& def, const Material& material) {
    const int index = static_cast<int>(def.bodies.size());
    Parts parts;
    for (int i = 0; i < 3; ++i) {
      const double a = 2.0943951023931953 * i;
      const Vec3 p{0.08 * std::cos(a), -0.05 + 0.08 * std::sin(a), 0.2};
      parts.AddSphere(0.05, p, 0.02);
      def.spheres.push_back({"runner_" + std::to_string(i), index, p, 0.02, material});
    }
    def.bodies.push_back(parts.Body("sled"));
    def.nodes.push_back({"sled", index, {0.08, -0.05, 0.2}});
  }

  static void Cables(ModelDef& def) {
    const Vec3 box = def.bodies[0].com_m, ball = def.bodies[1].com_m, sled = def.bodies[3].com_m;
    CableDef soft;
    soft.name = "soft";
    soft.attachments = {{0, Sum(box, {-0.1, 0, 0})}, {2, {-0.25, -0.2, 0.3}}};
    soft.stiffness_n_per_m = 80;
    soft.damping_n_s_per_m = 0.5;
    soft.rest_length_m = 0.4;
    soft.actuator.kind = ActuatorDef::Kind::kLimited;
    soft.actuator.max_speed_m_per_s = 0.3;
    soft.actuator.max_acceleration_m_per_s2 = 2;
    soft.actuator.max_force_n = 20;
    def.cables.push_back(soft);
    CableDef stiff;
    stiff.name = "stiff";
    stiff.attachments = {{1, ball}, {3, sled}};
    stiff.stiffness_n_per_m = 1e6;
    stiff.damping_n_s_per_m = 100;
    stiff.rest_length_m = 0.3;
    def.cables.push_back(stiff);
    CableDef routed;
    routed.name = "routed";
    routed.attachments = {{kWorld, {0, 0, 1}}, {2, {0.25, -0.15, 0.5}}, {3, sled}};
    routed.stiffness_n_per_m = 30;
    routed.damping_n_s_per_m = 1;
    routed.rest_length_m = 0.9;
    routed.damping_law = DampingLaw::kClamped;
    routed.actuator.kind = ActuatorDef::Kind::kIdeal;
    def.cables.push_back(routed);
  }
};

}  // namespace taut::scenes
