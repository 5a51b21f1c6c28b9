// Files of a fit that become unreadable: they end the fit, and no trial counts as failed.
#include "tests/unit/identify/identify_fixture.h"

namespace taut {
namespace {

namespace fs = std::filesystem;

class UnreadableInput : public test::IdentifyTest {};

TEST_F(UnreadableInput, EndsTheFitAndIsNoFailedTrial) {
  const auto broken = Make(test::kFit, "fit.sqlite");
  ASSERT_TRUE(broken) << out_.Format();
  fs::rename(folder_ / "model.yaml", folder_ / "away.yaml");
  const FitOutcome ended = RunFit(*broken, {});
  EXPECT_TRUE(ended.interrupted || !ended.why.empty());
  EXPECT_NE(broken->input_error().find("model.yaml"), std::string::npos) << broken->input_error();
  fs::rename(folder_ / "away.yaml", folder_ / "model.yaml");
  const auto again = Make(test::kFit, "fit.sqlite");
  ASSERT_TRUE(again) << out_.Format();
  EXPECT_EQ(again->counts().remembered, 0);
  EXPECT_EQ(RunFit(*again, {}).why, "");
  EXPECT_EQ(again->input_error(), "");
}

TEST_F(UnreadableInput, AMistakeInATrialIsAFailedTrial) {
  const auto fit = Make(test::kFit);
  ASSERT_TRUE(fit) << out_.Format();
  EXPECT_NE(At(*fit, {-1, 0}).failed, "");
  EXPECT_EQ(fit->input_error(), "");
}

}  // namespace
}  // namespace taut
