/// Benchmark cases as files for a program with another version of MuJoCo (benchmarks/wasm).
#pragma once

#include <nlohmann/json.hpp>

#include "benchmarks/peers/peer.h"
#include "taut/model_def.h"

namespace taut::bench {

inline constexpr const char* kMujocoElsewhere = "mujoco_wasm";  ///< Name of that engine in results.

/// Returns a case of the MuJoCo peer in the format of that program:
///   mjcf            model, with a keyframe of its start
///   heights         of the height field that it names, as `hfield_data`
///   bodies          number of bodies, all of them free
///   step_s, control_steps
///   rest_lengths_m  rest lengths of all cables for each control period, repeated cyclically;
///                   empty if they are constant
///   free            check of the model: the same model without ground and contacts, moving for
///                   `steps`, and, if a MuJoCo is built in, its masses and the final positions of
///                   its bodies
nlohmann::ordered_json MujocoFile(const ModelDef& def, const peers::Options& options, bool moves);

}  // namespace taut::bench
