/// Features that this build of taut contains, for `taut --version --features`.
#pragma once

#include <string>

namespace taut::cli {

/// Returns one line per optional feature: "NAME: yes" or "NAME: no (how to get it)".
std::string FeaturesText();

}  // namespace taut::cli
