/// What reading and resolving gaits share.
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

/// A key whose unit follows what the gait drives.
constexpr Spellings Driven(const char* of_velocity, const char* of_rest_length) {
  return {{of_velocity, of_rest_length},
          {"a gait with `drives: velocity`", "a gait with `drives: rest_length`"}};
}

/// What a cable of a chain is: "outer_top_2" is an outer_top, the second from the front.
struct CablePlace {
  std::string role;
  int number = 0;  ///< From 1.
};

/// Nothing if the name does not end in _1, _2, ...
std::optional<CablePlace> PlaceInChain(const std::string& cable_name);

/// False if the text is not a finite number and nothing else. The last digit is right everywhere.
bool ToNumber(const std::string& text, double& number);

/// "_m_per_s" or "_m": what names of the gait's signals end with.
const char* UnitOfName(GaitDrives drives);
/// "a gait that drives rest lengths".
const char* WhoDrives(GaitDrives drives);

/// The cables of a robot that match; none after a complaint.
std::vector<int> FindCables(const CableMatch& match, const std::string& what, const SourceRef& at,
                            const RobotSpec& robot, Diagnostics& out);

/// Complains about names that are there twice; gaits name their parts.
template <class Part>
void CheckTwice(const std::vector<Part>& parts, const std::string& what, const Scope& scope) {
  std::map<std::string, SourceRef> seen;
  for (const Part& part : parts) {
    if (part.name.empty()) continue;
    const auto [first, fresh] = seen.emplace(part.name, part.at);
    if (fresh) continue;
    scope.out.Error(part.at, "there are two " + what + " " + part.name,
                    "the first is in line " + std::to_string(first->second.line));
  }
}

}  // namespace taut::description
