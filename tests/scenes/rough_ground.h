/// Uneven ground: height fields, and equivalent meshes.
#pragma once

#include <cmath>

#include "taut/model_def.h"
#include "tests/scenes/chance.h"

namespace taut::scenes {

/// Returns a height field with heights from a function of x and y [m], relative to its center.
template <class Height>
HeightFieldDef Field(int columns, int rows, double cell_m, const Material& material,
                     const Height& height) {
  HeightFieldDef field;
  field.name = "field";
  field.columns = columns;
  field.rows = rows;
  field.cell_m = cell_m;
  field.material = material;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      field.height_m.push_back(
          height((i - 0.5 * (columns - 1)) * cell_m, (j - 0.5 * (rows - 1)) * cell_m));
    }
  }
  return field;
}

/// Returns NTRT's hills: 0.02 sin(i) cos(j) m high, with corners every 4 cm.
inline HeightFieldDef Hills(int columns, int rows, const Material& material,
                            double height_m = 0.02) {
  constexpr double kCell_m = 0.04;
  return Field(columns, rows, kCell_m, material, [=](double x, double y) {
    return height_m * std::sin(x / kCell_m) * std::cos(y / kCell_m);
  });
}

/// Returns a field as an open mesh. `seed`: cells are split along random diagonals; 0: along the
/// field's diagonals.
inline TerrainMeshDef MeshOf(const HeightFieldDef& field, std::uint64_t seed = 0) {
  TerrainMeshDef mesh;
  mesh.name = "mesh";
  mesh.material = field.material;
  mesh.solid = false;
  Chance chance(seed);
  for (int j = 0; j < field.rows; ++j) {
    for (int i = 0; i < field.columns; ++i) {
      mesh.corners_m.push_back(
          Vec3{field.origin_m.x + (i - 0.5 * (field.columns - 1)) * field.cell_m,
               field.origin_m.y + (j - 0.5 * (field.rows - 1)) * field.cell_m,
               field.origin_m.z + field.height_m[mesh.corners_m.size()]});
    }
  }
  for (int j = 0; j + 1 < field.rows; ++j) {
    for (int i = 0; i + 1 < field.columns; ++i) {
      const int a = j * field.columns + i, b = a + 1, d = a + field.columns, c = d + 1;
      const bool rising = seed == 0 ? (i + j) % 2 == 0 : chance.Within(0.0, 1.0) < 0.5;
      if (rising) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      } else {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({b, c, d});
      }
    }
  }
  return mesh;
}

}  // namespace taut::scenes
