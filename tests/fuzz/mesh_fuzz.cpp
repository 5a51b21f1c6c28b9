// Fuzz target of triangles from OBJ and STL files as ground and as convex solids.
//
// Input: byte 0 is the kind of file (OBJ, STL, triangles), byte 1 its use (closed ground, sheet,
// convex solid with a density, with a mass). The rest is the file, or: byte 2 the number of copies,
// byte 3 the difference between copies, then triangles of nine floats each, which become a binary
// STL. For one input in 16, there are up to 64 copies instead of 4, and a rod falls onto the mesh.
#include <cmath>

#include "description/assets/mesh_file.h"
#include "fuzz/on_ground.h"
#include "fuzz/text_mutator.h"
#include "fuzz/triangle_mutator.h"

namespace {

using taut::fuzz::Folder;
using taut::fuzz::Must;
using taut::fuzz::Triangle;

constexpr std::size_t kHead = 4;
constexpr int kKinds = 3, kUses = 4, kTriangles = 2;

void Append(std::string& file, const void* data, std::size_t size) {
  file.append(static_cast<const char*>(data), size);
}

/// Returns one copy of a corner: in place, shifted, nearly in place, scaled, rotated.
taut::fuzz::Corner Copied(taut::fuzz::Corner corner, int copy, int how) {
  const auto k = static_cast<float>(copy);
  if (how == 1) corner[0] += k;
  if (how == 2) corner[2] += 1e-7F * k;
  if (how == 3) {
    for (float& x : corner) x *= std::exp2(0.5F * k);
  }
  if (how == 4) {
    const float c = std::cos(0.1F * k), s = std::sin(0.1F * k);
    corner = {c * corner[0] - s * corner[1], s * corner[0] + c * corner[1], corner[2]};
  }
  return corner;
}

std::string BinaryStl(const std::vector<Triangle>& triangles, int copies, int how) {
  std::string file(80, ' ');
  const auto count =
      static_cast<std::uint32_t>(triangles.size() * static_cast<std::size_t>(copies));
  Append(file, &count, sizeof count);
  const float normal[3] = {0, 0, 1};
  for (int copy = 0; copy < copies; ++copy) {
    for (const Triangle& triangle : triangles) {
      Append(file, normal, sizeof normal);
      for (const auto& corner : triangle) {
        const auto copied = Copied(corner, copy, how);
        Append(file, copied.data(), sizeof copied);
      }
      file.append(2, '\0');
    }
  }
  return file;
}

void CheckConvex(const Folder& folder, const std::string& name, bool has_mass, bool drops) {
  const std::string text =
      "taut: 1\nkind: model\nname: m\nnodes: {a: [0, 0, 1]}\nbuilders: [{match: a, convex: "
      "{file: " +
      name + ", scale_m: 0.1, " + (has_mass ? "mass_kg: 1" : "density_kg_per_m3: 800") + "}}]\n";
  const std::string path = folder.Write("model.yaml", text.data(), text.size());
  taut::Diagnostics out;
  const auto robot = taut::LoadRobot(path, {}, out);
  taut::fuzz::CheckReading(robot.has_value(), out);
  if (!robot) return;
  taut::fuzz::CheckRobot(*robot);
  if (!drops) return;
  taut::ModelDef def = robot->def;
  def.planes.push_back({"floor", {0, 0, 1}, {0, 0, 0}, {}});
  taut::fuzz::DropARod(std::move(def), 5);
}

/// Checks the reader and the model check of ground.
void CheckSurface(const std::string& path, bool closed) {
  taut::Diagnostics out, refused;
  auto mesh = taut::description::ReadMeshFile(path, out);
  taut::fuzz::CheckReading(mesh.has_value(), out);
  if (!mesh) return;
  const bool good = taut::description::ReportFaults(*mesh, closed, path, {"the mesh", ""}, out);
  taut::fuzz::CheckReading(good, out);
  if (!good) return;
  taut::ModelDef def;
  def.terrain_meshes.push_back({"mesh", mesh->corners, mesh->triangles, closed, {}});
  Must((taut::Model::Compile(def, refused) != nullptr) == refused.ok(), "compiled or refused");
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  if (size < kHead || seed % 8 == 0) return LLVMFuzzerMutate(data, size, max_size);
  if (data[0] % kKinds != kTriangles) {
    return 2 + taut::fuzz::MutateText(data + 2, size - 2, max_size - 2, seed / 8);
  }
  auto triangles = taut::fuzz::TrianglesIn(data + kHead, size - kHead);
  taut::fuzz::TriangleMutator mutator(seed);
  for (unsigned i = 0; i <= seed / 8 % 4; ++i) mutator.Mutate(triangles);
  const std::size_t kept = std::min(triangles.size(), (max_size - kHead) / sizeof(Triangle));
  if (kept > 0) std::memcpy(data + kHead, triangles.data(), kept * sizeof(Triangle));
  return kHead + kept * sizeof(Triangle);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  if (size < kHead) return 0;
  const int kind = data[0] % kKinds, use = data[1] % kUses;
  const bool whole = taut::fuzz::OneIn(16, data, size);
  std::string file(reinterpret_cast<const char*>(data + 2), size - 2);
  if (kind == kTriangles) {
    file = BinaryStl(taut::fuzz::TrianglesIn(data + kHead, size - kHead),
                     1 + data[2] % (whole ? 64 : 4), data[3] % 5);
  }
  const std::string name = kind == 0 ? "mesh.obj" : "mesh.stl";
  const std::string path = folder.Write(name, file.data(), file.size());
  if (use >= 2) {
    CheckConvex(folder, name, use == 3, whole);
    return 0;
  }
  taut::Diagnostics out;
  if (!whole) {
    CheckSurface(path, use == 0);
    return 0;
  }
  const auto read = taut::fuzz::ReadTerrain(
      folder,
      "{name: g, mesh: {file: " + name +
          ", scale_m: 1, solid: " + (use == 0 ? "closed" : "surface") + "}}",
      out);
  if (!read) return 0;
  taut::ModelDef def;
  def.terrain_meshes = read->robot.def.terrain_meshes;
  taut::fuzz::DropARod(std::move(def), 5);
  return 0;
}
