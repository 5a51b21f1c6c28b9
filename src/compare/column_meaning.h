/// Meaning of a log's column: member of the robot, quantity, axis and unit.
#pragma once

#include <string>
#include <vector>

#include "taut/guess_mapping.h"

namespace taut {

struct ColumnMeaning {
  std::string unit;      ///< Of the file, as mappings name it; empty: none found.
  std::string kind;      ///< "cable", "body", "node", "joint"; empty: no member has this name.
  std::string member;    ///< Its name.
  std::string channel;   ///< Name of taut's channel, with `{axis}` for vectors; empty: unknown.
  char axis = 0;         ///< x, y, z or w of a vector or quaternion; 0: none.
  bool several = false;  ///< Several members fit equally well.
};

/// `unit`: unit stated outside of the name; empty: none. `length_unit`: unit of positions whose
/// name has none.
ColumnMeaning MeaningOf(const std::string& name, const std::string& unit,
                        const std::string& length_unit, const RobotNames& robot);

/// Returns the unit in a column's name, in brackets or at its end; empty: none.
std::string UnitInName(const std::string& name);

/// Returns a unit's name in mappings, for spellings such as "sec", "Newton" or "°"; empty: unknown.
std::string KnownUnit(std::string unit);

/// Splits a name at blanks, punctuation, and changes from letters to digits; in lower case, numbers
/// without leading zeros.
std::vector<std::string> Tokens(const std::string& name);

}  // namespace taut
