/// Meaning of a log's column: member of the robot, quantity, axis and unit.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "taut/guess_mapping.h"

namespace taut {

struct ColumnMeaning {
  std::string unit;          ///< Unit in the file, by its name in mappings; empty: none.
  std::string unknown_unit;  ///< Text in brackets that is no unit of mappings.
  std::string kind;          ///< "cable", "body", "node", "joint"; empty: no member has this name.
  std::string member;        ///< Name of the member.
  std::string channel;       ///< Name of taut's channel, with `{axis}` for vectors; empty: unknown.
  char axis = 0;             ///< x, y, z or w of a vector or quaternion; 0: none.
  bool several = false;      ///< Several members fit equally well.
  std::string refused;       ///< Word that marks no measurement ("target", ...); empty: none.
  std::string left_over;     ///< Words of the name without a known meaning.
};

/// Returns the meaning of a column. `unit`: unit stated outside of the name; empty: none.
/// `length_unit`: unit of positions whose names have none.
ColumnMeaning MeaningOf(const std::string& name, const std::string& unit,
                        const std::string& length_unit, const RobotNames& robot);

/// Returns the unit in a column's name, in brackets or at its end; empty: none.
std::string UnitInName(const std::string& name);

/// Returns a unit's name in mappings, for spellings such as "sec", "Newton" or "°"; empty: unknown.
std::string KnownUnit(const std::string& unit);

/// Splits a name at blanks, punctuation, and changes from letters to digits; in lower case, numbers
/// without leading zeros.
std::vector<std::string> Tokens(const std::string& name);

/// Returns whether a name contains one of these words, in lower case.
bool HasWord(const std::vector<std::string>& tokens, const std::vector<std::string_view>& words);

}  // namespace taut
