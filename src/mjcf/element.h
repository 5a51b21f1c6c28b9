/// An XML file as a tree, what it includes put in its place.
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
  /// Its name if it has one, for complaints: `geom "foot"`.
  std::string Called() const {
    const Attribute* const its = Find("name");
    return its ? name + " \"" + its->value + "\"" : name;
  }
};

/// The file's root element. `files` becomes all that was read, the file itself first. Nothing, and
/// a complaint, if one of them is no XML.
std::optional<Element> ReadXml(const std::string& path, std::vector<std::string>& files,
                               Diagnostics& out);

}  // namespace taut::mjcf
