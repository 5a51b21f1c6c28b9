/// Functions shared by the readers of the parts of a file.
#pragma once

#include <string>
#include <string_view>

#include "description/yaml/yaml_tree.h"
#include "import_ntrt/ntrt_structure.h"

namespace taut::import_ntrt {

using description::Entry;
using description::Value;
using description::ValuePtr;

/// Largest magnitude of numbers and positions, in the files' unit.
inline constexpr double kFarthest = 1e12;

struct Reading {
  const NtrtOptions& options;
  Model& model;
  Diagnostics& out;

  Structure& structure(int i) const { return model.structures[static_cast<std::size_t>(i)]; }
  Node& node(int i) const { return model.nodes[static_cast<std::size_t>(i)]; }
  Pair& pair(int i) const { return model.pairs[static_cast<std::size_t>(i)]; }
};

/// Reads a plain number as yaml-cpp does for NTRT; NaN after an error.
double ReadPlain(const Value& value, std::string_view what, Diagnostics& out);
/// Reads [x, y, z]; NaN after an error.
Vec3 ReadPoint(const Value& value, std::string_view what, Diagnostics& out);
/// Returns the entries of a map; none, and an error, if it is not a map. `value` may be null.
const std::vector<Entry>& MapOf(const Value* value, std::string_view what, Diagnostics& out);
/// Returns the items of a list, likewise.
const std::vector<ValuePtr>& ListOf(const Value* value, std::string_view what, Diagnostics& out);
/// Reports errors for keys that are not among these.
void OnlyKeys(const Value& map, const std::vector<std::string>& known, Diagnostics& out);

/// Returns the three words of "a/b/c".
std::vector<std::string> AtSlashes(const std::string& text);
/// Reads two texts, such as [bottom, top]; returns false after an error.
bool ReadTwo(const Value& value, std::string& a, std::string& b, Diagnostics& out);
/// Returns the node that `path` names from the structure on: leg.hip.top. -1 after an error at
/// `at`.
int NodeAt(const Reading& in, int structure, const std::string& path, const SourceRef& at);
void AddPair(const Reading& in, int structure, int from, int to, Words tags, const SourceRef& at);

/// Reads `builders:` of a file. Later ones precede earlier ones.
void ReadBuilders(const Reading& in, const Value* builders);
/// Adds NTRT's four builders for the tags rod, string, box and sphere.
void AddDefaultBuilders(Model& model);
/// Reads `bond_groups:` of a file.
void ReadBonds(const Reading& in, int structure, const Value* bonds);

}  // namespace taut::import_ntrt
