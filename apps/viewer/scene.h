/// Scene of web/protocol/messages.json: geometry, names and channels of a model or a trace.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pyramid.h"
#include "taut/live.h"
#include "taut/spec.h"
#include "taut/trace.h"

namespace taut::viewer {

using Json = nlohmann::ordered_json;  // keeps the order of keys; NaN becomes null

Json ToJson(const Vec3& v);
Json ToJson(const Quat& q);
Json ToJson(const std::vector<ChannelInfo>& channels);

/// Returns the SeriesData of web/protocol/messages.json.
Json SeriesJson(const std::string& channel, int source, const Series& series);

/// Returns the scene of an experiment: its model, surroundings and phases, without parameters,
/// controls and channels.
Json SceneOf(const ExperimentSpec& experiment);

/// Returns the scene of a trace without model: bodies are small spheres, cables have no position.
Json SceneOf(const Trace& trace);

/// Returns JSON text; invalid UTF-8 is replaced.
std::string Dump(const Json& json);

}  // namespace taut::viewer
