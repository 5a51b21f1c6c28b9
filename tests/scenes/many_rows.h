/// Overconstrained scenes of few bodies and many rows: contacts or stiff cables that share a load.
#pragma once

#include "tests/scenes/ball.h"
#include "tests/scenes/chance.h"

namespace taut::scenes {

/// A disc on a ring of feet, dragged by a cable: three feet would carry it.
struct FootedDisc {
  int feet = 64;
  double left_m = 0.2;  ///< Lateral position of the cable's far end, a meter ahead.
  Material material{0.5, 0.5, 0.0};

  ModelDef Def() const {
    ModelDef def;
    def.name = "footed";
    AddGround(def, material);
    const double foot_m = 0.01, disc_m = 0.3, pi = 3.14159265358979323846;
    Parts parts;
    parts.AddCylinder(2, {0, 0, 0.03}, {0, 0, 0.05}, disc_m);
    def.bodies.push_back(parts.Body("disc"));
    for (int i = 0; i < feet; ++i) {
      const double a = 2 * pi * i / feet;
      const Vec3 at{disc_m * std::cos(a), disc_m * std::sin(a), foot_m};
      def.spheres.push_back({"foot_" + std::to_string(i), 0, at, foot_m, material});
    }
    CableDef cable;
    cable.name = "drag";
    cable.attachments = {{0, {0, 0, 0.05}}, {kWorld, {1, left_m, 0.05}}};
    cable.stiffness_n_per_m = 500;
    cable.damping_n_s_per_m = 5;
    cable.rest_length_m = 1.0;
    cable.actuator.kind = ActuatorDef::Kind::kIdeal;
    def.cables.push_back(cable);
    return def;
  }
};

/// A square net of knots that hangs at its rim, with a heavy ball in it.
struct BallInNet {
  int knots = 5;  ///< Number of knots along a side, including the rim.
  double stiffness_n_per_m = 1e6, damping_n_s_per_m = 0;
  double ball_kg = 50;
  std::uint64_t seed = 1;  ///< Seed for the position of the ball.
  Material material{0.5, 0.5, 0.0};

  ModelDef Def() const {
    ModelDef def;
    def.name = "ball_in_net";
    std::vector<int> body(static_cast<std::size_t>(knots * knots), kWorld);
    for (int i = 1; i + 1 < knots; ++i) {
      for (int j = 1; j + 1 < knots; ++j) {
        const std::string name = "knot_" + std::to_string(i) + "_" + std::to_string(j);
        body[At(i, j)] = AddBall(def, name, 0.05, 0.02, Place(i, j), material);
      }
    }
    for (int i = 0; i < knots; ++i) {
      for (int j = 0; j < knots; ++j) {
        if (i + 1 < knots) Cord(def, body, i, j, i + 1, j);
        if (j + 1 < knots) Cord(def, body, i, j, i, j + 1);
      }
    }
    Chance chance(seed);
    const Vec3 off = chance.Jolt(0.01);
    AddBall(def, "ball", ball_kg, 0.2, {off.x, off.y, 1.221}, material);
    return def;
  }

 private:
  static constexpr double kMeshM = 0.2;

  std::size_t At(int i, int j) const { return static_cast<std::size_t>(i * knots + j); }
  Vec3 Place(int i, int j) const {
    return {kMeshM * (i - 0.5 * (knots - 1)), kMeshM * (j - 0.5 * (knots - 1)), 1};
  }
  void Cord(ModelDef& def, const std::vector<int>& body, int i, int j, int k, int l) const {
    const int a = body[At(i, j)], b = body[At(k, l)];
    if (a == kWorld && b == kWorld) return;  // along the rim
    CableDef cable;
    cable.name = "cord_" + std::to_string(def.cables.size());
    cable.attachments = {{a, Place(i, j)}, {b, Place(k, l)}};
    cable.stiffness_n_per_m = stiffness_n_per_m;
    cable.damping_n_s_per_m = damping_n_s_per_m;
    cable.rest_length_m = 0.999 * kMeshM;
    def.cables.push_back(cable);
  }
};

}  // namespace taut::scenes
