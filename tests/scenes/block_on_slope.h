/// A block, or a sled on three balls, at rest on a tilted plane through the origin. Downhill is
/// towards +x.
#pragma once

#include "tests/scenes/solids.h"

namespace taut::scenes {

struct Slope {
  double angle_rad = 0.0;
  Material material{0.5, 0.5, 0.0};

  /// Returns the rotation of z to the plane's normal and of x to the downhill direction.
  Quat orientation() const { return Turn({0, 1, 0}, angle_rad); }
  Vec3 normal() const { return {std::sin(angle_rad), 0, std::cos(angle_rad)}; }
  Vec3 downhill() const { return {std::cos(angle_rad), 0, -std::sin(angle_rad)}; }

  void AddTo(ModelDef& def) const {
    PlaneDef plane;
    plane.name = "slope";
    plane.normal = normal();
    plane.material = material;
    def.planes.push_back(plane);
  }
};

struct BlockOnSlope {
  Slope slope;
  double mass_kg = 1.0;
  Vec3 half_m{0.1, 0.06, 0.03};
  Material material{0.5, 0.5, 0.0};

  ModelDef Def() const {
    ModelDef def;
    def.name = "block_on_slope";
    slope.AddTo(def);
    const Quat q = slope.orientation();
    BodyDef body;
    body.name = "block";
    body.mass_kg = mass_kg;
    body.com_m = Scaled(half_m.z, slope.normal());
    body.inertia_kg_m2 = TurnedInertia(BoxInertia(mass_kg, half_m), q);
    def.bodies.push_back(body);
    def.boxes.push_back({"block", 0, body.com_m, q, half_m, material});
    def.nodes.push_back({"block", 0, body.com_m});
    return def;
  }
};

struct SledOnSlope {
  Slope slope;
  double mass_kg = 0.6;
  double runner_radius_m = 0.01;
  double reach_m = 0.1;      ///< Distance from the center to the balls.
  double heading_rad = 0.0;  ///< Direction of the first ball, about the normal.
  Material material{0.5, 0.5, 0.0};

  /// Returns a sled of three balls, each with a third of the mass.
  ModelDef Def() const {
    ModelDef def;
    def.name = "sled_on_slope";
    slope.AddTo(def);
    Parts parts;
    for (int i = 0; i < 3; ++i) {
      const double a = heading_rad + i * 2.0943951023931953;  // 2 pi / 3
      const Vec3 flat{reach_m * std::cos(a), reach_m * std::sin(a), runner_radius_m};
      const Vec3 p = Turned(slope.orientation(), flat);
      parts.AddSphere(mass_kg / 3, p, runner_radius_m);
      def.spheres.push_back({"runner_" + std::to_string(i), 0, p, runner_radius_m, material});
    }
    def.bodies.push_back(parts.Body("sled"));
    def.nodes.push_back({"sled", 0, def.bodies[0].com_m});
    return def;
  }
};

}  // namespace taut::scenes
