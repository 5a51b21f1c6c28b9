// Load cases of `taut analyze` against closed forms for a rod between two ropes
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "system/taut_command.h"

namespace taut {
namespace {

using nlohmann::json;

class AnalyzeCases : public test::CommandTest {
 protected:
  /// Writes a model of a rod of 1 kg that hangs on a rope and is pulled down by another; both have
  /// 20 N without weight.
  void WriteRod() const {
    Write("rod.yaml",
          "taut: 1\nkind: model\nname: rod\n"
          "nodes:\n  top: [0, 0, 2]\n  a: [0, 0, 1.5]\n  b: [0, 0, 0.5]\n  bottom: [0, 0, 0]\n"
          "pairs:\n"
          "  - {name: upper, nodes: [top, a], tags: [rope]}\n"
          "  - {name: lower, nodes: [b, bottom], tags: [rope]}\n"
          "  - {name: rod, nodes: [a, b]}\n"
          "builders:\n"
          "  - {match: top, anchor: {}}\n  - {match: bottom, anchor: {}}\n"
          "  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1}}\n"
          "  - {match: rope, cable: {stiffness_n_per_m: 1000, rest_length_m: 0.48}}\n");
    Write("cases.yaml",
          "taut: 1\nkind: experiment\nname: cases\nmodel: rod.yaml\nduration_s: 1\nload_cases:\n"
          "  - {name: own, weight: true}\n"
          "  - {name: pulled, weight: false, forces: [{node: b, force_n: [0, 0, -10]}]}\n"
          "  - {name: longer, weight: false, rest_lengths: [{members: lower, by_m: 0.005}]}\n");
  }
  json Case(const std::string& file, const std::string& name) const {
    const test::CommandResult shown = Taut({"analyze", file, "--load_case", name, "--json"});
    EXPECT_EQ(shown.status, 0) << shown.errors;
    return json::parse(shown.output)["load_cases"].at(0);
  }
  static const json& Member(const json& of, const std::string& name) {
    const json& members = of["members"];
    return *std::find_if(members.begin(), members.end(),
                         [&](const json& m) { return m["name"] == name; });
  }
  static void ExpectMember(const json& of, const std::string& name, double least_n,
                           double greatest_n) {
    EXPECT_NEAR(Member(of, name)["least_force_n"].get<double>(), least_n, 1e-6);
    EXPECT_NEAR(Member(of, name)["greatest_force_n"].get<double>(), greatest_n, 1e-6);
  }
};

TEST_F(AnalyzeCases, OfItsWeightHalfIsOnEachRope) {
  WriteRod();
  const json own = Case("cases.yaml", "own");
  const double half_n = 9.81 / 2;
  EXPECT_NEAR(Member(own, "upper")["tension_n"].get<double>(), 20 + half_n, 1e-6);
  EXPECT_NEAR(Member(own, "lower")["tension_n"].get<double>(), 20 - half_n, 1e-6);
  ExpectMember(own, "rod", 20 - half_n, 20 + half_n);
  // At 20 / (9.81 / 2) times the weight the lower rope goes slack.
  EXPECT_NEAR(Member(own, "lower")["slack_factor"].get<double>(), 20 / half_n, 1e-6);
  EXPECT_TRUE(Member(own, "upper")["slack_factor"].is_null());
}

TEST_F(AnalyzeCases, WithoutWeightAForceGoesThroughTheRod) {
  WriteRod();
  const json pulled = Case("cases.yaml", "pulled");
  EXPECT_NEAR(Member(pulled, "upper")["tension_n"].get<double>(), 25, 1e-6);
  EXPECT_NEAR(Member(pulled, "lower")["tension_n"].get<double>(), 15, 1e-6);
  ExpectMember(pulled, "rod", 25, 25);
}

/// The rod is linear, so tensions of a sum are sums of tensions.
TEST_F(AnalyzeCases, CombinationsAddUpAndKeepTheirLimits) {
  WriteRod();
  Write("sums.yaml",
        "taut: 1\nkind: experiment\nname: sums\nmodel: rod.yaml\nduration_s: 1\nload_cases:\n"
        "  - {name: own}\n"
        "  - {name: pulled, weight: false, forces: [{node: b, force_n: [0, 0, -10]}]}\n"
        "load_combinations:\n"
        "  - {name: uls, factors: {own: 1.35, pulled: 1.5}, max_displacement_m: 10.9 mm}\n");
  // both ropes of 1000 N/m resist: (1.35 * 9.81 + 15) / 2000 m = 14.12 mm
  const test::CommandResult shown = Taut({"analyze", "sums.yaml", "--json"});
  EXPECT_EQ(shown.status, 1);
  EXPECT_NE(shown.errors.find("error: load case uls: "), std::string::npos) << shown.errors;
  EXPECT_NE(shown.errors.find(" moves by 0.01412 m, above the limit of 0.0109 m"),
            std::string::npos)
      << shown.errors;
  const json uls = json::parse(shown.output)["load_cases"].at(2);
  const double half_n = (1.35 * 9.81 + 15) / 2;
  EXPECT_NEAR(Member(uls, "upper")["tension_n"].get<double>(), 20 + half_n, 1e-6);
  EXPECT_NEAR(Member(uls, "lower")["tension_n"].get<double>(), 20 - half_n, 1e-6);
  // the table: 9.81 N hang on the ropes, and 28.244 N in the sum
  const test::CommandResult table = Taut({"analyze", "sums.yaml", "--modes", "0"});
  EXPECT_NE(table.output.find("14.12 "), std::string::npos) << table.output;
  EXPECT_NE(table.output.find(" > limit"), std::string::npos) << table.output;
  for (const char* sum : {"9.810\n", "10.000\n", "28.244\n"}) {
    EXPECT_NE(table.output.find(sum), std::string::npos) << table.output;
  }
}

/// Steel: forces of 1e7 N/m times the rounding of places exceed 1e-9 of the weight.
TEST_F(AnalyzeCases, AStiffTrussStandsUnderItsWeight) {
  Write("truss.yaml",
        "taut: 1\nkind: model\nname: truss\nparameters: {young_pa: 210 GPa}\n"
        "nodes: {a: [0, 0, 0], b: [2000 mm, 0, 0], c: [1, 0, 1], d: [1, 1, 0]}\n"
        "pairs:\n  - {tags: [bar], each: [[a, b], [b, c], [c, a], [a, d], [b, d], [c, d]]}\n"
        "builders:\n"
        "  - {match: bar, bar: {young_pa: young_pa, area_m2: 50 mm^2, mass_kg: 300 g}}\n"
        "  - {match: [[a], [b], [d]], support: {kind: ball}}\n");
  for (const char* factor : {"1e-3", "1", "10", "100"}) {
    const test::CommandResult shown = Taut({"analyze", "truss.yaml", "--json", "--modes", "0",
                                            "--set", std::string("young_pa=210e9 * ") + factor});
    ASSERT_EQ(shown.status, 0) << factor << shown.errors;
    const json own = json::parse(shown.output)["load_cases"].at(0);
    double held_n = 0;
    for (const json& one : own["reactions"]) held_n += one["force_n"][2].get<double>();
    EXPECT_NEAR(held_n, 6 * 0.3 * 9.81, 1e-5) << factor;
  }
}

/// The ropes' tensions restore lateral displacements: omega^2 = (T / l1 + T / l2) / m. The longer
/// rest length counts once, because the modes are about the equilibrium with it.
TEST_F(AnalyzeCases, AModeIsAboutTheEquilibriumOfItsLoadCase) {
  WriteRod();
  const json longer = Case("cases.yaml", "longer");
  EXPECT_NEAR(Member(longer, "upper")["tension_n"].get<double>(), 17.5, 1e-6);
  EXPECT_NEAR(Member(longer, "lower")["tension_n"].get<double>(), 17.5, 1e-6);
  const double wanted_hz = std::sqrt(17.5 / 0.4975 + 17.5 / 0.5025) / (2 * std::acos(-1.0));
  double nearest = 1;
  for (const json& mode : longer["modes"]["modes"]) {
    nearest = std::min(nearest, std::fabs(mode["frequency_hz"].get<double>() / wanted_hz - 1));
  }
  EXPECT_LT(nearest, 1e-3);
}

/// A rod on the ground, pulled up by a rope: the ground carries the rest, in compression through
/// the rod.
TEST_F(AnalyzeCases, TheGroundPushesThroughARodThatStands) {
  Write("stands.yaml",
        "taut: 1\nkind: model\nname: stands\n"
        "nodes:\n  top: [0, 0, 1.51]\n  a: [0, 0, 1.01]\n  b: [0, 0, 0.01]\n"
        "pairs:\n  - {name: rope, nodes: [top, a]}\n  - {name: rod, nodes: [a, b]}\n"
        "builders:\n  - {match: top, anchor: {}}\n"
        "  - {match: rod, rod: {radius_m: 0.01, mass_kg: 1}}\n"
        "  - {match: rope, cable: {stiffness_n_per_m: 1000, rest_length_m: 0.495}}\n");
  Write("ground.yaml",
        "taut: 1\nkind: experiment\nname: ground\nmodel: stands.yaml\nduration_s: 1\nterrain:\n"
        "  - {name: ground, plane: {height_m: 0, friction: 0.5}}\n");
  const test::CommandResult shown = Taut({"analyze", "ground.yaml", "--json"});
  ASSERT_EQ(shown.status, 0) << shown.errors;
  const json own = json::parse(shown.output)["load_cases"].at(0);
  ExpectMember(own, "stands", -(9.81 - 5), 5);
  double held_n = 0;
  for (const json& one : own["reactions"]) held_n += one["force_n"][2].get<double>();
  EXPECT_NEAR(held_n, 9.81, 1e-6);
}

/// The anchor of a rod also carries the rod's weight, if the load case has weight.
TEST_F(AnalyzeCases, AnAnchorBearsItsOwnWeightOnlyWhereItHasOne) {
  Write("post.yaml",
        "taut: 1\nkind: model\nname: post\n"
        "nodes:\n  a: [0, 0, 2]\n  b: {at_m: [0, 0, 1.5], tags: [post]}\n  ball: [0, 0, 1]\n"
        "pairs:\n  - {name: beam, nodes: [a, b]}\n  - {name: rope, nodes: [b, ball]}\n"
        "builders:\n  - {match: beam, rod: {radius_m: 0.01, mass_kg: 2}}\n"
        "  - {match: post, anchor: {}}\n  - {match: ball, point_mass: {mass_kg: 1}}\n"
        "  - {match: rope, cable: {stiffness_n_per_m: 1000, rest_length_m: 0.49}}\n");
  Write("both.yaml",
        "taut: 1\nkind: experiment\nname: both\nmodel: post.yaml\nduration_s: 1\nload_cases:\n"
        "  - {name: own, weight: true}\n"
        "  - {name: pulled, weight: false, forces: [{node: ball, force_n: [0, 0, -10]}]}\n");
  const auto held_z = [&](const std::string& name) {
    const json own = Case("both.yaml", name);
    double sum_n = 0;
    for (const json& one : own["reactions"]) sum_n += one["force_n"][2].get<double>();
    return sum_n;
  };
  EXPECT_NEAR(held_z("own"), 3 * 9.81, 1e-6);
  EXPECT_NEAR(held_z("pulled"), 10, 1e-6);
}

/// Two ropes of 0.5 m and 1 m in the same line hold a ball: T1 + T2 = m g, and the minimized
/// objective determines their shares.
TEST_F(AnalyzeCases, WhatIsLeastSaysHowRopesShare) {
  Write("shared.yaml",
        "taut: 1\nkind: model\nname: shared\n"
        "nodes:\n  low: [0, 0, 0.5]\n  high: [0, 0, 1]\n  ball: [0, 0, 0]\n"
        "pairs:\n  - {name: short, nodes: [low, ball], tags: [soft]}\n"
        "  - {name: long, nodes: [high, ball], tags: [stiff]}\n"
        "builders:\n  - {match: low, anchor: {}}\n  - {match: high, anchor: {}}\n"
        "  - {match: ball, point_mass: {mass_kg: 1}}\n"
        "  - {match: soft, cable: {stiffness_n_per_m: 1000, rest_length_m: 0.49}}\n"
        "  - {match: stiff, cable: {stiffness_n_per_m: 3000, rest_length_m: 0.99}}\n");
  const auto share = [&](const std::string& what) {
    const test::CommandResult shown =
        Taut({"analyze", "shared.yaml", "--inverse", "--minimise", what, "--json"});
    EXPECT_EQ(shown.status, 0) << shown.errors;
    const json cables = json::parse(shown.output)["load_cases"].at(0)["cables"];
    return cables[0]["tension_n"].get<double>() / 9.81;
  };
  EXPECT_NEAR(share("tension"), 0.5, 1e-9);        // T1 = T2
  EXPECT_NEAR(share("energy"), 0.25, 1e-9);        // T1 / k1 = T2 / k2
  EXPECT_NEAR(share("force_density"), 0.2, 1e-9);  // T1 / l1^2 = T2 / l2^2
}

}  // namespace
}  // namespace taut
