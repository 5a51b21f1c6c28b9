/// Header keys of all file formats: format version, kind, name, description, base file, parameters.
#pragma once

#include <string>

#include "description/yaml/keys.h"

namespace taut::description {

struct VersionForm {
  static constexpr const char* kSchema = R"("const": 1)";
};
struct FileForm {
  static constexpr const char* kSchema = R"("type": "string")";
};
/// Map of parameter names to numbers.
struct ParametersForm {
  static constexpr const char* kSchema =
      R"("type": "object", "additionalProperties": {"$ref": "#/$defs/number"}, )"
      R"("propertyNames": {"$ref": "#/$defs/identifier"})";
};

/// Header keys, which `ReadMergedFile` reads first. `Kind::kSchema`: schema of the key `kind` of
/// this format.
template <class Kind>
struct Head {
  Raw<VersionForm> taut;
  Raw<Kind> kind;
  Raw<FileForm> base;
  Raw<ParametersForm> parameters;
};

/// Descriptions of the header keys of one format. Examples are in JSON.
struct HeadTexts {
  const char *name_is, *description_is, *base_is, *base_example, *parameters_are,
      *parameters_example;
};

template <class Io, class Text>
void HeadKeys(Io& io, Text& t, const HeadTexts& texts) {
  if constexpr (!Io::kResolved) {
    io("taut", t.head.taut, "Format version.");
    io("kind", t.head.kind, "Kind of file.");
  }
  io("name", t.name, kNeeded, kName, texts.name_is);
  io("description", t.description, texts.description_is);
  if constexpr (!Io::kResolved) {
    io("base", t.head.base, texts.base_is, Example{texts.base_example});
    io("parameters", t.head.parameters, texts.parameters_are, Example{texts.parameters_example});
  }
}

}  // namespace taut::description
