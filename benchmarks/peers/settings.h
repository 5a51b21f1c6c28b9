/// Settings in which the peers are measured and validated.
#pragma once

#include "benchmarks/peers/peer.h"

namespace taut::peers {

struct Setting {
  Engine engine;
  const char* name;
  Options options;
  bool main;  ///< Whether longer series use it.
};

inline constexpr Setting kSettings[] = {
    {Engine::kMujoco, "euler_pyramidal", {}, true},
    {Engine::kMujoco, "euler_elliptic", {.elliptic = true}, false},
    {Engine::kBullet, "iterations_10", {.iterations = 10}, true},
    {Engine::kBullet, "iterations_50", {.iterations = 50}, false},
    {Engine::kBullet, "two_directions", {.iterations = 10, .two_directions = true}, false},
    {Engine::kOde, "quick_10", {.iterations = 10}, true},
    {Engine::kOde, "full_step", {.full_step = true}, true},
};

}  // namespace taut::peers
