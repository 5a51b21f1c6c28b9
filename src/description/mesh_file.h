/// Triangles from files that other programs write.
#pragma once

#include <array>
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
};

/// Wavefront OBJ (`v` and `f`; faces of more corners become fans) or STL, text or binary, by the
/// name's end. Nothing and complaints, with lines where there are some, if it is none.
std::optional<MeshFile> ReadMeshFile(const std::string& path, Diagnostics& out);

/// Whether a file is of a kind, in small or capital letters: ".obj".
bool EndsIn(const std::string& path, std::string_view end);

}  // namespace taut::description
