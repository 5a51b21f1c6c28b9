/// Channels of a trace as nested JSON messages, with one level per part of their names.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "taut/trace.h"

namespace taut::exporting {

class MessageTree {
 public:
  /// Adds a channel. `path`: part of its name that is not consumed yet.
  void Add(std::string_view path, std::size_t channel);

  /// Writes a row as JSON. Omits values that are not finite, which JSON cannot represent.
  void Write(const Trace& trace, std::size_t row, std::string& json) const;
  /// Returns the JSON schema of the messages, with units.
  std::string Schema(const Trace& trace) const;

 private:
  struct Field;
  std::vector<Field> fields_;
};

struct MessageTree::Field {
  std::string name;
  std::string key;  ///< JSON text of the key, including the colon.
  std::size_t channel = 0;
  std::unique_ptr<MessageTree> inner;  ///< Tree of the inner keys; null for a channel.
};

/// Writes a number with the fewest digits from which the same number is read back.
void PutNumber(std::string& json, double x);

}  // namespace taut::exporting
