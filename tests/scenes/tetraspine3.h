/// Tetraspine3: the three-segment spine of Mirletz, Park, Quinn, SunSpiral (IROS 2015), with the
/// numbers of its NTRT model; the same robot as share/models/tetraspine3.yaml. x is forward, y
/// left, z up; segment 0 is the front. With more segments it is the longer spine of the same
/// family.
#pragma once

#include <array>

#include "tests/scenes/solids.h"

namespace taut::scenes {

struct Tetraspine {
  int segments = 3;
  double clearance_m = 0.001825;  ///< Height of the lowest spheres above the ground.
  double damping_n_s_per_m = 20;
  Material material{0.15, 0.15, 0.2};
  Material ground{0.5, 0.5, 0.0};

  /// A segment is one body with the nodes right, left, top, tip, pcb_right, pcb_left. Cables
  /// outer_right, outer_left, outer_top, inner_right, inner_left, inner_top of each gap in turn.
  ModelDef Def() const {
    ModelDef def;
    def.name = "tetraspine" + std::to_string(segments);
    def.friction_combine = def.restitution_combine = CombineRule::kProduct;
    PlaneDef plane;
    plane.name = "ground";
    plane.material = ground;
    def.planes.push_back(plane);
    for (int s = 0; s < segments; ++s) Segment(def, s);
    for (int s = 0; s + 1 < segments; ++s) Cables(def, s);
    return def;
  }

 private:
  enum Node { kRight, kLeft, kTop, kTip, kPcbRight, kPcbLeft, kNodes };
  static constexpr double kEdgeM = 0.38, kRadiusM = 0.003175, kSpacingM = 0.23;
  static constexpr double kRodKgPerM = 0.0201 / 0.38, kStiffnessNPerM = 229.16;

  std::array<Vec3, kNodes> Nodes(int segment) const {
    const double high = std::sqrt(3.0) / 2 * kEdgeM;
    const double tip = kEdgeM / 2 / std::sqrt(3.0);  // edge / 2 tan(30 degrees)
    std::array<Vec3, kNodes> p{{{0, -kEdgeM / 2, 0},
                                {0, kEdgeM / 2, 0},
                                {0, 0, high},
                                {0.25, 0, tip},
                                {0, -kEdgeM / 4, high / 2},
                                {0, kEdgeM / 4, high / 2}}};
    // NTRT's front segment has its base plane at 0.77.
    for (Vec3& x : p) x = Sum(x, {0.77 - kSpacingM * segment, 0, kRadiusM + clearance_m});
    return p;
  }

  void Segment(ModelDef& def, int s) const {
    static constexpr std::array<const char*, kNodes> kNames{"right", "left",      "top",
                                                            "tip",   "pcb_right", "pcb_left"};
    static constexpr int kRods[8][2] = {{kRight, kLeft}, {kRight, kPcbRight}, {kPcbRight, kTop},
                                        {kRight, kTip},  {kLeft, kPcbLeft},   {kPcbLeft, kTop},
                                        {kLeft, kTip},   {kTop, kTip}};
    const bool first = s == 0, last = s == segments - 1;
    const double base = first ? 0.140 : last ? 0.100 : 0.180;
    const double tip = first ? 0.040 : 0.120, pcb = last && !first ? 0.095 : 0.070;
    const std::array<Vec3, kNodes> p = Nodes(s);
    const std::string name = "segment_" + std::to_string(s);
    Parts parts;
    for (const auto& rod : kRods) {
      const Vec3 &from = p[static_cast<std::size_t>(rod[0])],
                 &to = p[static_cast<std::size_t>(rod[1])];
      parts.AddCylinder(kRodKgPerM * LengthOf(Between(from, to)), from, to, kRadiusM);
      def.capsules.push_back({name, s, from, to, kRadiusM, material});
    }
    for (std::size_t i = 0; i < kNodes; ++i) {
      parts.AddSphere(i <= kTop ? base : i == kTip ? tip : pcb, p[i], kRadiusM);
      def.spheres.push_back({name + "." + kNames[i], s, p[i], kRadiusM, material});
      def.nodes.push_back({name + "." + kNames[i], s, p[i]});
    }
    def.bodies.push_back(parts.Body(name));
  }

  void Cables(ModelDef& def, int s) const {
    static constexpr std::array<const char*, 6> kNames{"outer_right", "outer_left", "outer_top",
                                                       "inner_right", "inner_left", "inner_top"};
    const std::array<Vec3, kNodes> front = Nodes(s), rear = Nodes(s + 1);
    for (std::size_t i = 0; i < 6; ++i) {
      Vec3 a = front[i % 3], b = rear[i < 3 ? i : static_cast<std::size_t>(kTip)];
      const Vec3 d = Between(a, b);
      const Vec3 u = Scaled(1 / LengthOf(d), d);
      a = Sum(a, Scaled(kRadiusM, u));  // NTRT attaches cables to the surfaces of the spheres
      b = Sum(b, Scaled(-kRadiusM, u));
      const double prestress_n = i % 3 == kTop ? 20 : 7;
      CableDef cable;
      cable.name = std::string(kNames[i]) + "_" + std::to_string(s + 1);
      cable.attachments = {{s, a}, {s + 1, b}};
      cable.stiffness_n_per_m = kStiffnessNPerM;
      cable.damping_n_s_per_m = damping_n_s_per_m;
      cable.rest_length_m = LengthOf(Between(a, b)) - prestress_n / kStiffnessNPerM;
      cable.actuator.kind = ActuatorDef::Kind::kLimited;
      cable.actuator.max_speed_m_per_s = 0.07;
      cable.actuator.max_acceleration_m_per_s2 = HUGE_VAL;
      cable.actuator.max_force_n = 50;
      cable.actuator.min_rest_length_m = 0.01;
      cable.actuator.min_length_m = 0.01;
      def.cables.push_back(cable);
    }
  }
};

}  // namespace taut::scenes
