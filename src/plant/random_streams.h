/// Random number streams of an experiment's seed, one per use. Comments give the index within a
/// stream.
#pragma once

#include <cstdint>

namespace taut::plant {

enum Stream : std::uint32_t {
  kLoadCellNoise = 1,  ///< Index: sample * cables + cable.
  kLoadCellBias = 2,   ///< Index: cable.
  kStartPosition = 3,  ///< Index: body.
  kStartHeading = 4,   ///< Index: 0.
  kLoadCellGain = 5,   ///< Index: cable.
  kLoadCellDrift = 6,  ///< Index: cable.
  kLoadCellCount = 7,  ///< Index: sample * cables + cable.
  kEncoderZero = 8,    ///< Index: cable.
  kEncoderGain = 9,    ///< Index: cable.
  kGoal = 10,          ///< Index: 0.
  kStartPose = 11,     ///< Index: 0.
  // Used by environments (src/env/):
  kEpisodeScales = 12,       ///< Index: 0.
  kEpisodeSlope = 13,        ///< Index: 0.
  kEpisodeDelays = 14,       ///< Index: 0.
  kFollowingSeed = 15,       ///< Index: 0; the seed of the next episode.
  kStartPlace = 16,          ///< Index: 0.
  kBoardLoadCellNoise = 17,  ///< Index: tick * cables + cable.
  // Stream 100 is used by scattered blocks of terrain, which have a separate seed
  // (description/experiment/terrain_boxes.cpp).
};

}  // namespace taut::plant
