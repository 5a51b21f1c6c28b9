/// YAML file as a tree with source positions. Stricter than yaml-cpp: duplicate keys, tags and
/// several documents are errors. Aliases are resolved, merge keys (`<<: *anchor`) are merged.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "taut/diagnostics.h"

namespace taut::description {

inline constexpr std::size_t kMaxFileBytes = 10'000'000;
inline constexpr std::size_t kMaxYamlNodes = 200'000;  ///< An alias counts with all nodes below it.
inline constexpr int kMaxYamlDepth = 64;

struct Value;
using ValuePtr = std::shared_ptr<const Value>;

struct Entry {
  std::string key;
  SourceRef key_at;
  ValuePtr value;
};

/// Scalar, sequence or map. Immutable once read; aliases share it.
struct Value {
  enum class Kind { kNull, kScalar, kSequence, kMap };
  Kind kind = Kind::kNull;
  SourceRef at;
  std::string text;             ///< Of a scalar.
  bool quoted = false;          ///< Of a scalar.
  std::vector<ValuePtr> items;  ///< Of a sequence.
  std::vector<Entry> entries;   ///< Of a map, in order; merged ones last.
  std::size_t node_count = 1;   ///< This value and all below it.

  /// Returns the value of a key, or null.
  const Value* Find(std::string_view key) const;
};

/// Returns "a map", "a list", "a text" ..., for messages about a wrong type.
std::string_view KindName(const Value& value);

/// Parses a text. Returns null and adds diagnostics if the formats do not allow it. `file` is the
/// name in messages.
ValuePtr ParseYaml(const std::string& text, const std::string& file, Diagnostics& out);

/// Reads and parses a file of at most `kMaxFileBytes`. Returns null and adds diagnostics on error.
ValuePtr ReadYaml(const std::string& path, Diagnostics& out);

}  // namespace taut::description
