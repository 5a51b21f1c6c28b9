// Experiment files with random damage: reading one ends, throws nothing and gives either an
// experiment or at least one error; and what it gives can be compiled or is refused then.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "fuzz/damage.h"
#include "taut/batch.h"
#include "taut/spec.h"

namespace taut {
namespace {

void ReadDamaged(const std::string& name, const std::string& good, unsigned count) {
  const std::string path = ::testing::TempDir() + "taut_damaged_" + name + ".yaml";
  unsigned read = 0;
  for (unsigned seed = 0; seed < count; ++seed) {
    std::ofstream(path, std::ios::binary) << test::Damage(seed).To(good);
    Diagnostics out;
    const auto experiment = LoadExperiment(path, {}, out);
    ASSERT_EQ(experiment.has_value(), out.ok()) << name << " seed " << seed << "\n" << out.Format();
    if (!experiment) continue;
    ++read;
    const ModelDef& def = experiment->robot.def;
    for (const ControllerSpec& controller : experiment->controllers) {
      for (const PositionProgram& program : controller.position) {
        ASSERT_LT(static_cast<std::size_t>(program.cable), def.cables.size()) << "seed " << seed;
      }
    }
    for (const PushSpec& push : experiment->pushes) {
      ASSERT_LT(static_cast<std::size_t>(push.node), def.nodes.size()) << "seed " << seed;
    }
    Diagnostics refused;
    ASSERT_EQ(Model::Compile(def, refused) != nullptr, refused.ok()) << "seed " << seed;
  }
  std::remove(path.c_str());
  EXPECT_GT(read, 0u);         // some damage is harmless: a comment, a number
  EXPECT_LT(read, count / 2);  // most is not
}

/// A shipped experiment that can be read from anywhere.
std::string Shipped(const std::string& name) {
  std::string text = test::Text(TAUT_SOURCE_DIR "/experiments/" + name + ".yaml");
  const std::string from = "../models/", to = TAUT_SOURCE_DIR "/models/";
  return text.replace(text.find(from), from.size(), to);
}

TEST(ExperimentFuzz, ADamagedPushIsReadOrRefused) { ReadDamaged("push", Shipped("push_20n"), 500); }
TEST(ExperimentFuzz, ADamagedDropIsReadOrRefused) {
  ReadDamaged("drop", Shipped("drop_six_strut"), 500);
}
TEST(ExperimentFuzz, ADamagedResolvedExperimentIsReadOrRefused) {
  Diagnostics out;
  const auto hang = LoadExperiment(TAUT_SOURCE_DIR "/experiments/hang.yaml", {}, out);
  ASSERT_TRUE(hang) << out.Format();
  ReadDamaged("resolved", ResolvedYaml(*hang), 1000);
}

}  // namespace
}  // namespace taut
