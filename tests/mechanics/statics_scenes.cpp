/// Statics of supported structures: rigid motions, mechanisms, least stiffness.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/vec.h"
#include "taut/analysis.h"
#include "tests/mechanics/energy_oracle.h"
#include "tests/mechanics/known_scene.h"
#include "tests/scenes/rod.h"
#include "tests/unit/analysis/analysis_scenes.h"

namespace taut::mechanics {
namespace {

using test::AddBar;
using test::AddCable;
using test::AddJoint;
using test::AddPoint;

// --- Structures ----------------------------------------------------------------------------------

/// Returns `inner` points in a row along x between two anchors, with members of `length_m`.
ModelDef Row(int inner, bool bars, double length_m, double stiffness, double rest_m) {
  ModelDef def;
  def.gravity_m_per_s2 = {};
  const auto at = [&](int i) { return Vec3{i * length_m, 0, 0}; };
  for (int i = 0; i < inner; ++i) AddPoint(def, "p" + std::to_string(i), at(i + 1), 1);
  for (int i = 0; i <= inner; ++i) {
    const int a = i == 0 ? kWorld : i - 1, b = i == inner ? kWorld : i;
    if (!bars) {
      AddCable(def, {{a, at(i)}, {b, at(i + 1)}}, stiffness, rest_m);
    } else if (b == kWorld) {
      AddBar(def, b, at(i + 1), a, at(i), stiffness, rest_m);  // body_b is the moving one
    } else {
      AddBar(def, a, at(i), b, at(i + 1), stiffness, rest_m);
    }
  }
  return def;
}

/// Returns four points in a square of side 2 m, each with a cable to an anchor outside, in one
/// plane.
ModelDef Net(double outer_rest_ratio, double inner_rest_ratio) {
  ModelDef def;
  def.gravity_m_per_s2 = {};
  const Vec3 corners[] = {{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}};
  for (int i = 0; i < 4; ++i) AddPoint(def, "p" + std::to_string(i), corners[i], 1);
  for (int i = 0; i < 4; ++i) {
    const Vec3 here = corners[i], next = corners[(i + 1) % 4];
    AddCable(def, {{kWorld, 2 * here}, {i, here}}, 1000, outer_rest_ratio * std::sqrt(2.0));
    AddCable(def, {{i, here}, {(i + 1) % 4, next}}, 1000, inner_rest_ratio * 2);
  }
  return def;
}

/// Adds a prism of three rods on nine cables with unequal rest lengths; returns its first body.
int AddPrism(ModelDef& def, const Vec3& at) {
  const int first = static_cast<int>(def.bodies.size());
  std::vector<Vec3> low, high;
  for (int i = 0; i < 3; ++i) {
    const double a = 2 * std::numbers::pi * i / 3,
                 b = a + std::numbers::pi / 2 + std::numbers::pi / 3;
    low.push_back(at + Vec3{0.7 * std::cos(a), 0.7 * std::sin(a), 0});
    high.push_back(at + Vec3{0.7 * std::cos(b), 0.7 * std::sin(b), 1.1});
    scenes::AddRod(def, "rod" + std::to_string(def.bodies.size()), 0.4, 1e-4, low.back(),
                   high.back(), {});
  }
  int number = 0;
  const auto cable = [&](int i, const Vec3& from, int j, const Vec3& to, double stretch) {
    AddCable(def, {{first + i, from}, {first + j, to}}, 900 + 40 * number,
             Length(to - from) * (1 - stretch - 0.002 * number));
    ++number;
  };
  for (int i = 0; i < 3; ++i) {
    const std::size_t a = static_cast<std::size_t>(i), b = static_cast<std::size_t>((i + 1) % 3);
    cable(i, low[a], (i + 1) % 3, low[b], 0.03);
    cable(i, high[a], (i + 1) % 3, high[b], 0.03);
    cable(i, high[a], (i + 1) % 3, low[b], 0.05);
  }
  return first;
}

/// Returns a prism with ball joints between its first feet and the world.
ModelDef PrismOn(int supports, bool weight) {
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, weight ? -9.81 : 0};
  AddPrism(def, {});
  for (int i = 0; i < supports; ++i) {
    const Vec3 foot = def.capsules[static_cast<std::size_t>(i)].from_m;
    AddJoint(def, JointKind::kBall, kWorld, foot, i, foot);
  }
  return def;
}

/// Returns the laboratory prism of share/models/t3_prism.yaml: bars, cables, supports of 3, 2 and 1
/// direction.
ModelDef T3Prism() {
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, -9.81};
  const Vec3 at[] = {{0, -2.0438, 0},          {0, 0, 0},
                     {1.770, -1.0219, 0},      {0.590, -2.2019, 1.950},
                     {-0.4319, -0.4319, 1.95}, {1.6119, -0.4319, 1.950}};
  for (int i = 0; i < 6; ++i) {
    AddPoint(def, "n" + std::to_string(i), at[i], (i < 3 ? 45.7 : 41.6) / 9.81);
  }
  const double strut = 70390e6 * 364.4e-6, flat = 71750e6 * 50.3e-6, steep = 72190e6 * 50.3e-6;
  for (const auto& [a, b] : {std::pair{2, 4}, {1, 3}, {0, 5}}) {
    AddBar(def, a, at[a], b, at[b], strut / (2.9998 + 0.75e-3), 2.9998 + 0.75e-3);
  }
  for (const auto& [a, b] : {std::pair{1, 2}, {0, 1}, {0, 2}, {4, 5}, {3, 4}, {3, 5}}) {
    AddCable(def, {{a, at[a]}, {b, at[b]}}, flat / 2.0438, 2.0438);
  }
  for (const auto& [a, b] : {std::pair{2, 5}, {1, 4}, {0, 3}}) {
    AddCable(def, {{a, at[a]}, {b, at[b]}}, steep / 2.0434, 2.0434);
  }
  AddJoint(def, JointKind::kBall, kWorld, at[1], 1, at[1]);
  AddJoint(def, JointKind::kLine, kWorld, at[0], 0, at[0], {0, 1, 0});
  AddJoint(def, JointKind::kPlane, kWorld, at[2], 2, at[2], {0, 0, 1});
  return def;
}

// --- Scenes --------------------------------------------------------------------------------------

void Counts(Report& report, const std::string& of, const ModelDef& def, int mechanisms, int whole) {
  const ForceAnalysis found = AnalyseForces(def);
  report.Near(of + ": mechanisms", "1", static_cast<double>(found.mechanisms.size()), mechanisms,
              0);
  report.Near(of + ": rigid motions", "1", found.rigid, whole, 0);
  if (!found.classical) return;
  report.Near(of + ": mechanisms, pin-jointed", "1", found.classical->mechanisms, mechanisms, 0);
  report.Near(of + ": rigid motions, pin-jointed", "1", found.classical->rigid, whole, 0);
}

double LeastStiffnessOf(const ModelDef& def) { return LeastStiffness(def).value_or(std::nan("")); }

/// Cables in a row: transverse stiffness T / l (2 - 2 cos(pi / (n + 1))), in two directions.
void CablesInARow(Report& report) {
  for (const int inner : {1, 2, 5}) {
    const ModelDef def = Row(inner, false, 0.5, 1000, 0.48);
    const std::string of = std::to_string(inner + 1) + " cables in a row";
    Counts(report, of, def, 2 * inner, 0);
    const double least = 40 * (2 - 2 * std::cos(std::numbers::pi / (inner + 1)));
    report.Near(of + ": least stiffness", "N/m", LeastStiffnessOf(def), least, 1e-10 * least);
    const ForceAnalysis found = AnalyseForces(def);
    const double by_prestress =
        found.mechanism_stiffness.empty() ? 0 : found.mechanism_stiffness[0];
    report.Near(of + ": stiffness of mechanisms by prestress", "1", by_prestress, least / 40, 1e-9);
  }
  const ModelDef def = Row(2, false, 1, 1000, 0.99);
  Counts(report, "1 m and 10 N", def, 4, 0);
  report.Near("1 m and 10 N: least stiffness", "N/m", LeastStiffnessOf(def), 10, 1e-9);
  // Without prestress nothing resists these motions: they are mechanisms, not rigid motions.
  const ModelDef straight = Row(2, true, 1, 1000, 1);
  const Modes modes = FindModes(straight);
  report.Near("bars without prestress: rigid motions", "1", modes.rigid, 0, 0);
  report.Near("bars without prestress: mechanisms", "1", modes.mechanisms, 4, 0);
  report.Near("bars without prestress: least stiffness", "N/m", LeastStiffnessOf(straight), 0, 0);
}
const SceneEntry kCablesInARow("statics", "Cables in a row between two anchors",
                               "closed form of a loaded string", CablesInARow);

void BarsInLine(Report& report) {
  const ModelDef def = Row(1, true, 1, 1000, 1.01);
  Counts(report, "pressed with 10 N", def, 2, 0);
  report.Near("pressed with 10 N: least stiffness", "N/m", LeastStiffnessOf(def), -20, 1e-9);
  report.Near("pressed with 10 N: unstable modes", "1", FindModes(def).unstable, 2, 0);
  const ModelDef pulled = Row(1, true, 1, 1000, 0.99);
  report.Near("pulled with 10 N: least stiffness", "N/m", LeastStiffnessOf(pulled), 20, 1e-9);
}
const SceneEntry kBarsInLine("statics", "Two bars in line between supports",
                             "2 T / l across, negative under compression", BarsInLine);

void FlatNet(Report& report) {
  // T = 10 N inside and sqrt(2) times as much outside balance: force densities 5 and 10 N/m, and
  // out of the plane 10 + 2 * 5 - 5 * 2 cos(k pi / 2).
  const ModelDef tuned = Net(1 - 0.01, 1 - 0.005);
  Counts(report, "in balance", tuned, 5, 0);
  report.Near("in balance: least stiffness, by differences", "N/m", LeastStiffnessOf(tuned),
              EnergyOracle(tuned).LeastStiffness(0), 1e-6);
  // Equal rest length ratios are not in equilibrium in the described pose.
  const ModelDef as_described = Net(0.99, 0.99);
  Counts(report, "rest lengths 0.99", as_described, 5, 0);
  const Equilibrium at = FindEquilibrium(as_described);
  const ModelDef there = ModelAt(as_described, at.pose);
  report.Near("rest lengths 0.99: least stiffness in equilibrium", "N/m", LeastStiffnessOf(there),
              EnergyOracle(there).LeastStiffness(0), 1e-6);
  const ForceAnalysis found = AnalyseForces(tuned);
  const std::vector<double>& by_prestress = found.mechanism_stiffness;
  report.Near("mechanisms with positive stiffness due to prestress", "1",
              static_cast<double>(by_prestress.size()), 5, 0);
  // In units of the largest density, 10 N/m: 1, 2, 2, 3 out of the plane.
  report.Near("least stiffness of the mechanisms, relative to the largest force density", "1",
              by_prestress.empty() ? 0 : by_prestress[0], 1, 1e-9);
}
const SceneEntry kFlatNet("statics", "Flat net of four points and four anchors",
                          "hand count, closed form, differences of the energy", FlatNet);

void PartlyAnchored(Report& report) {
  const int whole[] = {6, 3, 1, 0};
  for (int supports = 0; supports <= 3; ++supports) {
    Counts(report, "prism on " + std::to_string(supports) + " ball joints",
           PrismOn(supports, false), 1, whole[supports]);
  }
  // A mast on one anchor: three cables to one point of the world hold its position.
  ModelDef hub;
  hub.gravity_m_per_s2 = {};
  AddPrism(hub, {});
  for (int i = 0; i < 3; ++i) {
    const Vec3 foot = hub.capsules[static_cast<std::size_t>(i)].from_m;
    AddCable(hub, {{kWorld, {0.1, 0, -0.5}}, {i, foot}}, 1000, 0.5);
  }
  Counts(report, "prism on three cables to one anchor", hub, 1, 3);
  // Two anchors leave rotation about the line through them free.
  ModelDef swing;
  scenes::AddRod(swing, "seat", 1, 1e-4, {-0.3, 0, 0}, {0.3, 0, 0}, {});
  AddCable(swing, {{kWorld, {-0.3, 0, 1}}, {0, {-0.3, 0, 0}}}, 1000, 0.99);
  AddCable(swing, {{kWorld, {0.3, 0, 1}}, {0, {0.3, 0, 0}}}, 1000, 0.99);
  Counts(report, "swing on two ropes", swing, 2, 1);
  ModelDef hung;
  AddPoint(hung, "mass", {0, 0, -1}, 1);
  AddCable(hung, {{kWorld, {0, 0, 0}}, {0, {0, 0, -1}}}, 1000, 0.99);
  Counts(report, "point on a rope", hung, 0, 2);
  ModelDef two;
  two.gravity_m_per_s2 = {};
  AddPrism(two, {}), AddPrism(two, {5, 1, 0});
  Counts(report, "two prisms", two, 2, 12);
  for (int i = 0; i < 3; ++i) {
    const Vec3 foot = two.capsules[static_cast<std::size_t>(i)].from_m;
    AddJoint(two, JointKind::kBall, kWorld, foot, i, foot);
  }
  Counts(report, "two prisms, one of them on three ball joints", two, 2, 6);
  Counts(report, "laboratory prism on supports of 3, 2 and 1 direction", T3Prism(), 1, 0);
}
const SceneEntry kPartlyAnchored("statics", "Structures that are held in part", "hand count",
                                 PartlyAnchored);

void LeastStiffnessByDifferences(Report& report) {
  const int whole[] = {6, 3, 1, 0};
  for (int supports = 0; supports <= 3; ++supports) {
    const ModelDef def = PrismOn(supports, supports == 3);
    const Equilibrium at = FindEquilibrium(def);
    const ModelDef there = ModelAt(def, at.pose);
    const double expected = EnergyOracle(there).LeastStiffness(whole[supports]);
    report.Near("prism on " + std::to_string(supports) + " ball joints" +
                    (supports == 3 ? ", with weight" : ""),
                "N/m", LeastStiffnessOf(there), expected, 1e-6 * std::fabs(expected));
  }
  const ModelDef t3 = T3Prism();
  const Equilibrium at = FindEquilibrium(t3);
  const ModelDef there = ModelAt(t3, at.pose);
  const double expected = EnergyOracle(there, 5e-5).LeastStiffness(0);
  report.Near("laboratory prism with weight", "N/m", LeastStiffnessOf(there), expected,
              1e-6 * std::fabs(expected));
  report.AtMost("laboratory prism, negative part", "N/m", std::max(0.0, -LeastStiffnessOf(there)),
                0);
}
const SceneEntry kByDifferences("statics", "Least stiffness in equilibrium",
                                "second differences of the energy, order 4",
                                LeastStiffnessByDifferences);

void Pendulums(Report& report) {
  for (const double side : {-1.0, 1.0}) {
    // Only the center of mass, at L / 2, measures the swing.
    ModelDef def;
    scenes::AddRod(def, "rod", 0.7, 1e-5, {0, 0, 0}, {0, 0, side * 0.8}, {});
    AddJoint(def, JointKind::kBall, kWorld, {0, 0, 0}, 0, {0, 0, 0});
    const double expected = -side * 0.7 * 9.81 / 0.4;
    report.Near(side < 0 ? "rod that hangs from a ball joint" : "rod that stands on a ball joint",
                "N/m", LeastStiffnessOf(def), expected, 1e-9);
    LoadCaseSpec weight;
    const SupportCheck check = CheckSupports(def, weight);
    report.Near(side < 0 ? "rod that hangs: refused" : "rod that stands: refused", "1",
                check.missing.empty() ? 0 : 1, side < 0 ? 0 : 1, 0);
  }
  ModelDef hung;
  hung.gravity_m_per_s2 = {0, 0, -9.81};
  AddPoint(hung, "mass", {0, 0, -2}, 0.5);
  AddCable(hung, {{kWorld, {0, 0, 0}}, {0, {0, 0, -2}}}, 400, 2 - 0.5 * 9.81 / 400);
  report.Near("mass on a rope", "N/m", LeastStiffnessOf(hung), 0.5 * 9.81 / 2, 1e-9);
}
const SceneEntry kPendulums("statics", "Pendulums that hang and stand", "m g / l", Pendulums);

void MissingSupports(Report& report) {
  const LoadCaseSpec weight;
  const int whole[] = {6, 3, 1, 0};
  for (int supports = 0; supports <= 3; ++supports) {
    const std::string of = "prism on " + std::to_string(supports) + " ball joints";
    const SupportCheck check = CheckSupports(PrismOn(supports, true), weight);
    report.Near(of + ": free motions", "1", check.free, whole[supports], 0);
    report.Near(of + ": refused under weight", "1", check.missing.empty() ? 0 : 1,
                supports < 3 ? 1 : 0, 0);
    const SupportCheck unloaded = CheckSupports(PrismOn(supports, false), weight);
    report.Near(of + ": refused without load", "1", unloaded.missing.empty() ? 0 : 1, 0, 0);
  }
}
const SceneEntry kMissingSupports("statics", "A prism on too few supports", "hand count",
                                  MissingSupports);

}  // namespace
}  // namespace taut::mechanics
