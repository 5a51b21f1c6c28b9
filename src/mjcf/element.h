/// XML file as a tree of elements, with the contents of included files inserted.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "taut/diagnostics.h"

namespace taut::mjcf {

struct Attribute {
  std::string name, value;
  SourceRef at;
};

struct Element {
  std::string name;
  SourceRef at;
  std::vector<Attribute> attributes;
  std::vector<Element> children;

  const Attribute* Find(std::string_view attribute) const {
    for (const Attribute& a : attributes) {
      if (a.name == attribute) return &a;
    }
    return nullptr;
  }
  /// Returns the element and its name, if it has one, for messages: `geom "foot"`.
  std::string Called() const {
    const Attribute* const its = Find("name");
    return its ? name + " \"" + its->value + "\"" : name;
  }
};

/// Returns the file's root element. `files`: set to all files read, the main file first. Returns
/// nothing and reports an error if one of them is not valid XML.
std::optional<Element> ReadXml(const std::string& path, std::vector<std::string>& files,
                               Diagnostics& out);

}  // namespace taut::mjcf
