/// Functions that the readers of parts of a file share.
#pragma once

#include <string>
#include <string_view>

#include "description/yaml/yaml_tree.h"
#include "import_ntrt/ntrt_structure.h"

namespace taut::import_ntrt {

using description::Entry;
using description::Value;
using description::ValuePtr;

/// Largest absolute value of numbers and coordinates, in the file's unit.
inline constexpr double kFarthest = 1e12;

struct Reading {
  const NtrtOptions& options;
  Model& model;
  Diagnostics& out;

  Structure& structure(int i) const { return model.structures[static_cast<std::size_t>(i)]; }
  Node& node(int i) const { return model.nodes[static_cast<std::size_t>(i)]; }
  Pair& pair(int i) const { return model.pairs[static_cast<std::size_t>(i)]; }
};

/// Reads a number by the rules of yaml-cpp, without expressions. Returns NaN after an error.
double ReadPlain(const Value& value, std::string_view what, Diagnostics& out);
/// Reads [x, y, z]. All are NaN after an error.
Vec3 ReadPoint(const Value& value, std::string_view what, Diagnostics& out);
/// Returns the entries of a map. For other types, reports an error and returns no entries. `value`
/// may be null.
const std::vector<Entry>& MapOf(const Value* value, std::string_view what, Diagnostics& out);
/// Returns the items of a list. For other types, reports an error and returns no items. `value` may
/// be null.
const std::vector<ValuePtr>& ListOf(const Value* value, std::string_view what, Diagnostics& out);
/// Reports keys that are not in `known`.
void OnlyKeys(const Value& map, const std::vector<std::string>& known, Diagnostics& out);

/// Splits "a/b/c" into its words.
std::vector<std::string> AtSlashes(const std::string& text);
/// Reads a list of two texts, such as [bottom, top]. Returns false after an error.
bool ReadTwo(const Value& value, std::string& a, std::string& b, Diagnostics& out);
/// Returns the node with a path relative to the structure: leg.hip.top. Returns -1 after an error
/// at `at`.
int NodeAt(const Reading& in, int structure, const std::string& path, const SourceRef& at);
void AddPair(const Reading& in, int structure, int from, int to, Words tags, const SourceRef& at);

/// Reads `builders:` of a file. If several match an item, the last one applies.
void ReadBuilders(const Reading& in, const Value* builders);
/// Adds NTRT's four builders for the tags rod, string, box and sphere.
void AddDefaultBuilders(Model& model);
/// Reads `bond_groups:` of a file.
void ReadBonds(const Reading& in, int structure, const Value* bonds);

}  // namespace taut::import_ntrt
