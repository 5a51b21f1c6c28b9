/// Runs every scene of this folder with the effort of a test.

#include <gtest/gtest.h>

#include <cctype>
#include <string>

#include "tests/mechanics/known_scene.h"

namespace taut::mechanics {
namespace {

class MechanicsScene : public testing::TestWithParam<SceneEntry> {};

TEST_P(MechanicsScene, AgreesWithItsOracle) {
  Report report(Effort::kSample);
  GetParam().run(report);
  EXPECT_FALSE(report.findings().empty());
  for (const Finding& finding : report.findings()) {
    EXPECT_TRUE(finding.Holds()) << finding.quantity << " [" << finding.unit << "]: measured "
                                 << finding.measured << ", expected "
                                 << (finding.is_bound ? "at most " : "") << finding.expected
                                 << (finding.is_bound ? "" : " within ")
                                 << (finding.is_bound ? std::string()
                                                      : std::to_string(finding.tolerance));
  }
}

std::string NameOf(const testing::TestParamInfo<SceneEntry>& info) {
  std::string name = std::string(info.param.subject) + "_" + info.param.name;
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, MechanicsScene, testing::ValuesIn(AllScenes()), NameOf);

}  // namespace
}  // namespace taut::mechanics
