/// What there is to see, as the Scene of web/protocol/messages.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pyramid.h"
#include "taut/live.h"
#include "taut/spec.h"
#include "taut/trace.h"

namespace taut::viewer {

using Json = nlohmann::ordered_json;  // keys in the order in which they are set; NaN prints as null

Json ToJson(const Vec3& v);
Json ToJson(const Quat& q);
Json ToJson(const std::vector<ChannelInfo>& channels);

/// The SeriesData of web/protocol/messages.json.
Json SeriesJson(const std::string& channel, int source, const Series& series);

/// The scene of a model with an experiment's surroundings and phases; no parameters, controls,
/// channels.
Json SceneOf(const ExperimentSpec& experiment);

/// The scene of a trace whose model is not known: bodies are small spheres, cables have no place.
Json SceneOf(const Trace& trace);

/// JSON text; a text that is not UTF-8 gets replacement characters.
std::string Dump(const Json& json);

}  // namespace taut::viewer
