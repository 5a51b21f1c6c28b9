/// Triangles from files that other programs write.
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
  std::vector<Vec3> corners;  ///< In the file's unit; no two are the same.
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> lines;  ///< Of the triangles; none of a binary file.
  /// Where its parts begin: groups and objects of an OBJ, solids of an STL, those with triangles.
  struct Part {
    std::string name;  ///< As written; may be empty.
    std::size_t first_triangle = 0;
  };
  std::vector<Part> parts;

  /// Names the triangles that follow.
  void BeginPart(std::string_view name) {
    if (!parts.empty() && parts.back().first_triangle == triangles.size()) parts.pop_back();
    parts.push_back({std::string(name), triangles.size()});
  }
};

/// Wavefront OBJ (`v` and `f`; faces of more corners become fans) or STL, text or binary, by the
/// name's end. Nothing and complaints, with lines where there are some, if it is none.
std::optional<MeshFile> ReadMeshFile(const std::string& path, Diagnostics& out);

/// The triangles of a part with their corners; no parts.
MeshFile PartOf(const MeshFile& mesh, std::size_t part);

/// What complaints about a mesh call it, and what else, after "close it", may be done about holes.
struct MeshWords {
  std::string what, or_else;
};
/// Complains about triangles of a file, at their lines where there are some. False if there was
/// something.
bool ReportFaults(const MeshFile& mesh, bool closed, const std::string& path,
                  const MeshWords& words, Diagnostics& out);

/// Whether a file is of a kind, in small or capital letters: ".obj".
bool EndsIn(const std::string& path, std::string_view end);

}  // namespace taut::description
