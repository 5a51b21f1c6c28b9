/// Complaints of which a place in a file gets one: copies of a part would only repeat it.
#pragma once

#include <set>
#include <string>
#include <utility>

#include "taut/diagnostics.h"

namespace taut::description {

class OncePerPlace {
 public:
  explicit OncePerPlace(Diagnostics& out) : out_(out) {}

  void operator()(const SourceRef& at, std::string what, std::string hint = {}) {
    if (!places_.insert({at.line, at.column}).second) return;
    out_.Error(at, std::move(what), std::move(hint));
  }

 private:
  Diagnostics& out_;
  std::set<std::pair<int, int>> places_;
};

}  // namespace taut::description
