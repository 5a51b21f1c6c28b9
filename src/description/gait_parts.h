/// What reading and resolving gaits share.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "description/laws.h"
#include "taut/gait.h"
#include "taut/spec.h"

namespace taut::description {

inline const Choices<CpgSymmetry> kSymmetries{{"segments", CpgSymmetry::kSegments},
                                              {"index", CpgSymmetry::kIndex},
                                              {"none", CpgSymmetry::kNone}};
inline const Choices<GaitDrives> kDrives{{"velocity", GaitDrives::kVelocity},
                                         {"rest_length", GaitDrives::kRestLength}};
inline const Choices<bool> kInterpolations{{"hold", false}, {"linear", true}};

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

/// A table as a file has it: "time_s,outer_top_1_m_per_s,...", then rows. Lines with a # in front
/// say something to people. Nothing after a complaint.
std::optional<TableGait> ReadGaitTable(const std::string& path, GaitDrives drives,
                                       Diagnostics& out);

/// What holds for every table, wherever it comes from.
void CheckTable(const TableGait& table, const SourceRef& at, Diagnostics& out);

}  // namespace taut::description
