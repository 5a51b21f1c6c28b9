// Experiment files with random damage: reading terminates, throws nothing and returns either an
// experiment or at least one error; an experiment can be compiled or is refused then.
#include <gtest/gtest.h>

#include "fuzz/damage.h"
#include "fuzz/reader_targets.h"

namespace taut {
namespace {

void ReadDamaged(const std::string& name, const std::string& good, unsigned count) {
  const fuzz::Folder folder;
  unsigned read = 0;
  for (unsigned seed = 0; seed < count; ++seed) {
    SCOPED_TRACE(name + " seed " + std::to_string(seed));
    const std::string bad = test::Damage(seed).To(good);
    read += fuzz::CheckExperimentFile(folder.Write(name, bad.data(), bad.size()), folder);
  }
  EXPECT_GT(read, 0u);         // some damage is harmless: in a comment, a number
  EXPECT_LT(read, count / 2);  // most is not
}

/// Returns the text of a shipped experiment with absolute paths.
std::string Shipped(const std::string& name) {
  std::string text = fuzz::ReadAll(TAUT_SOURCE_DIR "/share/experiments/" + name + ".yaml");
  const std::string from = "../models/", to = TAUT_SOURCE_DIR "/share/models/";
  return text.replace(text.find(from), from.size(), to);
}

TEST(ExperimentFuzz, ADamagedPushIsReadOrRefused) {
  ReadDamaged("push.yaml", Shipped("push_20n"), 500);
}
TEST(ExperimentFuzz, ADamagedDropIsReadOrRefused) {
  ReadDamaged("drop.yaml", Shipped("drop_six_strut"), 500);
}
TEST(ExperimentFuzz, DamagedStairsAndBlocksAreReadOrRefused) {
  std::string text = Shipped("stairs");
  text.insert(
      text.find("terrain:\n") + 9,
      "  - name: field\n    scatter: {count: 30, seed: 2, within_m: [[-1, -1, -2], [1, 1, -1]], "
      "box_m: [0.1, 0.2, 0.3]}\n");
  ReadDamaged("stairs.yaml", text, 500);
}
TEST(ExperimentFuzz, ADamagedResolvedExperimentIsReadOrRefused) {
  Diagnostics out;
  const auto hang = LoadExperiment(TAUT_SOURCE_DIR "/share/experiments/hang.yaml", {}, out);
  ASSERT_TRUE(hang) << out.Format();
  ReadDamaged("resolved.yaml", ResolvedYaml(*hang), 1000);
}

}  // namespace
}  // namespace taut
