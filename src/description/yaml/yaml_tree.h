/// Parser of YAML files to a tree with source positions. It rejects duplicate keys, tags and
/// multiple documents. It resolves aliases and merge keys (`<<: *anchor`).
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "taut/diagnostics.h"

namespace taut::description {

inline constexpr std::size_t kMaxFileBytes = 10'000'000;
inline constexpr std::size_t kMaxYamlNodes = 1'000'000;  ///< An alias counts as many nodes as its
                                                         ///< target.
inline constexpr int kMaxYamlDepth = 64;

struct Value;
using ValuePtr = std::shared_ptr<const Value>;

struct Entry {
  std::string key;
  SourceRef key_at;
  ValuePtr value;
};

/// Scalar, sequence or map. Immutable after parsing; aliases share it.
struct Value {
  enum class Kind { kNull, kScalar, kSequence, kMap };
  Kind kind = Kind::kNull;
  SourceRef at;
  std::string text;             ///< Text of a scalar.
  bool quoted = false;          ///< Whether a scalar is quoted.
  std::vector<ValuePtr> items;  ///< Items of a sequence.
  std::vector<Entry> entries;   ///< Entries of a map, in order; merged entries last.
  std::size_t node_count = 1;   ///< Number of nodes, this one and its descendants.

  /// Returns the value of a key; null if absent.
  const Value* Find(std::string_view key) const;
};

/// Returns "a map", "a list" or "a text", for messages about a wrong type.
std::string_view KindName(const Value& value);

/// Parses a text. Returns null and adds diagnostics if it is invalid. `file`: name in messages.
ValuePtr ParseYaml(const std::string& text, const std::string& file, Diagnostics& out);

/// Reads and parses a file of at most `kMaxFileBytes`. Returns null and adds diagnostics after an
/// error.
ValuePtr ReadYaml(const std::string& path, Diagnostics& out);

}  // namespace taut::description
