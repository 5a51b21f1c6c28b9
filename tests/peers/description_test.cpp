// Models in MuJoCo, Bullet and ODE, converted from taut's description, before any step.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "math/vec.h"
#include "tests/peers/peers_robots.h"

namespace taut::peers {
namespace {

class Description : public testing::TestWithParam<std::tuple<Engine, std::string>> {
 protected:
  void SetUp() override {
    if (!Available(engine())) GTEST_SKIP() << Name(engine()) << " is not built in";
    def_ = test::OnGround(test::Robot(std::get<1>(GetParam())));
    world_ = MakeWorld(engine(), def_);
  }
  Engine engine() const { return std::get<0>(GetParam()); }

  ModelDef def_;
  std::unique_ptr<World> world_;
};

/// Diagonalizing a 3x3 matrix and rotating it back: some tens of roundings of its largest entry.
constexpr double kRoundings = 64 * std::numeric_limits<double>::epsilon();

TEST_P(Description, MassCentreAndInertiaAreThose) {
  for (std::size_t b = 0; b < def_.bodies.size(); ++b) {
    const BodyDef& body = def_.bodies[b];
    const MassState mass = world_->Mass(static_cast<int>(b));
    SCOPED_TRACE(body.name);
    EXPECT_NEAR(mass.mass_kg, body.mass_kg, kRoundings * body.mass_kg);
    const double reach = 1 + std::sqrt(Dot(body.com_m, body.com_m));
    EXPECT_NEAR(mass.com_m.x, body.com_m.x, kRoundings * reach);
    EXPECT_NEAR(mass.com_m.y, body.com_m.y, kRoundings * reach);
    EXPECT_NEAR(mass.com_m.z, body.com_m.z, kRoundings * reach);
    const Inertia &have = mass.inertia_kg_m2, &want = body.inertia_kg_m2;
    const double size = want.xx + want.yy + want.zz;
    EXPECT_NEAR(have.xx, want.xx, kRoundings * size);
    EXPECT_NEAR(have.yy, want.yy, kRoundings * size);
    EXPECT_NEAR(have.zz, want.zz, kRoundings * size);
    EXPECT_NEAR(have.xy, want.xy, kRoundings * size);
    EXPECT_NEAR(have.xz, want.xz, kRoundings * size);
    EXPECT_NEAR(have.yz, want.yz, kRoundings * size);
  }
}

TEST_P(Description, CableLengthsAndTensionsAtRestAreOurs) {
  Diagnostics complaints;
  const WorldBatch ours(Model::Compile(def_, complaints), {});
  ASSERT_FALSE(def_.cables.empty());
  for (std::size_t c = 0; c < def_.cables.size(); ++c) {
    const CableDef& cable = def_.cables[c];
    SCOPED_TRACE(cable.name);
    const CableState want = ours.Cable(0, static_cast<int>(c));
    const CableState have = world_->Cable(static_cast<int>(c));
    // Lengths are differences of positions of the order of a meter.
    EXPECT_NEAR(have.length_m, want.length_m, kRoundings);
    EXPECT_NEAR(have.rate_m_per_s, 0, kRoundings);
    EXPECT_EQ(have.rest_length_m, cable.rest_length_m);
    EXPECT_NEAR(have.tension_n, want.tension_n, kRoundings * cable.stiffness_n_per_m);
    EXPECT_NEAR(have.elastic_n, want.elastic_n, kRoundings * cable.stiffness_n_per_m);
    EXPECT_GT(have.tension_n, 0);
  }
}

std::string DescriptionCaseName(const testing::TestParamInfo<Description::ParamType>& info) {
  return std::string(Name(std::get<0>(info.param))) + "_" + std::get<1>(info.param);
}

INSTANTIATE_TEST_SUITE_P(Peers, Description,
                         testing::Combine(testing::ValuesIn(kEngines),
                                          testing::Values("tetraspine3", "tetraspine12",
                                                          "six_strut", "prism3")),
                         DescriptionCaseName);

TEST(Peers, SayWhatTheyDoNotKnow) {
  ModelDef def = test::OnGround(test::Robot("tetraspine3"));
  EXPECT_EQ(Unsupported(def), "");
  ModelDef other = def;
  other.terrain_boxes.emplace_back();
  EXPECT_EQ(Unsupported(other), "terrain boxes");
  other = def;
  other.terrain_meshes.emplace_back();
  EXPECT_EQ(Unsupported(other), "terrain meshes");
  other = def;
  other.height_fields.emplace_back();
  EXPECT_EQ(Unsupported(other), "height fields whose `split` is not `same`");
  other.height_fields[0].split = HeightFieldDef::Split::kSame;
  EXPECT_EQ(Unsupported(other), "");
  other.height_fields[0].material.static_friction = 0.6;
  EXPECT_EQ(Unsupported(other), "static friction that differs from kinetic friction");
  other.height_fields.emplace_back();
  EXPECT_EQ(Unsupported(other), "more than one height field");
  other = def;
  other.bodies[1].fixed = true;
  EXPECT_EQ(Unsupported(other), "the fixed body " + def.bodies[1].name);
  other = def;
  other.cables[2].damping_law = DampingLaw::kClamped;
  EXPECT_EQ(Unsupported(other), "the damping law of cable " + def.cables[2].name);
  other = def;
  other.spheres[0].material.kinetic_friction = 0.1;
  EXPECT_EQ(Unsupported(other), "shapes of different materials");
  other = def;
  other.planes[0].material.static_friction = 0.6;
  EXPECT_EQ(Unsupported(other), "static friction that differs from kinetic friction");
  other = def;
  other.friction_law = FrictionLaw::kAlongSlip;
  EXPECT_EQ(Unsupported(other), "the friction law along_slip");
  for (const Engine engine : kEngines) {
    EXPECT_THROW(MakeWorld(engine, other), std::invalid_argument);
  }
}

}  // namespace
}  // namespace taut::peers
