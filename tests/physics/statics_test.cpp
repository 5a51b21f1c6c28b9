/// Equilibrium shapes with closed forms (Connelly and Terrell 1995; Tibert and Pellegrino 2003),
/// for any rest lengths: prisms, the six-strut, Snelson's X, the T-bar.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/physics/world.h"
#include "tests/scenes/six_strut.h"

namespace taut::test {
namespace {

/// Brings a robot without gravity to rest: whenever its kinetic energy begins to fall, all
/// velocities are set to zero (kinetic damping), so that mechanisms, which cables damp least,
/// settle as fast as other motions. Returns the largest speed of a node in the last second.
double Settle(WorldBatch& world, double time_s) {
  const double h = 1e-3;
  const ModelDef& def = world.model().def();
  double before = 0, speed = 0;
  for (int n = 0; n < StepsIn(time_s, h); ++n) {
    world.Step(h);
    const double energy = world.TotalEnergy(0).kinetic_j;
    for (int node = 0; node < static_cast<int>(def.nodes.size()); ++node) {
      speed = std::max(speed, Norm(world.NodeVelocity(0, node)));
    }
    if (n < StepsIn(time_s - 1, h)) {
      speed = 0;
      if (energy < before) {
        for (int b = 0; b < static_cast<int>(def.bodies.size()); ++b) {
          BodyState body = world.Body(0, b);
          body.velocity_m_per_s = body.angular_velocity_rad_per_s = {};
          world.SetBodyState(0, b, body);
        }
      }
    }
    before = energy;
  }
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
  return speed;
}

void AddCable(ModelDef& def, int node_a, int node_b, double stiffness, double rest_length) {
  const NodeDef &a = def.nodes[static_cast<std::size_t>(node_a)],
                &b = def.nodes[static_cast<std::size_t>(node_b)];
  CableDef cable;
  cable.name = a.name + "-" + b.name;
  cable.attachments = {{a.body, a.position_m}, {b.body, b.position_m}};
  cable.stiffness_n_per_m = stiffness;
  cable.damping_n_s_per_m = 1;
  cable.rest_length_m = rest_length;
  def.cables.push_back(cable);
}

/// Returns a prism of n struts with displaced nodes. Nodes 2 i and 2 i + 1 are the lower and upper
/// end of strut i; cables: n lower, n upper, n sides.
ModelDef Prism(int n, double polygon_rest_m, double side_rest_m, double twist_off_rad) {
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  const double r = 0.3, height = 0.5,
               twist = std::numbers::pi / 2 + std::numbers::pi / n + twist_off_rad;
  const auto corner = [&](double angle, double z) {
    return Vec3{r * std::cos(angle), r * std::sin(angle), z};
  };
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    scenes::AddRod(def, "strut_" + std::to_string(i), 0.1, 0.005, corner(a, 0),
                   corner(a + twist, height), {});
  }
  for (CapsuleDef& rod : def.capsules)
    rod.collides = false;  // eight thin struts may meet while settling
  for (int i = 0; i < n; ++i) AddCable(def, 2 * i, 2 * ((i + 1) % n), 2000, polygon_rest_m);
  for (int i = 0; i < n; ++i) AddCable(def, 2 * i + 1, 2 * ((i + 1) % n) + 1, 2000, polygon_rest_m);
  for (int i = 0; i < n; ++i) AddCable(def, 2 * i, 2 * ((i + n - 1) % n) + 1, 2000, side_rest_m);
  return def;
}

TEST(Statics, APrismSettlesAtItsTwistWithItsSelfStress) {
  // Twist along a side cable 90 - 180/n degrees (150 degrees along a strut for n = 3); the force
  // density of a polygon cable is 1 / (2 sin(pi / n)) times the force density of a side cable:
  // neither depends on rest lengths.
  for (const int n : {3, 4, 5, 6, 8}) {
    for (const double twist_off : {-0.15, 0.1}) {
      for (const double side_rest : {0.42, 0.48}) {
        const double edge = 2 * 0.3 * std::sin(std::numbers::pi / n);
        WorldBatch world = MakeBatch(Prism(n, 0.9 * edge, side_rest, twist_off));
        const double speed = Settle(world, 20);
        const std::string what = std::to_string(n) + " struts, side " + std::to_string(side_rest);
        EXPECT_LT(speed, 1e-9) << what;
        // Directions from the axis, which passes through the centers of the two polygons.
        Vec3 low, high;
        for (int i = 0; i < n; ++i) {
          low = low + (1.0 / n) * world.NodePosition(0, 2 * i);
          high = high + (1.0 / n) * world.NodePosition(0, 2 * i + 1);
        }
        const Vec3 axis = (1 / Distance(high, low)) * (high - low);
        const auto turn = [&](const Vec3& from, const Vec3& to) {
          return std::atan2(Dot(axis, Cross(from, to)),
                            Dot(from, to) - Dot(from, axis) * Dot(to, axis));
        };
        const double along_side =
            turn(world.NodePosition(0, 0) - low, world.NodePosition(0, 2 * n - 1) - high);
        const double along_strut =
            turn(world.NodePosition(0, 0) - low, world.NodePosition(0, 1) - high);
        EXPECT_NEAR(along_side, std::numbers::pi / 2 - std::numbers::pi / n, 1e-10) << what;
        EXPECT_NEAR(along_strut, std::numbers::pi / 2 + std::numbers::pi / n, 1e-10) << what;
        const auto density = [&](int cable) {
          return world.Cable(0, cable).tension_n / world.Cable(0, cable).length_m;
        };
        for (int i = 0; i < 2 * n; ++i) {
          EXPECT_NEAR(density(i) / density(2 * n), 1 / (2 * std::sin(std::numbers::pi / n)), 1e-10)
              << what;
        }
        for (int i = 0; i < n; ++i) EXPECT_GT(density(2 * n + i), 1) << what;
      }
    }
  }
}

TEST(Statics, ASixStrutSettlesWhereItsStrutsAreSqrt8ThirdsOfItsCables) {
  for (const double spacing : {0.4, 0.6}) {
    for (const double tension : {40.0, 200.0}) {
      scenes::SixStrut scene;
      scene.spacing = spacing;
      scene.damping_n_s_per_m = 1;
      scene.tension_n = tension;
      scene.orientation = scenes::Turn({0.6, 0.48, 0.64}, 1.1);
      ModelDef def = scene.Def();
      def.gravity_m_per_s2 = {0, 0, 0};
      WorldBatch world = MakeBatch(def);
      const double speed = Settle(world, 60);
      EXPECT_LT(speed, 1e-9);
      for (int c = 0; c < 24; ++c) {
        const CableState cable = world.Cable(0, c);
        EXPECT_NEAR(scene.length_m / cable.length_m, std::sqrt(8.0 / 3), 1e-10) << c;
        EXPECT_NEAR(cable.tension_n, tension, 1e-9 * tension) << c;
      }
      for (int i = 0; i < 6; i += 2) {
        EXPECT_NEAR(Distance(world.Body(0, i).position_m, world.Body(0, i + 1).position_m),
                    scene.length_m / 2, 1e-10);
      }
    }
  }
}

/// Returns two crossing struts that pass through each other, lengths `a` along x and `b` along y,
/// slightly rotated and displaced relative to each other, with four cables around them.
ModelDef Cross(double a, double b, double stiffness, const std::vector<double>& rest_length) {
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  const double turn = 0.2;
  scenes::AddRod(def, "one", 0.2, 0.005, {-a / 2, 0, 0.01}, {a / 2, 0, 0.01}, {});
  const Vec3 tip{b / 2 * std::sin(turn), b / 2 * std::cos(turn), 0}, middle{0.02, -0.03, -0.01};
  scenes::AddRod(def, "two", 0.3, 0.005, middle - tip, middle + tip, {});
  for (CapsuleDef& rod : def.capsules) rod.collides = false;
  const int ring[] = {0, 2, 1, 3};
  for (std::size_t i = 0; i < 4; ++i) {
    AddCable(def, ring[i], ring[(i + 1) % 4], stiffness, rest_length[i]);
  }
  return def;
}

TEST(Statics, SnelsonsXSettlesAsASquareWhoseStrutsCarrySqrt2OfItsCables) {
  for (const double length : {0.6, 1.0}) {
    const double side = length / std::sqrt(2.0), rest = 0.9 * side;
    WorldBatch world = MakeBatch(Cross(length, length, 1000, {rest, rest, rest, rest}));
    EXPECT_LT(Settle(world, 40), 1e-9);
    for (int c = 0; c < 4; ++c) {
      EXPECT_NEAR(world.Cable(0, c).length_m, side, 1e-10) << c;
      EXPECT_NEAR(world.Cable(0, c).tension_n, 1000 * (side - rest), 1e-7) << c;
    }
    // A strut carries the axial component of the forces of the two cables at its end.
    const Vec3 end = world.NodePosition(0, 0), along = end - world.NodePosition(0, 1);
    Vec3 pull;
    for (const int other : {2, 3}) {
      const Vec3 d = world.NodePosition(0, other) - end;
      pull = pull + (world.Cable(0, 0).tension_n / Norm(d)) * d;
    }
    EXPECT_NEAR(Dot(pull, along) / Norm(along) / world.Cable(0, 0).tension_n, -std::sqrt(2.0),
                1e-7);
    EXPECT_LE(Norm(world.Body(0, 0).position_m - world.Body(0, 1).position_m), 1e-7);
  }
}

TEST(Statics, ATBarSettlesAsARhombusWithOneForceDensity) {
  // Struts of 2 m and 4 m that bisect each other at a right angle: cables of sqrt(5) m, all with
  // the same force density q, the struts with -q. (T-bar of the structural tools: 50 N/m.)
  const double side = std::sqrt(5.0), stiffness = 5000, q = 50, rest = side - q * side / stiffness;
  WorldBatch world = MakeBatch(Cross(2, 4, stiffness, {rest, rest, rest, rest}));
  EXPECT_LT(Settle(world, 60), 1e-9);
  for (int c = 0; c < 4; ++c) {
    EXPECT_NEAR(world.Cable(0, c).length_m, side, 1e-10) << c;
    EXPECT_NEAR(world.Cable(0, c).tension_n, q * side, 1e-6) << c;
  }
  const double length[] = {2, 4};
  for (int strut = 0; strut < 2; ++strut) {
    const Vec3 end = world.NodePosition(0, 2 * strut);
    const Vec3 along = (1 / length[strut]) * (end - world.NodePosition(0, 2 * strut + 1));
    Vec3 pull;
    for (const int other : {2 - 2 * strut, 3 - 2 * strut}) {
      pull = pull + q * (world.NodePosition(0, other) - end);
    }
    EXPECT_NEAR(Dot(pull, along), -q * length[strut], 1e-7) << strut;
  }
}

}  // namespace
}  // namespace taut::test
