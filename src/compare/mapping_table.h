/// The key `table` of a mapping file (docs/formats/mapping.md).
#pragma once

#include "compare/mapping_json.h"
#include "taut/trace.h"

namespace taut {

/// Reads the layout of a table; errors go to `values`.
TableLayout ReadTableLayout(const MappingJson::Json& json, MappingJson& values);

}  // namespace taut
