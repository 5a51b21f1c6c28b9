// Version of taut: header against CMake
#include "taut/version.h"

#include <gtest/gtest.h>

TEST(Version, TheHeaderAgreesWithCMake) { EXPECT_STREQ(taut::kVersion, TAUT_CMAKE_VERSION); }
