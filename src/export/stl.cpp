// Writer of binary STL, little-endian: 80 bytes of text, then the number of triangles. Each
// triangle has its normal and three corners in single precision, and two zero bytes.
#include <bit>
#include <cmath>
#include <cstdint>

#include "export/little_endian.h"
#include "math/vec.h"
#include "taut/shape_mesh.h"
#include "taut/version.h"

namespace taut {
namespace {

constexpr std::size_t kHeadBytes = 80;

void Put(std::string& file, const Vec3& v) {
  for (const double x : {v.x, v.y, v.z}) exporting::PutFloat(file, static_cast<float>(x));
}

}  // namespace

std::string StlOf(const ModelDef& def, const std::vector<ShapeMesh>& shapes, double scale) {
  // The header must not begin with "solid", which marks text files.
  std::string file = std::string("taut ") + kVersion + ": " + def.name;
  file.resize(kHeadBytes, ' ');
  std::uint32_t count = 0;
  for (const ShapeMesh& mesh : shapes) count += static_cast<std::uint32_t>(mesh.triangles.size());
  exporting::PutWord(file, count);
  for (const ShapeMesh& mesh : shapes) {
    for (const auto& [a, b, c] : mesh.triangles) {
      const auto at = [&](int corner) { return mesh.corners_m[static_cast<std::size_t>(corner)]; };
      const Vec3 n = Cross(at(b) - at(a), at(c) - at(a));
      Put(file, (1 / std::sqrt(Dot(n, n))) * n);
      for (const int corner : {a, b, c}) Put(file, scale * at(corner));
      file.append(2, '\0');
    }
  }
  return file;
}

}  // namespace taut
