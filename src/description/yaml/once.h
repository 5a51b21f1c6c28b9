/// Errors that are reported once per position in a file, since every copy of a part has the same
/// error.
#pragma once

#include <set>
#include <string>
#include <utility>

#include "taut/diagnostics.h"

namespace taut::description {

class OncePerPlace {
 public:
  explicit OncePerPlace(Diagnostics& out) : out_(out) {}

  void operator()(MessageId id, const SourceRef& at, std::string what, std::string hint = {}) {
    if (!places_.insert({at.line, at.column}).second) return;
    out_.Error(id, at, std::move(what), std::move(hint));
  }

 private:
  Diagnostics& out_;
  std::set<std::pair<int, int>> places_;
};

}  // namespace taut::description
