/// Functions for reading and resolving gaits of all kinds.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "description/yaml/keys.h"
#include "description/yaml/reader.h"
#include "taut/gait.h"
#include "taut/spec.h"

namespace taut::description {

/// Returns the two spellings of a key, which have the unit of the driven quantity.
constexpr Spellings Driven(const char* of_velocity, const char* of_rest_length) {
  return {{of_velocity, of_rest_length},
          {"gaits with `drives: velocity`", "gaits with `drives: rest_length`"}};
}

/// Role and number of a cable in a chain. Example: "outer_top_2" has the role outer_top and is the
/// second cable from the front.
struct CablePlace {
  std::string role;
  int number = 0;  ///< Position of the cable in the chain, from 1 at the front.
};

/// Splits a cable name. Returns nothing if it does not end in _1, _2, ...
std::optional<CablePlace> PlaceInChain(const std::string& cable_name);

/// Converts a text to a number, correctly rounded. Returns false unless the whole text is one
/// finite number.
bool ToNumber(const std::string& text, double& number);

/// Returns the unit suffix of the gait's signals: "_m_per_s" or "_m".
const char* UnitOfName(GaitDrives drives);
/// Returns a phrase such as "a gait that drives rest lengths".
const char* WhoDrives(GaitDrives drives);

/// Returns the cables of a robot that match. Returns an empty list after an error.
std::vector<int> FindCables(const CableMatch& match, const std::string& what, const SourceRef& at,
                            const RobotSpec& robot, Diagnostics& out);

/// Reports duplicate names in a list of parts of a gait.
template <class Part>
void CheckTwice(const std::vector<Part>& parts, const std::string& what, const Scope& scope) {
  std::map<std::string, SourceRef> seen;
  for (const Part& part : parts) {
    if (part.name.empty()) continue;
    const auto [first, fresh] = seen.emplace(part.name, part.at);
    if (fresh) continue;
    scope.out.Error("gait.duplicate_part", part.at, "two " + what + " are called " + part.name,
                    "the first is in line " + std::to_string(first->second.line));
  }
}

}  // namespace taut::description
