/// Fixture for experiments with a given terrain
#pragma once

#include <optional>
#include <string>

#include "unit/description/experiment_fixture.h"

namespace taut::test {

inline const std::string kGround = "- {name: ground, plane: {height_m: 0, friction: 0.5}}";

class GroundText : public ExperimentFolder {
 protected:
  std::optional<ExperimentSpec> Load(const std::string& terrain, Diagnostics& out) {
    Write("trial.yaml", kExperiment);
    Change(kGround, terrain);
    return LoadExperiment(Path("trial.yaml"), {}, out);
  }
  RobotSpec With(const std::string& terrain) {
    Diagnostics out;
    const auto experiment = Load(terrain, out);
    EXPECT_TRUE(experiment) << out.Format();
    return experiment ? experiment->robot : RobotSpec{};
  }
  /// Returns the errors of an invalid terrain.
  std::string Said(const std::string& terrain) {
    Diagnostics out;
    EXPECT_FALSE(Load(terrain, out)) << terrain;
    return out.Format();
  }
};

}  // namespace taut::test
