/// A YAML file as a tree with places. What yaml-cpp is lenient about is an error here: duplicate
/// keys, tags, several documents. Aliases are resolved, merge keys (`<<: *anchor`) are merged.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "taut/diagnostics.h"

namespace taut::description {

inline constexpr std::size_t kMaxFileBytes = 10'000'000;
inline constexpr std::size_t kMaxYamlNodes = 200'000;  ///< An alias counts as what it stands for.
inline constexpr int kMaxYamlDepth = 64;

struct Value;
using ValuePtr = std::shared_ptr<const Value>;

struct Entry {
  std::string key;
  SourceRef key_at;
  ValuePtr value;
};

/// A scalar, a sequence or a map. Immutable once read; aliases share it.
struct Value {
  enum class Kind { kNull, kScalar, kSequence, kMap };
  Kind kind = Kind::kNull;
  SourceRef at;
  std::string text;             ///< Of a scalar.
  bool quoted = false;          ///< Of a scalar.
  std::vector<ValuePtr> items;  ///< Of a sequence.
  std::vector<Entry> entries;   ///< Of a map, in order; merged ones last.
  std::size_t node_count = 1;   ///< Itself and all below it.

  /// The value of a key, or null.
  const Value* Find(std::string_view key) const;
};

/// "a map", "a list", "a text" ...: for messages about a wrong type.
std::string_view KindName(const Value& value);

/// Null and diagnostics if the text is not what the formats allow. `file` is for the messages.
ValuePtr ParseYaml(const std::string& text, const std::string& file, Diagnostics& out);

/// The same for a file. Never reads more than `kMaxFileBytes`.
ValuePtr ReadYaml(const std::string& path, Diagnostics& out);

}  // namespace taut::description
