/// What the readers of the parts of a file share.
#pragma once

#include <string>
#include <string_view>

#include "description/yaml/yaml_tree.h"
#include "import_ntrt/structure.h"

namespace taut::import_ntrt {

using description::Entry;
using description::Value;
using description::ValuePtr;

struct Reading {
  const NtrtOptions& options;
  Model& model;
  Diagnostics& out;

  Structure& structure(int i) const { return model.structures[static_cast<std::size_t>(i)]; }
  Node& node(int i) const { return model.nodes[static_cast<std::size_t>(i)]; }
  Pair& pair(int i) const { return model.pairs[static_cast<std::size_t>(i)]; }
};

/// A plain number, as yaml-cpp reads it for NTRT; NaN after a complaint.
double ReadPlain(const Value& value, std::string_view what, Diagnostics& out);
/// [x, y, z]; NaN after a complaint.
Vec3 ReadPoint(const Value& value, std::string_view what, Diagnostics& out);
/// The entries of a map, none of nothing; a complaint if it is something else. May be null.
const std::vector<Entry>& MapOf(const Value* value, std::string_view what, Diagnostics& out);
/// The items of a list, likewise.
const std::vector<ValuePtr>& ListOf(const Value* value, std::string_view what, Diagnostics& out);
/// Complains about keys that are not among these.
void OnlyKeys(const Value& map, const std::vector<std::string>& known, Diagnostics& out);

/// "a/b/c" as its three words.
std::vector<std::string> AtSlashes(const std::string& text);
/// Two texts, such as [bottom, top]; false after a complaint.
bool ReadTwo(const Value& value, std::string& a, std::string& b, Diagnostics& out);
/// The node that `path` names from the structure on: leg.hip.top. -1 after a complaint at `at`.
int NodeAt(const Reading& in, int structure, const std::string& path, const SourceRef& at);
void AddPair(const Reading& in, int structure, int from, int to, Words tags, const SourceRef& at);

/// `builders:` of a file. Later ones go before earlier ones.
void ReadBuilders(const Reading& in, const Value* builders);
/// The four that NTRT has for the tags rod, string, box and sphere.
void AddDefaultBuilders(Model& model);
/// `bond_groups:` of a file.
void ReadBonds(const Reading& in, int structure, const Value* bonds);

}  // namespace taut::import_ntrt
