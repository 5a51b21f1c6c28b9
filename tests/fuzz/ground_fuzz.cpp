// Fuzz target of terrain files in OBJ, STL or CSV heights: ground on which a rod falls, or errors.
#include "description/assets/mesh_file.h"
#include "fuzz/on_ground.h"

/// The first byte encodes the format of the rest (0 OBJ, 1 STL, 2 CSV), and whether meshes are
/// closed.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const taut::fuzz::Folder folder;
  constexpr int kSteps = 20;
  if (size == 0) return 0;
  const int kind = data[0] % 3;
  const bool solid = data[0] / 3 % 2 == 0;
  const char* const names[] = {"ground.obj", "ground.stl", "ground.csv"};
  const std::string path = folder.Write(names[kind], data + 1, size - 1);
  taut::Diagnostics out;
  taut::ModelDef def;
  if (kind < 2) {
    auto mesh = taut::description::ReadMeshFile(path, out);
    taut::fuzz::CheckReading(mesh.has_value(), out);
    if (!mesh) return 0;
    def.terrain_meshes.push_back({"mesh", mesh->corners, mesh->triangles, solid, {}});
  } else {
    const auto read = taut::fuzz::ReadTerrain(
        folder, "{name: g, height_field: {file: ground.csv, cell_m: 0.1}}", out);
    if (!read) return 0;
    def = taut::fuzz::HeightsOf(*read);
  }
  taut::fuzz::DropARod(std::move(def), kSteps);
  return 0;
}
