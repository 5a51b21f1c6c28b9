// Fuzz target of terrain files in OBJ, STL or CSV heights: ground on which a rod falls, or errors.
#include "description/assets/height_csv.h"
#include "description/assets/mesh_file.h"
#include "fuzz/on_ground.h"

/// The first byte encodes the format of the rest (0 OBJ, 1 STL, 2 CSV), and whether meshes are
/// closed. For one input in 16, a rod falls onto the ground.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const taut::fuzz::Folder folder;
  constexpr int kSteps = 20;
  if (size == 0) return 0;
  const int kind = data[0] % 3;
  const bool solid = data[0] / 3 % 2 == 0;
  const char* const names[] = {"ground.obj", "ground.stl", "ground.csv"};
  const std::string path = folder.Write(names[kind], data + 1, size - 1);
  const bool drops = taut::fuzz::OneIn(16, data, size);
  taut::Diagnostics out;
  taut::ModelDef def;
  if (kind < 2) {
    auto mesh = taut::description::ReadMeshFile(path, out);
    taut::fuzz::CheckReading(mesh.has_value(), out);
    if (!mesh) return 0;
    def.terrain_meshes.push_back({"mesh", mesh->corners, mesh->triangles, solid, {}});
  } else if (!drops) {
    taut::trace::TableBudget budget(1e8);
    const auto table = taut::description::ReadHeightCsv(path, budget, out);
    taut::fuzz::CheckReading(table.has_value(), out);
    if (!table) return 0;
    taut::HeightFieldDef& field = def.height_fields.emplace_back();
    field.columns = table->columns, field.rows = table->rows;
    field.cell_m = 0.1;
    field.height_m = table->height_m;
  } else {
    const auto read = taut::fuzz::ReadTerrain(
        folder, "{name: g, height_field: {file: ground.csv, cell_m: 0.1}}", out);
    if (!read) return 0;
    def = taut::fuzz::HeightsOf(*read);
  }
  if (drops) {
    taut::fuzz::DropARod(std::move(def), kSteps);
    return 0;
  }
  taut::Diagnostics refused;
  taut::fuzz::Must((taut::Model::Compile(def, refused) != nullptr) == refused.ok(),
                   "compiled or refused");
  return 0;
}
