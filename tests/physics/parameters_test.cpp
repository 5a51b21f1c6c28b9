/// Limits of the parameters of a world, equal to the limits in model files.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "taut/world_batch.h"
#include "tests/scenes/hanging_mass.h"

namespace taut::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfiniteValue = std::numeric_limits<double>::infinity();

WorldBatch BatchOf(const ModelDef& def) {
  Diagnostics out;
  auto model = Model::Compile(def, out);
  EXPECT_TRUE(model) << out.Format();
  WorldBatchOptions options;
  options.worlds = 2;
  return WorldBatch(std::move(model), options);
}

TEST(Parameters, ValuesOutsideTheLimitsOfModelFilesAreRefused) {
  WorldBatch batch = BatchOf(scenes::HangingMass{}.Def());
  const struct {
    Parameter parameter;
    std::vector<double> wrong;
    double least;
    std::string reason;
  } cases[] = {
      {Parameter::kBodyMass,
       {-1, 0, kNan, kInfiniteValue},
       1e-3,
       "must be a positive number [kg], got "},
      {Parameter::kCableStiffness, {-9, 0, kNan}, 1, "must be a positive number [N/m], got "},
      {Parameter::kCableDamping, {-9, kNan}, 0, "must be zero or a positive number [N s/m], got "},
      {Parameter::kFrictionScale, {-0.1, kNan}, 0, "must be zero or a positive number, got "},
      {Parameter::kGravityX, {kNan, -kInfiniteValue}, -9, "must be a finite number [m/s^2], got "},
  };
  for (const auto& [parameter, wrong, least, reason] : cases) {
    const std::uint64_t before = batch.Hash(1);
    for (const double value : wrong) {
      EXPECT_FALSE(batch.SetParameter(1, parameter, 0, value)) << reason << value;
      EXPECT_EQ(batch.ParameterError(parameter, 0, value).find(reason), 0u) << value;
    }
    EXPECT_EQ(batch.Hash(1), before);
    EXPECT_EQ(batch.ParameterError(parameter, 0, least), "");
    EXPECT_TRUE(batch.SetParameter(1, parameter, 0, least));
    EXPECT_EQ(batch.GetParameter(1, parameter, 0), least);
  }
  EXPECT_EQ(batch.ParameterError(Parameter::kBodyMass, 0, -1),
            "must be a positive number [kg], got -1");
}

TEST(Parameters, AFixedBodyHasNoMassAndAcceptsAny) {
  ModelDef def = scenes::HangingMass{}.Def();
  def.bodies[0].fixed = true;
  WorldBatch batch = BatchOf(def);
  const std::uint64_t before = batch.Hash(0);
  EXPECT_TRUE(batch.SetParameter(0, Parameter::kBodyMass, 0, 0.0));
  EXPECT_EQ(batch.Hash(0), before);
}

}  // namespace
}  // namespace taut::test
