/// Triangle meshes from OBJ and STL files.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "taut/diagnostics.h"
#include "taut/types.h"

namespace taut::description {

struct MeshFile {
  std::vector<Vec3> corners;  ///< Without duplicates, in the file's unit of length.
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> lines;  ///< Line number of each triangle; empty for a binary file.
  /// Group or object of an OBJ file, or solid of an STL file, with at least one triangle.
  struct Part {
    std::string name;  ///< Name in the file; may be empty.
    std::size_t first_triangle = 0;
  };
  std::vector<Part> parts;

  /// Begins a part, to which all triangles added later belong.
  void BeginPart(std::string_view name) {
    if (!parts.empty() && parts.back().first_triangle == triangles.size()) parts.pop_back();
    parts.push_back({std::string(name), triangles.size()});
  }
};

/// Reads a Wavefront OBJ file (`v` and `f`) or an STL file (text or binary), by its extension.
/// Splits faces with more than three corners into triangle fans. Returns nothing after an error;
/// errors in text files contain line numbers.
std::optional<MeshFile> ReadMeshFile(const std::string& path, Diagnostics& out);

/// Returns the triangles and corners of one part; `parts` of the result is empty.
MeshFile PartOf(const MeshFile& mesh, std::size_t part);

/// Words of messages: name of the mesh, and a remedy for holes in addition to "close it".
struct MeshWords {
  std::string what, or_else;
};
/// Reports faulty triangles, with line numbers for text files. Returns false if there are any.
bool ReportFaults(const MeshFile& mesh, bool closed, const std::string& path,
                  const MeshWords& words, Diagnostics& out);

/// Returns whether a path has the extension `end` (".obj"), in lower or upper case.
bool EndsIn(const std::string& path, std::string_view end);

}  // namespace taut::description
