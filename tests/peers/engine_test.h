/// Base class of tests of one engine with one of its settings; skipped if the build lacks the
/// engine.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "benchmarks/peers/settings.h"

namespace taut::peers {

class EngineTest : public testing::TestWithParam<Setting> {
 protected:
  void SetUp() override {
    if (!Available(GetParam().engine))
      GTEST_SKIP() << Name(GetParam().engine) << " is not built in";
  }
  static std::unique_ptr<World> Make(const ModelDef& def) {
    return MakeWorld(GetParam().engine, def, GetParam().options);
  }
};

}  // namespace taut::peers
