/// Reader of the JSON values of a mapping file, with error messages.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut {

/// Reads values of a mapping; each error names the file and the place in it, such as
/// "channels[2].from".
class MappingJson {
 public:
  using Json = nlohmann::ordered_json;

  MappingJson(const std::string& path, Diagnostics& out) : path_(path), out_(out) {}

  /// Parses a text, which may have comments (// and /* */). Duplicate keys, which JSON allows, are
  /// an error here.
  Json Parse(const std::string& text);

  void Error(MessageId id, const std::string& at, const std::string& what, std::string hint = {});
  /// Whether no error was found yet.
  bool good() const { return good_; }

  bool IsObject(const Json& json, const std::string& at, const std::vector<std::string>& keys);
  /// Returns the string of a key that must exist.
  std::string Text(const Json& object, const char* key, const std::string& at);
  double Number(const Json& object, const char* key, const std::string& at, double otherwise);
  /// Returns the factor from the unit `name` to the SI unit `wanted`; 1 after an error.
  double UnitIn(const std::string& name, const std::string& wanted, const std::string& at);

 private:
  const std::string& path_;
  Diagnostics& out_;
  bool good_ = true;
};

}  // namespace taut
