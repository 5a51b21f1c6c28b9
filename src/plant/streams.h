/// What an experiment's seed is used for: a stream of random numbers each.
#pragma once

#include <cstdint>

namespace taut::plant {

enum Stream : std::uint32_t {
  kLoadCellNoise = 1,  ///< Index: sample * cables + cable.
  kLoadCellBias = 2,   ///< Index: cable.
  kStartPosition = 3,  ///< Index: body.
  kStartHeading = 4,   ///< Index: 0.
};

}  // namespace taut::plant
