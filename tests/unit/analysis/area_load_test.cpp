// Area loads of load cases: resultant and moment of the forces on nodes, and reactions, against
// pressure times area
#include <gmock/gmock.h>

#include <cmath>

#include "math/vec.h"
#include "taut/analysis.h"
#include "unit/description/experiment_fixture.h"

namespace taut::test {
namespace {

// An inclined roof of 2 x 1 cells, 4 m x 3 m in plan, rising by 3 m over its width of 4 m: 15 m^2
constexpr const char* kRoof = R"(taut: 1
kind: model
name: roof
nodes: {a0: [0, 0, 1], a1: [2, 0, 2.5], a2: [4, 0, 4], b0: [0, 3, 1], b1: [2, 3, 2.5], b2: [4, 3, 4]}
pairs:
  - {tags: [edge], each: [[a0, a1], [a1, a2], [b0, b1], [b1, b2], [a0, b0], [a2, b2]]}
  - {tags: [rafter], each: [[a1, b1]]}
builders:
  - {match: [[edge], [rafter]], bar: {young_pa: 200e9, area_m2: 1e-3, mass_kg: 1}}
  - {match: [[a0], [a1], [a2], [b0], [b1], [b2]], support: {kind: ball}}
)";
// A pyramid over a square ring of 4 m, 1.5 m high: faces of 5 m^2 each
constexpr const char* kPyramid = R"(taut: 1
kind: model
name: pyramid
nodes: {p0: [2, 2, 0], p1: [-2, 2, 0], p2: [-2, -2, 0], p3: [2, -2, 0], top: [0, 0, 1.5]}
pairs:
  - {tags: [ring], each: [[p0, p1], [p1, p2], [p2, p3], [p3, p0]]}
  - {tags: [leg], each: [[p0, top], [p1, top], [p2, top], [p3, top]]}
builders:
  - {match: [[ring], [leg]], bar: {young_pa: 200e9, area_m2: 1e-3, mass_kg: 1}}
  - {match: [[p0], [p1], [p2], [p3]], support: {kind: ball}}
)";

struct Resultant {
  Vec3 force_n, moment_n_m;  ///< Moment about the origin.
};

class AreaLoads : public ExperimentFolder {
 protected:
  /// Reads an experiment with one load case that has this area load; a second case doubles it.
  ExperimentSpec With(const char* model, const std::string& load) {
    Write("model.yaml", model);
    Write("trial.yaml", Text(load));
    return Load();
  }
  static std::string Text(const std::string& load) {
    return "taut: 1\nkind: experiment\nname: loads\nmodel: model.yaml\nduration_s: 1\n"
           "load_cases:\n  - {name: one, weight: false, area_loads: [" +
           load + "]}\nload_combinations: [{name: two, factors: {one: 1.5}}]\n";
  }
  static Resultant Sum(const ExperimentSpec& e, std::size_t load_case = 0) {
    Resultant sum;
    for (const auto& force : e.load_cases.at(load_case).forces) {
      const Vec3 at = e.robot.def.nodes[static_cast<std::size_t>(force.node)].position_m;
      sum.force_n = sum.force_n + force.force_n;
      sum.moment_n_m = sum.moment_n_m + Cross(at, force.force_n);
    }
    return sum;
  }
  static void ExpectNear(const Vec3& a, const Vec3& b) {
    EXPECT_LT(Length(a - b), 1e-9) << a.x << ' ' << a.y << ' ' << a.z;
  }
};

constexpr const char* kAll = "nodes: [[a0], [a1], [a2], [b0], [b1], [b2]]";

TEST_F(AreaLoads, WindIsNormalToTheSurfaceOnTheSideThatItHits) {
  const Vec3 middle{2, 1.5, 2.5}, normal{-0.6, 0, 0.8};
  for (const double side : {1.0, -1.0}) {
    const ExperimentSpec e =
        With(kRoof, std::string("{") + kAll + ", pressure_pa: 40, direction: [" +
                        (side > 0 ? "-1" : "1") + ", 0, 0]}");
    const Vec3 force = (side * 40 * 15) * normal;
    ExpectNear(Sum(e).force_n, force);
    ExpectNear(Sum(e).moment_n_m, Cross(middle, force));
    ExpectNear(Sum(e, 1).force_n, 1.5 * force);
  }
}

TEST_F(AreaLoads, SnowActsOnTheProjectedArea) {
  const ExperimentSpec e =
      With(kRoof,
           "{members: [[edge], [rafter]], pressure_pa: 500, direction: [0, 0, -1], "
           "projected: true}");
  const Vec3 force{0, 0, -500 * 12.0};
  ExpectNear(Sum(e).force_n, force);
  ExpectNear(Sum(e).moment_n_m, Cross(Vec3{2, 1.5, 0}, force));
  // cells of 6 m^2: a quarter of each on each of its corners
  for (const auto& one : e.load_cases[0].forces) {
    const std::string& name = e.robot.def.nodes[static_cast<std::size_t>(one.node)].name;
    EXPECT_NEAR(one.force_n.z, -500 * 6 / 4.0 * (name[1] == '1' ? 2 : 1), 1e-9) << name;
  }
}

TEST_F(AreaLoads, DividedAndHiddenFacesHaveNoLoad) {
  // the square below the legs is behind them
  const ExperimentSpec snow =
      With(kPyramid,
           "{members: [[ring], [leg]], pressure_pa: 100, direction: [0, 0, -1], projected: true}");
  ExpectNear(Sum(snow).force_n, {0, 0, -100 * 16.0});
  // only the face toward -x: 5 m^2, normal (-0.6, 0, 0.8)
  const ExperimentSpec wind =
      With(kPyramid, "{members: [[ring], [leg]], pressure_pa: 100, direction: [1, 0, 0]}");
  ExpectNear(Sum(wind).force_n, {300, 0, -400});
  // a flat pyramid: the four triangles divide the square
  std::string flat = kPyramid;
  flat.replace(flat.find("0, 0, 1.5"), 9, "0, 0, 0.0");
  const ExperimentSpec once =
      With(flat.c_str(), "{members: [[ring], [leg]], pressure_pa: 100, direction: [0, 0, -1]}");
  ExpectNear(Sum(once).force_n, {0, 0, -100 * 16.0});
}

TEST_F(AreaLoads, ReactionsAreThePressureTimesTheArea) {
  const ExperimentSpec e =
      With(kPyramid,
           "{members: [[ring], [leg]], pressure_pa: 100, direction: [0, 0, -1], projected: true}");
  const Equilibrium at = FindEquilibrium(e.robot.def, e.load_cases[0]);
  ASSERT_TRUE(at.found) << at.why;
  Vec3 sum;
  for (std::size_t j = 0; j < e.robot.def.joints.size(); ++j) {
    if (IsBar(e.robot.def.joints[j])) continue;
    sum = sum + at.joint_loads[j].force_n;
  }
  EXPECT_NEAR(sum.x, 0, 1e-6);
  EXPECT_NEAR(sum.y, 0, 1e-6);
  EXPECT_NEAR(std::fabs(sum.z), 1600, 1e-6);
  // a third of each of the four faces on the top: 4 / 3 * 400 N, on legs with slope 1.5 : sqrt(8)
  const double leg = std::sqrt(8 + 2.25);
  for (std::size_t j = 0; j < e.robot.def.joints.size(); ++j) {
    if (e.robot.def.joints[j].name.find("top") == std::string::npos) continue;
    EXPECT_NEAR(at.bar_force_n[j], -1600 / 3.0 / 4 * leg / 1.5, 0.01);
  }
}

TEST_F(AreaLoads, MistakesAreNamed) {
  Write("model.yaml", kRoof);
  const auto complaints = [&](const std::string& load) {
    Write("trial.yaml", Text(load));
    return Without("trial.yaml:", Complaints());
  };
  EXPECT_EQ(complaints("{members: rafter, pressure_pa: 1, direction: [0, 0, -1]}"),
            "7:45: error: area_loads: the selected members form no triangle and no flat "
            "quadrilateral (select all members at the edges of the surface)\n");
  EXPECT_EQ(complaints("{nodes: [[a0], [b2]], pressure_pa: 1, direction: [0, 0, -1]}"),
            "7:53: error: area_loads.nodes: no member connects two of the selected nodes\n");
  EXPECT_EQ(complaints("{nodes: c0, pressure_pa: 1, direction: [0, 0, -1]}"),
            "7:53: error: area_loads.nodes: no node matches c0 (no node is called or tagged "
            "\"c0\"; did you mean \"a0\"?)\n");
  EXPECT_EQ(complaints("{nodes: a0, members: rafter, pressure_pa: 1, direction: [0, 0, -1]}"),
            "7:46: error: area_load has both members and nodes (give only one of them)\n");
}

}  // namespace
}  // namespace taut::test
