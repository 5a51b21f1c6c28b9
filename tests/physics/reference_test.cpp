/// Free motion against histories of MOTES (Goyal, Chen, Majji, Skelton: rigid bars without inertia
/// about their axes, massless strings). taut does not ship the histories: the tests read them next
/// to the checkout or from the folder TAUT_REFERENCE.
///
/// Differences: a bar of MOTES has no moment of inertia about its axis, a bar of taut has m r^2 /
/// 2. Strings attach at the bars' axes and exert no moment about them, so a bar without initial
/// spin never spins, and that inertia has no effect. MOTES integrates with a fixed step of 1 ms
/// (Runge and Kutta's fourth order) and writes every tenth step; slack strings have no force in
/// both.

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tests/physics/world.h"
#include "tests/scenes/rod.h"

namespace taut::test {
namespace {

using nlohmann::json;

std::optional<json> Reference(const std::string& name) {
  const char* const given = std::getenv("TAUT_REFERENCE");
  const std::filesystem::path folder =
      given != nullptr ? given : std::filesystem::path(TAUT_SOURCE_DIR "/../shared/reference");
  const std::filesystem::path path = folder / "structural" / (name + ".json.gz");
  if (!std::filesystem::exists(path)) return std::nullopt;
  gzFile const file = gzopen(path.c_str(), "rb");
  std::string text;
  char part[1 << 16];
  for (int n = 0; (n = gzread(file, part, sizeof part)) > 0;) {
    text.append(part, static_cast<std::size_t>(n));
  }
  gzclose(file);
  return json::parse(text);
}

Vec3 Column(const json& matrix, std::size_t column) {
  return {matrix[0][column], matrix[1][column], matrix[2][column]};
}

/// Returns the position of node `node` in row `row` of a history: an array of 3 x nodes x rows.
Vec3 At(const json& history, std::size_t node, std::size_t row) {
  return {history[0][node][row], history[1][node][row], history[2][node][row]};
}

/// Adds joints between coincident nodes of class-k bars: hinges between bars, or with the world.
void JoinNodes(const json& run, const std::string& debug, ModelDef& def) {
  const json& pins = run[debug + ".sys_def.P"];
  if (pins.empty()) return;
  for (std::size_t i = 0; i < pins[0].size(); ++i) {
    JointDef joint;
    joint.name = "pin_" + std::to_string(i);
    // motion in the plane of x and y: out of it the square is unstable
    joint.kind = JointKind::kHinge;
    for (std::size_t node = 0; node < pins.size(); ++node) {
      if (pins[node][i] == 0.0) continue;
      const NodeDef& at = def.nodes[node];
      (pins[node][i] == 1.0 ? joint.body_b : joint.body_a) = at.body;
      joint.from_m = joint.to_m = at.position_m;
    }
    def.joints.push_back(joint);
  }
}

/// Returns the model of a MOTES run: bars of 1 kg, or nodes with masses, and strings k (l - l0).
ModelDef ModelOf(const json& run) {
  const std::string debug = run.contains("debug.sys_def.m") ? "debug" : "sim_debug";
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  const json& nodes = run[debug + ".ICs.N0"];
  const std::size_t count = nodes[0].size();
  std::vector<int> body_of(count, kWorld);
  if (run.contains("C_b")) {
    const json& bars = run[debug + ".sys_def.C_b"];
    const json& mass = run[debug + ".sys_def.m"][0];
    for (std::size_t bar = 0; bar < bars.size(); ++bar) {
      std::size_t from = 0, to = 0;
      for (std::size_t node = 0; node < count; ++node) {
        if (bars[bar][node] == -1.0) from = node;
        if (bars[bar][node] == 1.0) to = node;
      }
      // The bar is so thin that its transverse moments equal m l^2 / 12, the moments of a line.
      body_of[from] = body_of[to] =
          scenes::AddRod(def, "bar_" + std::to_string(bar), mass[bar], 1e-4, Column(nodes, from),
                         Column(nodes, to), {});
      def.capsules.back().collides = false;
      const json& speeds = run[debug + ".ICs.Nd0"];
      const Vec3 way = Column(nodes, to) - Column(nodes, from);
      const Vec3 apart = Column(speeds, to) - Column(speeds, from);
      BodyDef& body = def.bodies.back();
      body.velocity_m_per_s = Column(speeds, from) + 0.5 * apart;
      body.angular_velocity_rad_per_s = (1 / Dot(way, way)) * Cross(way, apart);
    }
  } else {
    const json& mass = run["sim_debug.sys_def.ms"][0];
    for (std::size_t node = 0; node < count; ++node) {
      BodyDef body;
      body.name = "node_" + std::to_string(node);
      body.mass_kg = mass[node];
      body.com_m = Column(nodes, node);
      body.inertia_kg_m2 = scenes::SphereInertia(body.mass_kg, 0.05);
      body_of[node] = static_cast<int>(def.bodies.size());
      def.bodies.push_back(body);
    }
  }
  def.nodes.clear();
  for (std::size_t node = 0; node < count; ++node) {
    def.nodes.push_back({"node_" + std::to_string(node), body_of[node], Column(nodes, node)});
  }
  JoinNodes(run, debug, def);
  const json& strings = run[debug + ".sys_def.C_s"];
  for (std::size_t string = 0; string < strings.size(); ++string) {
    CableDef cable;
    cable.name = "string_" + std::to_string(string);
    cable.attachments.resize(2);
    for (std::size_t node = 0; node < count; ++node) {
      const AttachmentDef here{body_of[node], Column(nodes, node)};
      if (strings[string][node] == -1.0) cable.attachments[0] = here;
      if (strings[string][node] == 1.0) cable.attachments[1] = here;
    }
    cable.stiffness_n_per_m = run[debug + ".forces.k"][0][string];
    cable.damping_n_s_per_m = run[debug + ".forces.c"][0][string];
    cable.rest_length_m = run[debug + ".forces.s_0"][string][0];
    if (cable.attachments[0].body == cable.attachments[1].body) continue;  // along a rigid bar
    def.cables.push_back(cable);
  }
  return def;
}

struct Apart {
  double place_m = 0, speed_m_per_s = 0, way_m = 0;
};

/// Returns the largest differences over all rows of the history, with `steps` steps per row of 10
/// ms.
Apart Compare(const json& run, int steps) {
  const json &places = run["History.Nhist"], &speeds = run["History.Ndhist"];
  WorldBatch world = MakeBatch(ModelOf(run));
  if (run.contains("debug.forces.W")) {
    for (std::size_t node = 0; node < run["debug.forces.W"][0].size(); ++node) {
      world.SetNodeForce(0, static_cast<int>(node), Column(run["debug.forces.W"], node));
    }
  }
  Apart apart;
  const std::size_t nodes = places[0].size(), rows = places[0][0].size();
  for (std::size_t row = 0; row < rows; ++row) {
    if (row > 0) world.Step(0.01 / steps, steps);
    for (std::size_t node = 0; node < nodes; ++node) {
      const int i = static_cast<int>(node);
      const Vec3 place = At(places, node, row);
      const double d = Distance(world.NodePosition(0, i), place);
      apart.place_m = std::max(apart.place_m, d);
      apart.speed_m_per_s =
          std::max(apart.speed_m_per_s, Distance(world.NodeVelocity(0, i), At(speeds, node, row)));
      apart.way_m = std::max(apart.way_m, Distance(place, At(places, node, 0)));
    }
  }
  EXPECT_EQ(world.Status(0).bits, kStatusOk);
  return apart;
}

TEST(Reference, TheFreeCrossBarOfClass1MovesAsInMotes) {
  const auto run = Reference("motes_dyn_crossbar_class1");
  if (!run) GTEST_SKIP() << "no structural reference: set TAUT_REFERENCE";
  const Apart usual = Compare(*run, 10), half = Compare(*run, 20), fine = Compare(*run, 160);
  EXPECT_LT(usual.place_m, 0.0025 * usual.way_m) << "5 s at 1 ms, w h up to 0.05";
  // taut's scheme is of second order, the scheme of MOTES of fourth: the remaining error is taut's
  // and decreases with h^2.
  EXPECT_NEAR(usual.place_m / half.place_m, 4, 0.1);
  EXPECT_NEAR(usual.speed_m_per_s / half.speed_m_per_s, 4, 0.1);
  EXPECT_LT(fine.place_m, 1e-5 * fine.way_m);
}

TEST(Reference, BarsOfClassKMoveAsInMotes) {
  // Two structures: a bar pinned at its end, with 10 rad/s at the start and a force on its tip; and
  // a closed square of four bars, with a pinned corner, two strings across and redundant joint
  // rows.
  for (const char* name : {"motes_dyn_pendulum_classK", "motes_dyn_Dbar_classK"}) {
    const auto run = Reference(name);
    if (!run) GTEST_SKIP() << "no structural reference: set TAUT_REFERENCE";
    const Apart usual = Compare(*run, 10), half = Compare(*run, 20), fine = Compare(*run, 160);
    // A midpoint step rotates a pinned bar by 2 atan(w h / 2): short by (w h)^2 / 12 of the angle.
    const double angle = 10 * 0.01 * static_cast<double>((*run)["History.Nhist"][0][0].size());
    EXPECT_LT(usual.place_m, 1e-4 / 12 * angle * usual.way_m) << name << ", w h up to 0.01";
    EXPECT_NEAR(usual.place_m / half.place_m, 4, 0.1) << name;
    EXPECT_LT(fine.place_m, 1e-5) << name;  // of 2 and 1.6 m
  }
}

TEST(Reference, TheDBarOfClassKSwingsWithTheFrequenciesOfTsgFem) {
  // Six bars between two apexes and a ring of three nodes, three strings around it and one from
  // apex to apex. One apex is fixed, the other slides along the axis. The bars of TsgFEM are
  // elastic, the bars of taut are rigid.
  const auto file = Reference("tsgfem_static_3d_Dbar_folding");
  if (!file) GTEST_SKIP() << "no structural reference: set TAUT_REFERENCE";
  ModelDef def;
  def.gravity_m_per_s2 = {};
  const json &nodes = (*file)["N"], &members = (*file)["members"];
  std::vector<int> body_of(nodes[0].size(), kWorld);
  const auto pin = [&](JointKind kind, int a, int b, std::size_t node) {
    JointDef joint;
    joint.name = "pin_" + std::to_string(def.joints.size()), joint.kind = kind;
    joint.body_a = a, joint.body_b = b, joint.axis = {1, 0, 0};
    joint.from_m = joint.to_m = Column(nodes, node);
    def.joints.push_back(joint);
  };
  for (std::size_t i = 0; i < members.size(); ++i) {
    const std::size_t ends[] = {members[i][0], members[i][1]};
    const Vec3 a = Column(nodes, ends[0]), b = Column(nodes, ends[1]);
    if ((*file)["t"][i] < 0.0) {
      const int bar =
          scenes::AddRod(def, "bar_" + std::to_string(i), (*file)["mass"][i], 1e-3, a, b, {});
      def.capsules.back().collides = false;
      for (const std::size_t node : ends) {
        if (node == 0) {
          pin(JointKind::kBall, kWorld, bar, node);
        } else if (body_of[node] == kWorld) {
          body_of[node] = bar;
          if (node == 1) pin(JointKind::kLine, kWorld, bar, node);
        } else {
          pin(JointKind::kBall, body_of[node], bar, node);
        }
      }
      continue;
    }
    CableDef cable;
    cable.name = "string_" + std::to_string(i);
    cable.attachments = {{body_of[ends[0]], a}, {body_of[ends[1]], b}};
    const double modulus = (*file)["E"][i], area = (*file)["A"][i], rest = (*file)["l0"][i];
    cable.stiffness_n_per_m = modulus * area / rest, cable.rest_length_m = rest;
    def.cables.push_back(cable);
  }
  ASSERT_EQ(def.cables.size(), 4u);
  def.nodes = {{"apex", body_of[1], Column(nodes, 1)}};
  for (std::size_t i = 2; i < 5; ++i) {
    def.nodes.push_back({"ring_" + std::to_string(i), body_of[i], Column(nodes, i)});
  }
  // Each push excites one mode only, and the measured velocity excludes the other mode.
  const auto frequency = [&](int first_node, int last_node, const Vec3& push_n, double Vec3::*way) {
    WorldBatch world = MakeBatch(def);
    const auto push = [&](const Vec3& force_n) {
      for (int i = first_node; i <= last_node; ++i) world.SetNodeForce(0, i, force_n);
    };
    const auto speed = [&] {
      double sum = 0;
      for (int i = first_node; i <= last_node; ++i) sum += world.NodeVelocity(0, i).*way;
      return sum;
    };
    push(push_n);
    world.Step(1e-3, 100);
    push({});
    double first = 0, last = 0, before = speed();
    int swings = -1;
    for (int n = 1; n <= 5000; ++n) {
      world.Step(1e-3);
      const double now = speed();
      if (before < 0 && now >= 0) {
        last = 1e-3 * (n - now / (now - before)), ++swings;
        if (swings == 0) first = last;
      }
      before = now;
    }
    EXPECT_EQ(world.Status(0).bits, kStatusOk);
    return swings / (last - first);
  };
  const double along = frequency(0, 0, {50, 0, 0}, &Vec3::x);
  const double across = frequency(1, 3, {0, 0, 50}, &Vec3::z);
  const json& theirs = (*file)["freq_Hz_recomputed"];
  EXPECT_NEAR(along, theirs[3], 0.01 * along);
  EXPECT_NEAR(across, theirs[1], 0.01 * across);
  // The same linear equations with bars 10^4 times as stiff.
  EXPECT_NEAR(along, 4.546571, 1e-3);
  EXPECT_NEAR(across, 2.638069, 1e-3);
}

TEST(Reference, TheFreeNetOfStringsMovesAsInMotes) {
  const auto run = Reference("motes_dyn_string_only_class0");
  if (!run) GTEST_SKIP() << "no structural reference: set TAUT_REFERENCE";
  const Apart usual = Compare(*run, 10), fine = Compare(*run, 160);
  EXPECT_LT(usual.place_m, 1e-4 * usual.way_m);
  // When strings go slack, their force has a kink and fourth order is lost: the method of MOTES at
  // a tenth of its step differs by 11.8 micrometers from its history. The remaining difference has
  // this size.
  EXPECT_LT(fine.place_m, 1.3e-5);
}

TEST(Reference, TheTBarStaysInTheEquilibriumOfTheStructuralTools) {
  const auto file = Reference("ctsfem_Tbar_static");
  if (!file) GTEST_SKIP() << "no structural reference: set TAUT_REFERENCE";
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  const json &nodes = (*file)["N"], &members = (*file)["C"];
  std::vector<int> body_of(nodes[0].size(), kWorld);
  std::vector<double> tension;
  for (std::size_t i = 0; i < members.size(); ++i) {
    std::size_t from = 0, to = 0;
    for (std::size_t node = 0; node < body_of.size(); ++node) {
      if (members[i][node] == -1.0) from = node;
      if (members[i][node] == 1.0) to = node;
    }
    const double force = (*file)["t"][i][0], rest = (*file)["l0"][i][0];
    const Vec3 a = Column(nodes, from), b = Column(nodes, to);
    if (force < 0) {  // a bar; bars cross without a joint
      body_of[from] = body_of[to] =
          scenes::AddRod(def, "bar_" + std::to_string(i), (*file)["mass"][i][0], 0.005, a, b, {});
      def.capsules.back().collides = false;
      continue;
    }
    CableDef cable;
    cable.name = "string_" + std::to_string(i);
    cable.attachments = {{body_of[from], a}, {body_of[to], b}};
    const double modulus = (*file)["E"][i][0], area = (*file)["A"][i][0];
    cable.stiffness_n_per_m = modulus * area / rest;
    cable.rest_length_m = rest;
    def.cables.push_back(cable);
    tension.push_back(force);
  }
  ASSERT_EQ(def.bodies.size(), 2u);
  ASSERT_EQ(tension.size(), 4u);
  WorldBatch world = MakeBatch(def);
  world.Step(1e-3, 5000);
  for (int c = 0; c < 4; ++c) {
    const double expected = tension[static_cast<std::size_t>(c)];
    EXPECT_NEAR(world.Cable(0, c).tension_n, expected, 1e-6 * expected) << c;
  }
  for (int node = 0; node < static_cast<int>(def.nodes.size()); ++node) {
    const Vec3 start = def.nodes[static_cast<std::size_t>(node)].position_m;
    EXPECT_LE(Distance(world.NodePosition(0, node), start), 1e-8) << node;
  }
}

}  // namespace
}  // namespace taut::test
