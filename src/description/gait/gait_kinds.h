/// Registry of the kinds of gaits. Each kind has an entry in `kGaitKinds`, with its member of
/// `GaitSpec`, and a file NAME.h in this folder. The file contains the table of keys and three
/// functions:
///
///   void Check(const MapReader&, Text&);   checks conditions on several keys of a file
///   void CheckNumbers(const Spec&, const SourceRef&, Diagnostics&);
///                                          checks the numbers, also of a resolved experiment
///   void Resolve(const Spec&, const RobotSpec&, ResolvedGait&, Diagnostics&);
///                                          finds the gait's cables in a robot
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "description/gait/gait_cpg.h"
#include "description/gait/gait_feedback_cpg.h"
#include "description/gait/gait_sine.h"
#include "description/gait/gait_table.h"
#include "description/gait/gait_toward_goal.h"

namespace taut::description {

/// Kind of gait. `OfFile`: struct with the contents of a file, either `OfGait` or derived from it.
template <class OfGait, class OfFile = OfGait>
struct GaitKind {
  using Spec = OfGait;
  using Text = OfFile;
  const char* name;
  std::optional<Spec> GaitSpec::*gait;
};

inline constexpr std::tuple kGaitKinds{
    GaitKind<SineGait>{"sine", &GaitSpec::sine},
    GaitKind<CpgGait>{"cpg", &GaitSpec::cpg},
    GaitKind<TableGait, TableText>{"table", &GaitSpec::table},
    GaitKind<FeedbackCpgGait>{"feedback_cpg", &GaitSpec::feedback_cpg},
    GaitKind<TowardGoalGait>{"toward_goal", &GaitSpec::toward_goal},
};

/// Calls visit(kind, index) for each kind, with the index as a compile-time constant.
template <class Visit>
void ForEachGaitKind(const Visit& visit) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (visit(std::get<I>(kGaitKinds), std::integral_constant<std::size_t, I>()), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<std::remove_const_t<decltype(kGaitKinds)>>>());
}

/// Contents of a gait file: one optional struct per kind.
template <class... Kinds>
std::tuple<std::optional<typename Kinds::Text>...> TextsOf(const std::tuple<Kinds...>&);
using GaitKindTexts = decltype(TextsOf(kGaitKinds));

inline std::vector<std::string> GaitKindNames() {
  std::vector<std::string> names;
  ForEachGaitKind([&](const auto& kind, auto) { names.emplace_back(kind.name); });
  return names;
}

/// Returns the lines of a written gait that are not in its table of keys, such as rows of numbers.
template <class Spec>
std::string LinesBesideKeys(const Spec&) {
  return {};
}

/// Returns the number of kinds that are set in a gait. A valid gait has one.
inline int CountKinds(const GaitSpec& gait) {
  int count = 0;
  ForEachGaitKind([&](const auto& kind, auto) { count += (gait.*kind.gait).has_value(); });
  return count;
}

}  // namespace taut::description
