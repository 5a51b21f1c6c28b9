// Model files with random damage: for any contents, reading terminates, throws nothing and returns
// either a robot or at least one error.
#include <gtest/gtest.h>

#include "fuzz/damage.h"
#include "fuzz/reader_targets.h"

namespace taut {
namespace {

void ReadDamaged(const std::string& model, unsigned count) {
  const std::string good = fuzz::ReadAll(TAUT_SOURCE_DIR "/share/models/" + model + ".yaml");
  const fuzz::Folder folder;
  unsigned robots = 0;
  for (unsigned seed = 0; seed < count; ++seed) {
    SCOPED_TRACE(model + " seed " + std::to_string(seed));
    const std::string bad = test::Damage(seed).To(good);
    robots += fuzz::CheckModelFile(folder.Write("model.yaml", bad.data(), bad.size()));
  }
  EXPECT_GT(robots, 0u);         // some damage is harmless: in a comment, a number
  EXPECT_LT(robots, count / 2);  // most is not
}

TEST(ModelFuzz, ADamagedSpineIsReadOrRefused) { ReadDamaged("tetraspine3", 800); }
TEST(ModelFuzz, ADamagedPrismIsReadOrRefused) { ReadDamaged("prism3", 800); }
TEST(ModelFuzz, ADamagedPendulumIsReadOrRefused) { ReadDamaged("hanging_mass", 800); }

}  // namespace
}  // namespace taut
