/// Natural frequencies against structural programs and simulated robots

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "math/angle.h"
#include "mechanics/mass_properties.h"
#include "taut/analysis.h"
#include "taut/cable_scheme.h"
#include "taut/world_batch.h"
#include "tests/scenes/rod.h"
#include "tests/unit/description/structural_files.h"

namespace taut::test {
namespace {

/// Returns the frequencies of all modes in ascending order; 0 for rigid motions and mechanisms
/// [Hz].
std::vector<double> Frequencies(const ModelDef& def) {
  const Modes modes = FindModes(def);
  EXPECT_EQ(modes.why, "");
  std::vector<double> hz;
  for (const Mode& mode : modes.modes) hz.push_back(mode.frequency_hz);
  return hz;
}

void Expect(const std::vector<double>& hz, const std::vector<double>& known, double relative) {
  ASSERT_GE(hz.size(), known.size());
  for (std::size_t i = 0; i < known.size(); ++i) {
    EXPECT_NEAR(hz[i], known[i], relative * known[i] + 1e-7) << i;
  }
}

struct Known {
  const char* file;
  MemberMass mass;
  std::vector<double> hz;
};

TEST(Modes, AreThoseOfStructuralFiles) {
  const Known all[] = {
      {"tsgfem_static_half_Tbar", MemberMass::kConsistent, {167.7479388, 1380.2545229}},
      {"tsgfem_static_3d_Dbar_folding",
       MemberMass::kConsistent,
       {0, 2.6176315, 2.6176315, 4.5355272}},
      {"tsgfem_static_tower_2prism",
       MemberMass::kConsistent,
       {0.0108886697, 0.0195394550, 0.0339645423, 0.0339645423}},
      {"ctsfem_cable_net_TTS_static", MemberMass::kConsistent, {0.6939147, 0.9801662, 0.9801662}},
      {"ctsfem_cable_net_TTS_static",
       MemberMass::kLumped,
       {0.6486321, 0.9015406, 0.9015406, 1.3725456, 1.3725456, 1.8294915}},
  };
  for (const Known& known : all) {
    SCOPED_TRACE(known.file);
    const auto file = StructuralFile(known.file);
    if (!file) GTEST_SKIP() << "no reference structures beside the checkout";
    const std::vector<double> hz = Frequencies(TrussOf(*file, known.mass));
    Expect(hz, known.hz, 1e-7);
    if (known.mass == MemberMass::kConsistent) {
      Expect(hz, Numbers((*file)["freq_Hz_recomputed"]), 1e-6);
    }
  }
}

/// Two crossing rigid bars in the plane of x and y, as in tests/physics/clustered_test.cpp; one of
/// the cables runs through an eyelet at the end of a bar.
struct CrossFrame {
  double half, mass[2], stiffness, rest, cable_mass;  ///< The last three: of a cable of one side.
};
constexpr CrossFrame kTBar{
    2, {2.4746351864, 13.9986379133}, 31107.8383, 2.2324739177, 0.0160550684};
constexpr CrossFrame kDBar{1, {7.8255358022, 7.8255358022}, 311079.532, 1.4119404794, 0.0642202734};

ModelDef ModelOf(const CrossFrame& cross, bool cables_have_mass) {
  ModelDef def;
  def.gravity_m_per_s2 = {};
  const Vec3 node[4] = {{0, 0, 0}, {1, cross.half, 0}, {2, 0, 0}, {1, -cross.half, 0}};
  const std::vector<std::vector<std::size_t>> ways = {{0, 1, 2}, {2, 3}, {3, 0}};
  std::vector<MassProperties> parts[2];
  for (std::size_t b = 0; b < 2; ++b) {
    const Vec3 along = node[b + 2] - node[b];
    MassProperties bar = SolidCylinder(node[b], node[b + 2], 1e-4, cross.mass[b]);
    // Inertia of a thin line
    bar.inertia_kg_m2 = {};
    const double moment = cross.mass[b] * Dot(along, along) / 12;
    (b == 0 ? bar.inertia_kg_m2.yy : bar.inertia_kg_m2.xx) = moment;
    bar.inertia_kg_m2.zz = moment;
    parts[b].push_back(bar);
  }
  for (const auto& way : ways) {
    const double mass = cross.cable_mass * static_cast<double>(way.size() - 1);
    for (const std::size_t end : {way.front(), way.back()}) {
      if (cables_have_mass) parts[end % 2].push_back({0.5 * mass, node[end], {}});
    }
  }
  for (std::size_t b = 0; b < 2; ++b) {
    const MassProperties all = Combine(parts[b]);
    BodyDef body;
    body.mass_kg = all.mass_kg, body.com_m = all.com_m, body.inertia_kg_m2 = all.inertia_kg_m2;
    body.inertia_kg_m2.xx += 1e-3,
        body.inertia_kg_m2.yy += 1e-3;  // they do not rotate about these axes
    def.bodies.push_back(body);
    const int index = static_cast<int>(b);
    AddJoint(def, JointKind::kPlanar, kWorld, all.com_m, index, all.com_m);
  }
  for (const auto& way : ways) {
    std::vector<AttachmentDef> at;
    for (const std::size_t n : way) at.push_back({static_cast<int>(n % 2), node[n]});
    const double sides = static_cast<double>(way.size() - 1);
    CableDef& cable = AddCable(def, at, cross.stiffness / sides, cross.rest * sides);
    if (!cables_have_mass) continue;
    cable.member.mass_kg = cross.cable_mass * sides;
    cable.member.mass = MemberMass::kConsistent;
  }
  return def;
}

// For the first case CTSFEM itself gives 1.4781 Hz, because it neglects that the spans share a
// tension. References without cable masses: numerical derivatives of the energy in 50 digits; with
// cable masses: CTSFEM's matrices with the exact tangent (and elastic bars). There a negative
// eigenvalue is shown as 0: the fourth of the D-bar, which is unstable. With k the stiffness of a
// side, q the force density of the cables, m the mass of a bar, (k + 2 q - m w^2 / 2) (k - 2 q - m
// w^2 / 6) = k^2 has one negative root.
TEST(Modes, ClusteredCablesVibrateAsTheirExactEquationsSay) {
  struct {
    const CrossFrame* cross;
    bool mass;
    double hz[3];  ///< Frequencies after the three rigid motions in the plane.
    double relative;
  } const cases[] = {
      {&kTBar, true, {1.1440225986849, 34.52647094067688, 41.249720966315486}, 1e-6},
      {&kTBar, false, {1.1485267544849531, 34.63448567347343, 41.72911310288057}, 1e-10},
      {&kDBar, true, {0, 63.34214583141426, 88.5442503337753}, 1e-6},
      {&kDBar, false, {-0.1250326992793397, 63.51518211541368, 89.6798596880948}, 1e-8}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.hz[2]);
    const Modes modes = FindModes(ModelOf(*c.cross, c.mass));
    ASSERT_EQ(modes.why, "");
    EXPECT_EQ(modes.rigid, 3);
    ASSERT_EQ(modes.modes.size(), 6U);
    EXPECT_EQ(modes.unstable, c.cross == &kDBar ? 1 : 0);
    for (std::size_t i = 0; i < 3; ++i) {
      if (c.hz[i] == 0) {
        EXPECT_NEAR(modes.modes[3 + i].frequency_hz, -0.1243, 1e-3);
      } else {
        EXPECT_NEAR(modes.modes[3 + i].frequency_hz, c.hz[i], c.relative * std::fabs(c.hz[i]));
      }
    }
  }
}

TEST(Modes, APointBetweenTwoTautCablesHasItsTwoFrequencies) {
  const double k = 400, rest = 0.9, mass = 0.3, tension = k * (1 - rest);
  const std::vector<double> hz = Frequencies([&] {
    ModelDef def = Rope(mass, k, rest);
    def.gravity_m_per_s2 = {};
    return def;
  }());
  const double across = std::sqrt(2 * tension / mass) / (2 * std::numbers::pi);
  Expect(hz, {across, across, std::sqrt(2 * k / mass) / (2 * std::numbers::pi)}, 1e-12);
}

TEST(Modes, ARodHangsAsAPendulumAndFallsFromItsHead) {
  for (const double side : {-1.0, 1.0}) {
    ModelDef def;
    scenes::AddRod(def, "rod", 0.7, 1e-5, {0, 0, 0}, {0, 0, side * 0.8}, {});
    AddJoint(def, JointKind::kBall, kWorld, {0, 0, 0}, 0, {0, 0, 0});
    const Modes modes = FindModes(def);
    ASSERT_EQ(modes.modes.size(), 2U);  // none about its axis
    const double hz = std::sqrt(1.5 * 9.81 / 0.8) / (2 * std::numbers::pi);
    for (const Mode& mode : modes.modes) EXPECT_NEAR(mode.frequency_hz, -side * hz, 1e-8);
    EXPECT_EQ(modes.unstable, side > 0 ? 2 : 0);
    EXPECT_EQ(modes.rigid, 0);
  }
}

ModelDef Prism3() {
  Diagnostics out;
  const auto robot = LoadRobot(TAUT_SOURCE_DIR "/share/models/prism3.yaml", {}, out);
  EXPECT_TRUE(robot.has_value()) << out.Format();
  ModelDef def = robot->def;
  def.gravity_m_per_s2 = {};
  for (CableDef& cable : def.cables) cable.damping_n_s_per_m = 0;
  return def;
}

TEST(Modes, OfAFloatingPrismAreThoseOfARingDown) {
  const ModelDef def = Prism3();
  const Modes modes = FindModes(def);
  EXPECT_EQ(modes.rigid, 6);
  EXPECT_EQ(modes.mechanisms, 0);
  ASSERT_EQ(modes.modes.size(), 15U);
  const double known[] = {20.4195, 39.798, 39.798, 46.239, 46.239, 66.047, 71.796, 71.796, 86.872};
  for (std::size_t i = 0; i < 9; ++i) {
    // Five digits are known.
    EXPECT_NEAR(modes.modes[6 + i].frequency_hz, known[i], 1e-5 * known[i] + 2e-4) << i;
  }

  // The integrator's frequency is higher by (w h)^2 / 24 for explicit cables
  // (docs/theory/integrator.md), and lower by (w h)^2 / 12, as by the midpoint rule, for implicit
  // ones (docs/theory/cables.md, section 3).
  const Mode& mode = modes.modes[6];
  for (const double step_s : {1e-3, 5e-4}) {
    Diagnostics out;
    WorldBatch world(Model::Compile(def, out), {});
    constexpr double kAmplitude = 1e-6;
    for (int b = 0; b < 3; ++b) {
      const std::size_t i = static_cast<std::size_t>(b);
      BodyState state = world.Body(0, b);
      state.position_m = state.position_m + kAmplitude * mode.translation_m[i];
      const Vec3 half = (0.5 * kAmplitude) * mode.turn_rad[i];
      state.orientation = Quat{1, half.x, half.y, half.z} * state.orientation;
      world.SetBodyState(0, b, state);
    }
    const auto share = [&] {  // projection of the displacement onto the mode, weighted by mass
      double sum = 0;
      for (int b = 0; b < 3; ++b) {
        const std::size_t i = static_cast<std::size_t>(b);
        sum += Dot(mode.translation_m[i], world.Body(0, b).position_m - def.bodies[i].com_m);
        const Quat q = world.Body(0, b).orientation;
        sum += 1e-2 * Dot(mode.turn_rad[i], {q.x, q.y, q.z});
      }
      return sum;
    };
    double first = 0, last = 0, before = share();
    for (int crossings = 0; crossings <= 40;) {
      world.Step(step_s);
      const double now = share();
      if (before * now < 0) {
        last = world.Time(0) - step_s * now / (now - before);
        if (crossings++ == 0) first = last;
      }
      before = now;
      ASSERT_LT(world.Time(0), 5);
    }
    const double hz = 20 / (last - first), wh = 2 * std::numbers::pi * mode.frequency_hz * step_s;
    const bool is_explicit = CableSchemes(world.model(), step_s)[0] == CableScheme::kExplicit;
    const double shift = is_explicit ? wh * wh / 24 : -wh * wh / 12;
    EXPECT_NEAR(hz / mode.frequency_hz - 1, shift, 0.03 * std::fabs(shift)) << step_s;
  }
}

TEST(Modes, OfWhatStandsOnAPlaneAreThoseThatStayOnIt) {
  ModelDef def = Prism3();
  def.gravity_m_per_s2 = {0, 0, -9.81};
  def.planes.push_back({"ground", {0, 0, 1}, {0, 0, 0}, {}});
  const Equilibrium e = FindEquilibrium(def);
  ASSERT_TRUE(e.found) << e.why;
  const Modes modes = FindModes(ModelAt(def, e.pose));
  EXPECT_EQ(modes.rigid, 3);  // two translations, one rotation
  EXPECT_EQ(modes.unstable, 0);
  EXPECT_EQ(modes.modes.size(), 12U);
}

}  // namespace
}  // namespace taut::test
