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
  /// `path`: remaining part of the name of channel `channel`.
  void Add(std::string_view path, std::size_t channel);

  /// Writes a row; values that are not finite, which JSON cannot represent, are left out.
  void Write(const Trace& trace, std::size_t row, std::string& json) const;
  /// Returns the JSON schema of all possible content, with units.
  std::string Schema(const Trace& trace) const;

 private:
  struct Field;
  std::vector<Field> fields_;
};

struct MessageTree::Field {
  std::string name;
  std::string key;  ///< As JSON, with the colon.
  std::size_t channel = 0;
  std::unique_ptr<MessageTree> inner;  ///< Null: a channel.
};

/// Writes the shortest digits that read back as the same number.
void PutNumber(std::string& json, double x);

}  // namespace taut::exporting
