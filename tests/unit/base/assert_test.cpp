/// Assertions: a failed assertion ends the program, in builds with TAUT_ASSERTS.
#include "base/assert.h"

#include <gtest/gtest.h>

#include "sim/data/rows.h"

namespace taut {
namespace {

TEST(AssertDeathTest, AFailedAssertionSaysWhereAndWhat) {
#ifdef TAUT_ASSERTS
  EXPECT_DEATH(TAUT_ASSERT(1 + 1 == 3), "assert_test.cpp:[0-9]+: assertion failed: 1 \\+ 1 == 3");
#else
  GTEST_SKIP() << "this build is without TAUT_ASSERTS";
#endif
}

TEST(Assert, AConditionIsLookedAtOnceOrNotAtAll) {
  int looks = 0;
  TAUT_ASSERT(++looks == 1);
#ifdef TAUT_ASSERTS
  EXPECT_EQ(looks, 1);
#else
  EXPECT_EQ(looks, 0);
#endif
}

TEST(AssertDeathTest, ARowKnowsItsEnd) {
  double numbers[] = {1, 2, 3};
  const sim::Row<double> row(numbers, 2);
  EXPECT_EQ(row[1], 2.0);
#ifdef TAUT_ASSERTS
  EXPECT_DEATH(row[2], "room.h:[0-9]+: assertion failed: 0 <= .* < count_");
  EXPECT_DEATH(row[-1], "assertion failed");
#endif
}

}  // namespace
}  // namespace taut
