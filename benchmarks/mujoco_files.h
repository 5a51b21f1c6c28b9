/// What is measured, in files for a program with another version of MuJoCo (benchmarks/wasm).
#pragma once

#include <nlohmann/json.hpp>

#include "benchmarks/peers/peer.h"
#include "taut/model_def.h"

namespace taut::bench {

inline constexpr const char* kMujocoElsewhere = "mujoco_wasm";  ///< Its name among the engines.

/// A case of the MuJoCo peer as that program needs it:
///   mjcf            the model, with a keyframe of its start
///   heights         of the height field that it names, as `hfield_data`
///   bodies          how many, all of them free
///   step_s, control_steps
///   rest_lengths_m  for each control period the rest lengths of all cables, over and over; empty
///                   if they stay
///   free            what the model must do there as here if it is the same: the same model without
///                   ground and contacts, moving for `steps`, and, if a MuJoCo is built in, its
///                   masses and where its bodies end
nlohmann::ordered_json MujocoFile(const ModelDef& def, const peers::Options& options, bool moves);

}  // namespace taut::bench
