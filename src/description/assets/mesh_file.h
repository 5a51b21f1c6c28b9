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
  std::vector<Vec3> corners;  ///< In the file's unit; no duplicates.
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> lines;  ///< Of the triangles; empty for a binary file.
  /// Part of a file: group or object of an OBJ, solid of an STL, each with at least one triangle.
  struct Part {
    std::string name;  ///< As written; may be empty.
    std::size_t first_triangle = 0;
  };
  std::vector<Part> parts;

  /// Begins a part for the triangles that follow.
  void BeginPart(std::string_view name) {
    if (!parts.empty() && parts.back().first_triangle == triangles.size()) parts.pop_back();
    parts.push_back({std::string(name), triangles.size()});
  }
};

/// Reads a Wavefront OBJ (`v` and `f`; faces with more corners become fans) or an STL, text or
/// binary; the extension of the name selects the format. Returns nothing after an error and reports
/// it, with lines for text files.
std::optional<MeshFile> ReadMeshFile(const std::string& path, Diagnostics& out);

/// Returns the triangles of a part with their corners; `parts` is empty.
MeshFile PartOf(const MeshFile& mesh, std::size_t part);

/// Texts for messages: name of the mesh, and an alternative to "close it" for holes.
struct MeshWords {
  std::string what, or_else;
};
/// Reports faulty triangles, with their lines for text files. Returns false if there are any.
bool ReportFaults(const MeshFile& mesh, bool closed, const std::string& path,
                  const MeshWords& words, Diagnostics& out);

/// Returns whether a path ends in `end` (".obj"), in lower or upper case.
bool EndsIn(const std::string& path, std::string_view end);

}  // namespace taut::description
