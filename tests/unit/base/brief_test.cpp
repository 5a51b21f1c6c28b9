/// Numbers as text in messages: digits and shortest form
#include "base/brief.h"

#include <gtest/gtest.h>

#include <cmath>

namespace taut::base {
namespace {

TEST(Brief, HasFourDigitsOrThoseAskedFor) {
  EXPECT_EQ(Brief(0.123456), "0.1235");
  EXPECT_EQ(Brief(123456), "1.235e+05");
  EXPECT_EQ(Brief(0.123456, 3), "0.123");
  EXPECT_EQ(Brief(1234567.8, 6), "1.23457e+06");
  EXPECT_EQ(Brief(2, 6), "2");
  EXPECT_EQ(Brief(-INFINITY, 3), "-inf");
}

TEST(Shortest, ReadsBackAsTheSameNumber) {
  EXPECT_EQ(Shortest(0.1), "0.1");
  EXPECT_EQ(Shortest(1.0 / 3), "0.3333333333333333");
  EXPECT_EQ(Shortest(-5e-324), "-5e-324");
  EXPECT_EQ(Shortest(1e22), "1e+22");
}

}  // namespace
}  // namespace taut::base
