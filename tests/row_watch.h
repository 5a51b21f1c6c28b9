/// A trace writer for tests that examine the rows of a run and write no file
#pragma once

#include <string>

#include "taut/trace.h"

namespace taut::test {

/// Derived classes define `Append`.
class RowWatch : public TraceWriter {
 public:
  bool FlushOld() override { return true; }
  bool Finish() override { return true; }
  const std::string& error() const override { return none_; }

 private:
  std::string none_;
};

}  // namespace taut::test
