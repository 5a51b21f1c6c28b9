/// Ground that consists of adjacent pieces, and bodies that cross their seams.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/physics/world.h"

namespace taut::seams {

enum class Piece { kBox, kField, kSolid, kSheet, kPlane };
inline constexpr Piece kPieces[] = {Piece::kBox, Piece::kField, Piece::kSolid, Piece::kSheet,
                                    Piece::kPlane};
inline const char* NameOf(Piece p) {
  constexpr const char* kNames[] = {"box", "field", "solid", "sheet", "plane"};
  return kNames[static_cast<int>(p)];
}

/// Plan view of a piece: [x0, x1] by [y0, y1], with its top at height(x) [m].
struct Patch {
  double x0, x1, y0, y1;
  int cells_x = 4, cells_y = 4;
  double height_m = 0, slope = 0;  ///< height_m + slope (x - x0)
  double depth_m = 1;              ///< Depth of boxes and solids below the lower end.
  double HeightAt(double x) const { return height_m + slope * (x - x0); }
};

inline TerrainMeshDef MeshOf(const Patch& p, bool solid, const Material& material) {
  TerrainMeshDef mesh;
  mesh.material = material;
  mesh.solid = solid;
  const int w = p.cells_x + 1, h = p.cells_y + 1;
  const auto x_of = [&](int i) {
    return i == p.cells_x ? p.x1 : p.x0 + i * (p.x1 - p.x0) / p.cells_x;
  };
  const auto y_of = [&](int j) {
    return j == p.cells_y ? p.y1 : p.y0 + j * (p.y1 - p.y0) / p.cells_y;
  };
  for (int j = 0; j < h; ++j) {
    for (int i = 0; i < w; ++i) mesh.corners_m.push_back({x_of(i), y_of(j), p.HeightAt(x_of(i))});
  }
  for (int j = 0; j + 1 < h; ++j) {
    for (int i = 0; i + 1 < w; ++i) {
      const int a = j * w + i, b = a + 1, c = a + w + 1, d = a + w;
      if ((i + j) % 2 == 0) {
        mesh.triangles.push_back({a, b, c}), mesh.triangles.push_back({a, c, d});
      } else {
        mesh.triangles.push_back({a, b, d}), mesh.triangles.push_back({b, c, d});
      }
    }
  }
  if (!solid) return mesh;
  std::vector<int> border;
  for (int i = 0; i + 1 < w; ++i) border.push_back(i);
  for (int j = 0; j + 1 < h; ++j) border.push_back(j * w + w - 1);
  for (int i = w - 1; i > 0; --i) border.push_back((h - 1) * w + i);
  for (int j = h - 1; j > 0; --j) border.push_back(j * w);
  const int below = static_cast<int>(mesh.corners_m.size()), n = static_cast<int>(border.size());
  const double bottom = std::min(p.HeightAt(p.x0), p.HeightAt(p.x1)) - p.depth_m;
  for (const int c : border) {
    Vec3 q = mesh.corners_m[static_cast<std::size_t>(c)];
    q.z = bottom;
    mesh.corners_m.push_back(q);
  }
  mesh.corners_m.push_back({0.5 * (p.x0 + p.x1), 0.5 * (p.y0 + p.y1), bottom});
  for (int k = 0; k < n; ++k) {
    const int a = border[static_cast<std::size_t>(k)];
    const int b = border[static_cast<std::size_t>((k + 1) % n)];
    const int c = below + k, d = below + (k + 1) % n;
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({b, c, d});
    mesh.triangles.push_back({c, below + n, d});
  }
  return mesh;
}

/// Returns a height field with square cells: cells_x counts along x, and the number along y
/// follows.
inline HeightFieldDef FieldOf(const Patch& p, const Material& material) {
  HeightFieldDef field;
  field.material = material;
  field.cell_m = (p.x1 - p.x0) / p.cells_x;
  field.columns = p.cells_x + 1;
  field.rows = static_cast<int>(std::lround((p.y1 - p.y0) / field.cell_m)) + 1;
  field.origin_m = {0.5 * (p.x0 + p.x1), 0.5 * (p.y0 + p.y1), 0};
  for (int j = 0; j < field.rows; ++j) {
    for (int i = 0; i < field.columns; ++i) {
      field.height_m.push_back(p.HeightAt(p.x0 + i * field.cell_m));
    }
  }
  return field;
}

inline void AddPiece(ModelDef& def, Piece kind, const Patch& p, const Material& material) {
  const std::string name =
      "piece_" + std::to_string(def.height_fields.size() + def.terrain_meshes.size() +
                                def.terrain_boxes.size() + def.planes.size());
  if (kind == Piece::kPlane) {
    def.planes.push_back({name, {0, 0, 1}, {0, 0, p.height_m}, material});
  } else if (kind == Piece::kField) {
    def.height_fields.push_back(FieldOf(p, material));
    def.height_fields.back().name = name;
  } else if (kind == Piece::kBox) {
    const double length = std::sqrt(1 + p.slope * p.slope);
    const Vec3 up{-p.slope / length, 0, 1 / length};
    const double angle = -std::atan(p.slope), half_x = 0.5 * (p.x1 - p.x0) * length;
    const Vec3 top{0.5 * (p.x0 + p.x1), 0.5 * (p.y0 + p.y1), p.HeightAt(0.5 * (p.x0 + p.x1))};
    def.terrain_boxes.push_back({name,
                                 top - 0.5 * p.depth_m * up,
                                 {std::cos(angle / 2), 0, std::sin(angle / 2), 0},
                                 {half_x, 0.5 * (p.y1 - p.y0), 0.5 * p.depth_m},
                                 material});
  } else {
    def.terrain_meshes.push_back(MeshOf(p, kind == Piece::kSolid, material));
    def.terrain_meshes.back().name = name;
  }
}

/// Rotates meshes and boxes about the z axis of W.
inline void TurnTerrain(ModelDef& def, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const auto turned = [&](const Vec3& p) {
    return Vec3{c * p.x - s * p.y, s * p.x + c * p.y, p.z};
  };
  for (TerrainMeshDef& mesh : def.terrain_meshes) {
    for (Vec3& p : mesh.corners_m) p = turned(p);
  }
  for (TerrainBoxDef& box : def.terrain_boxes) {
    box.center_m = turned(box.center_m);
    box.orientation = {std::cos(angle / 2), 0, 0, std::sin(angle / 2)};
  }
}

enum class Guest { kBox, kTurnedBox, kHull, kTurnedHull, kRodAlong, kRodAcross, kTurnedRod, kBall };
inline constexpr Guest kGuests[] = {Guest::kBox,        Guest::kTurnedBox, Guest::kHull,
                                    Guest::kTurnedHull, Guest::kRodAlong,  Guest::kRodAcross,
                                    Guest::kTurnedRod,  Guest::kBall};
inline const char* NameOf(Guest g) {
  constexpr const char* kNames[] = {"box",       "turned box", "hull",       "turned hull",
                                    "rod along", "rod across", "turned rod", "ball"};
  return kNames[static_cast<int>(g)];
}

inline constexpr double kHalfM = 0.1, kRadiusM = 0.03;
/// Returns the height of the body's center above level ground.
inline double RestHeight(Guest g) {
  return g == Guest::kRodAlong || g == Guest::kRodAcross || g == Guest::kTurnedRod ? kRadiusM
                                                                                   : kHalfM;
}

/// Adds a body of 1 kg and 0.2 m.
inline void AddGuest(ModelDef& def, Guest guest, const Vec3& at, const Vec3& velocity,
                     const Material& material) {
  const bool turned =
      guest == Guest::kTurnedBox || guest == Guest::kTurnedHull || guest == Guest::kTurnedRod;
  const double angle = turned ? 0.3 : 0.0;
  const int index = static_cast<int>(def.bodies.size());
  const std::string name = "guest_" + std::to_string(index);
  BodyDef body;
  body.name = name;
  body.mass_kg = 1;
  body.com_m = at;
  body.velocity_m_per_s = velocity;
  const double moment = guest == Guest::kBall ? 0.4 * kHalfM * kHalfM : kHalfM * kHalfM / 1.5;
  body.inertia_kg_m2.xx = body.inertia_kg_m2.yy = body.inertia_kg_m2.zz = moment;
  def.bodies.push_back(body);
  const Quat q{std::cos(angle / 2), 0, 0, std::sin(angle / 2)};
  const Vec3 x{std::cos(angle), std::sin(angle), 0}, y{-x.y, x.x, 0};
  if (guest == Guest::kBox || guest == Guest::kTurnedBox) {
    def.boxes.push_back({name, index, at, q, {kHalfM, kHalfM, kHalfM}, material});
  } else if (guest == Guest::kHull || guest == Guest::kTurnedHull) {
    HullDef hull;
    hull.name = name;
    hull.body = index;
    hull.material = material;
    for (int i = 0; i < 8; ++i) {
      const double a = i & 1 ? kHalfM : -kHalfM, b = i & 2 ? kHalfM : -kHalfM;
      hull.corners_m.push_back(at + a * x + b * y + Vec3{0, 0, i & 4 ? kHalfM : -kHalfM});
    }
    def.hulls.push_back(hull);
  } else if (guest == Guest::kBall) {
    def.spheres.push_back({name, index, at, kHalfM, material});
  } else {
    const Vec3 along = kHalfM * (guest == Guest::kRodAcross ? y : x);
    def.capsules.push_back({name, index, at - along, at + along, kRadiusM, material});
  }
}

}  // namespace taut::seams
