// Form finding against closed forms: a chain's parabola, the twist of prisms, and the spacing of
// six struts
#include "taut/form_finding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "math/vec.h"
#include "taut/statics.h"

namespace taut {
namespace {

double Distance(const FormNet& net, int a, int b) {
  return Length(net.nodes_m[static_cast<std::size_t>(a)] -
                net.nodes_m[static_cast<std::size_t>(b)]);
}

// q (2 z_i - z_i-1 - z_i+1) = -p has the discrete parabola z_i = -p i (n - i) / (2 q).
TEST(FormFinding, AChainUnderLoadsIsAParabola) {
  constexpr int kSpans = 7;
  const double q = 30, p = 4;
  FormNet net;
  std::vector<Vec3> loads;
  for (int i = 0; i <= kSpans; ++i) {
    net.nodes_m.push_back({3.0 * i / kSpans, 0, 0});
    net.fixed.push_back(i == 0 || i == kSpans);
    loads.push_back({0, 0, -p});
    if (i > 0) net.members.push_back({i - 1, i});
  }
  Diagnostics out;
  const auto form = FindNetForm(net, std::vector<double>(kSpans, q), loads, out);
  ASSERT_TRUE(form) << out.Format();
  for (int i = 0; i <= kSpans; ++i) {
    const Vec3& node = (*form)[static_cast<std::size_t>(i)];
    EXPECT_NEAR(node.z, -p * i * (kSpans - i) / (2 * q), 1e-12);
    EXPECT_NEAR(node.x, 3.0 * i / kSpans, 1e-12);
  }
}

/// A prism of n struts with nodes at the bottom and at the top, rotated by `twist_rad` along each
/// strut; groups: horizontal 0, vertical 1, struts 2
struct Prism {
  FormNet net;
  std::vector<int> group;
};
Prism PrismOf(int n, double twist_rad, double above_radius_m) {
  Prism prism;
  const auto add = [&](int a, int b, int group) {
    prism.net.members.push_back({a, b});
    prism.group.push_back(group);
  };
  for (int i = 0; i < n; ++i)
    prism.net.nodes_m.push_back(
        {std::cos(2 * std::numbers::pi * i / n), std::sin(2 * std::numbers::pi * i / n), 0});
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n + twist_rad;
    prism.net.nodes_m.push_back(
        {above_radius_m * std::cos(angle), above_radius_m * std::sin(angle), 1.5});
  }
  for (int i = 0; i < n; ++i) {
    add(i, (i + 1) % n, 0), add(n + i, n + (i + 1) % n, 0);
    add(n + i, (i + 1) % n, 1);  // the cable of a top node leads to the next strut's bottom node
    add(i, n + i, 2);
  }
  return prism;
}

// Equilibrium of one node at radius 1, where the strut and the cable span the angles a and a - 2 pi
// / n: q_cable = -q_strut; tangential components balance, and radially 2 q_h (1 - cos(2 pi / n)) =
// q_s (cos a - cos(a - 2 pi / n)). Hence a = pi / 2 + pi / n, q_strut = -2 sin(pi / n) q_h.
TEST(FormFinding, PrismsTwistByWhatTheirCornersAsk) {
  for (const int n : {3, 4, 5, 7}) {
    const Prism prism = PrismOf(n, std::numbers::pi / 2 + std::numbers::pi / n + 0.1, 1.0);
    Diagnostics out;
    const FreeForm form = FindFreeForm(prism.net, prism.group, out);
    ASSERT_TRUE(out.ok()) << out.Format();
    ASSERT_TRUE(form.found) << n << ": " << form.why;
    EXPECT_LT(form.residual, 1e-9);
    EXPECT_TRUE(form.super_stable);
    const std::vector<double>& q = form.group_force_density_n_per_m;
    const double sign = q[0];
    EXPECT_NEAR(sign * q[1], 2 * std::sin(std::numbers::pi / n), 1e-9);
    EXPECT_NEAR(sign * q[2], -2 * std::sin(std::numbers::pi / n), 1e-9);
    const Vec3 &foot = form.nodes_m[0], &top = form.nodes_m[static_cast<std::size_t>(n)];
    const double turn =
        std::atan2(foot.x * top.y - foot.y * top.x, foot.x * top.x + foot.y * top.y);
    EXPECT_NEAR(turn, std::numbers::pi / 2 + std::numbers::pi / n, 1e-9);
  }
}

FormNet SixStrutNet(double spacing) {
  FormNet net;
  const double h = 1, s = spacing;
  net.nodes_m = {{-s, -h, 0}, {-s, h, 0}, {s, -h, 0},  {s, h, 0},  {0, -s, -h}, {0, -s, h},
                 {0, s, -h},  {0, s, h},  {-h, 0, -s}, {h, 0, -s}, {-h, 0, s},  {h, 0, s}};
  for (int i = 0; i < 12; i += 2) net.members.push_back({i, i + 1});
  const std::vector<std::array<int, 2>> cables = {
      {0, 4}, {0, 5},  {1, 6},  {1, 7},  {2, 4}, {2, 5},  {3, 6},  {3, 7},
      {0, 8}, {0, 10}, {1, 8},  {1, 10}, {2, 9}, {2, 11}, {3, 9},  {3, 11},
      {4, 8}, {4, 9},  {5, 10}, {5, 11}, {6, 8}, {6, 9},  {7, 10}, {7, 11}};
  net.members.insert(net.members.end(), cables.begin(), cables.end());
  return net;
}

TEST(FormFinding, SixStrutsAreHalfTheirLengthApartAndBearOneAndAHalf) {
  const FormNet net = SixStrutNet(0.65);
  std::vector<int> group(net.members.size(), 0);
  for (std::size_t i = 0; i < 6; ++i) group[i] = 1;
  Diagnostics out;
  FreeForm form = FindFreeForm(net, group, out);
  ASSERT_TRUE(form.found) << form.why;
  EXPECT_LT(form.residual, 1e-9);
  EXPECT_TRUE(form.super_stable);
  EXPECT_NEAR(form.group_force_density_n_per_m[1] / form.group_force_density_n_per_m[0], -1.5,
              1e-9);
  FormNet found = net;
  found.nodes_m = form.nodes_m;
  EXPECT_NEAR(Distance(found, 0, 2) / Distance(found, 0, 1), 0.5, 1e-9);
}

std::optional<RobotSpec> Load(const std::string& path) {
  Diagnostics out;
  auto robot = LoadRobot(std::string(TAUT_SOURCE_DIR) + "/" + path, {}, out);
  EXPECT_TRUE(robot) << out.Format();
  return robot;
}

// The described pose has struts 1.5 m apart, far from the form; each strut is 1.684 m long.
TEST(FormFinding, SixStrutsOfAModelRelaxIntoTheirForm) {
  const auto robot = Load("share/models/six_strut.yaml");
  FormOptions options;
  options.force_density_n_per_m.assign(24, 100);
  Diagnostics out;
  const Form form = FindForm(*robot, options, out);
  ASSERT_TRUE(form.found) << form.why << out.Format();
  const ModelDef& def = form.robot.def;
  const Vec3 apart = def.bodies[0].com_m - def.bodies[1].com_m;
  EXPECT_NEAR(Length(apart), 1.684 / 2, 1e-6);
  for (const CableDef& cable : def.cables) {
    EXPECT_NEAR(CableTension(cable) / CableLength(cable), 100, 1e-6);
  }
  EXPECT_LE(form.equilibrium.iterations, 3);  // the form is already an equilibrium
  for (const BodyLoad& load : StartLoads(def)) EXPECT_LT(Length(load.cable_force_n), 1e-5);
}

// In this robot equal tensions are equal force densities, because all cables have the same length.
TEST(FormFinding, TensionsInPlaceOfForceDensities) {
  const auto robot = Load("share/models/six_strut.yaml");
  FormOptions options;
  options.tension_n.assign(24, 80);
  Diagnostics out;
  const Form form = FindForm(*robot, options, out);
  ASSERT_TRUE(form.found) << form.why << out.Format();
  for (const CableDef& cable : form.robot.def.cables) EXPECT_NEAR(CableTension(cable), 80, 1e-5);
  const Vec3 apart = form.robot.def.bodies[0].com_m - form.robot.def.bodies[1].com_m;
  EXPECT_NEAR(Length(apart), 1.684 / 2, 1e-6);
}

TEST(FormFinding, AFormIsWrittenAsAModel) {
  const auto robot = Load("share/models/six_strut.yaml");
  FormOptions options;
  options.force_density_n_per_m.assign(24, 100);
  Diagnostics out;
  const Form form = FindForm(*robot, options, out);
  ASSERT_TRUE(form.found) << form.why << out.Format();
  const auto text = ModelYaml(form.robot, "Found.", out);
  ASSERT_TRUE(text) << out.Format();
  const std::string path = testing::TempDir() + "/form_finding_test.yaml";
  std::ofstream(path) << *text;
  const auto again = LoadRobot(path, {}, out);
  ASSERT_TRUE(again) << out.Format();
  for (std::size_t i = 0; i < robot->def.cables.size(); ++i) {
    const double tension = CableTension(form.robot.def.cables[i]);
    EXPECT_NEAR(CableTension(again->def.cables[i]), tension, 1e-6);
  }
}

// A prism has a form if the force density of its vertical cables is 2 sin(pi / 3) times the density
// of the others; with less they cannot keep its triangles apart.
TEST(FormFinding, APrismWithWeakUprightsCollapses) {
  const auto robot = Load("examples/my_first_robot.yaml");
  FormOptions options;
  options.force_density_n_per_m.assign(robot->def.cables.size(), 60);
  Diagnostics out;
  const Form form = FindForm(*robot, options, out);
  EXPECT_FALSE(form.found);
  EXPECT_EQ(
      form.why,
      "the form collapses: cable lower_1 pulls its ends into one point, and other members are "
      "too weak to keep them apart");
  for (std::size_t i = 0; i < robot->def.cables.size(); ++i) {
    const bool upright = robot->def.cables[i].name.rfind("side", 0) == 0;
    options.force_density_n_per_m[i] = upright ? 60 * std::sqrt(3.0) : 60;
  }
  EXPECT_TRUE(FindForm(*robot, options, out).found) << out.Format();
}

TEST(FormFinding, WrongInputsAreComplainedOf) {
  Diagnostics out;
  FormNet net;
  net.nodes_m = {{}, {1, 0, 0}, {2, 0, 0}};
  net.fixed = {true, false};
  net.members = {{0, 3}, {1, 1}};
  EXPECT_FALSE(FindNetForm(net, {1}, {}, out));
  net.fixed = {true, false, false}, net.members = {{0, 1}};
  EXPECT_FALSE(FindNetForm(net, {1, 2}, {{}}, out));
  EXPECT_FALSE(FindNetForm(net, {1}, {}, out));
  EXPECT_FALSE(FindFreeForm(net, {-1}, out).found);
  net.fixed.clear();
  EXPECT_FALSE(FindNetForm(net, {1}, {}, out));
  EXPECT_FALSE(FindFreeForm(net, {0, 0}, out).found);
  EXPECT_EQ(out.Format(),
            "error: FindFreeForm does not support nets with fixed nodes (call FindNetForm)\n"
            "error: `group` has 2 entries for 1 members (give the group of each member)\n"
            "error: groups must be numbered from 0, each with at least one member\n"
            "error: member 0 does not connect two nodes of the net\n"
            "error: member 1 does not connect two nodes of the net\n"
            "error: no node of the net is fixed\n"
            "error: the force densities do not determine the position of every node (connect every "
            "node to a fixed one; tensions and compressions must not cancel)\n"
            "error: the net has 2 flags of fixed nodes for 3 nodes\n"
            "error: there are 1 loads for 3 nodes\n"
            "error: there are 2 force densities for 1 members\n");
  EXPECT_EQ(FindFreeForm(net, {0}, out).why,
            "the net needs at least five nodes, not all in one plane");

  const auto robot = Load("share/models/six_strut.yaml");
  FormOptions options;
  Diagnostics wrong;
  EXPECT_FALSE(FindForm(*robot, options, wrong).found);
  options.tension_n = {1, 2};
  EXPECT_FALSE(FindForm(*robot, options, wrong).found);
  options.tension_n.assign(24, 1);
  options.tension_n[3] = -1;
  EXPECT_FALSE(FindForm(*robot, options, wrong).found);
  EXPECT_EQ(wrong.Format(),
            "error: cable a1-d1 must have a force density or tension above 0\n"
            "error: form finding needs either force densities or tensions of the cables\n"
            "error: there are 2 force densities or tensions for 24 cables\n");
  Diagnostics soft;
  options.tension_n.assign(24, 2000);
  EXPECT_EQ(FindForm(*robot, options, soft).why, "some cables are too soft");
  EXPECT_NE(soft.Format().find("is too soft: 2000"), std::string::npos) << soft.Format();
}

}  // namespace
}  // namespace taut
