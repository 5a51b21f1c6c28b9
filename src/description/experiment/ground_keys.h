/// Ground that is not flat, in an experiment's terrain: height fields and meshes.
#pragma once

#include <optional>
#include <string>

#include "description/model/surface_keys.h"
#include "description/yaml/keys.h"
#include "taut/model_def.h"

namespace taut::description {

/// An expression with more names than numbers have.
struct FormulaForm {
  static constexpr const char* kSchema =
      R"("$ref": "#/$defs/number", "title": "formula", "unit": "m")";
};
struct HeightFieldText : HeightFieldDef {
  SourceRef at;
  Placed file;
  std::optional<std::pair<double, double>> height_range_m;
  Raw<FormulaForm> formula;
  SurfaceText surface;
};
/// `place` of a mesh.
struct MeshPlaceText {
  Vec3 at_m;
  Quat rotate;
};
struct TerrainMeshText : TerrainMeshDef {
  SourceRef at;
  Placed file;
  double scale_m = 1.0;
  MeshPlaceText place;
  SurfaceText surface;
};

inline const Choices<HeightFieldDef::Split> kSplits{
    {"alternating", HeightFieldDef::Split::kAlternating},
    {"same", HeightFieldDef::Split::kSame},
    {"shortest", HeightFieldDef::Split::kShortest}};
inline const Choices<bool> kMeshKinds{{"closed", true}, {"surface", false}};

/// More would take gigabytes.
inline constexpr Bound kCorners{.least = 2, .most = 100'000};

template <class Io, Either<HeightFieldDef, HeightFieldText> Field>
void Keys(Io& io, Field& f) {
  io.Map(
      "height_field", "terrain.height_field",
      "Ground above a rectangle, solid below: heights at the corners of square cells, each of "
      "which is two triangles. Outside of the rectangle there is nothing.",
      R"json({"columns": 240, "rows": 240, "cell_m": 0.04, "height_m": "0.02 * sin(i) * cos(j)"})json");
  io("name", f.name, kResolvedOnly);
  if constexpr (Io::kResolved) {
    io("columns", f.columns);
    io("rows", f.rows);
  } else {
    io.OneOf({"file", "height_m"});
    io("file", f.file,
       "Heights, from the experiment's folder. CSV: in m, a line for each row of corners, that of "
       "the least y first, x rising along the line; lines that begin with # are skipped. PNG: "
       "gray, "
       "best with 16 bits, with `height_range_m`; as on a map, x rises to the right and y upwards. "
       "HDF5: `hills.h5:/z`, the data set z, in m, its rows as those of CSV.");
    io("height_range_m", f.height_range_m, "Of an image: the heights of black and of white.");
    io("columns", f.columns, kCorners, kInherited, "Corners along x. Goes with a formula.");
    io("rows", f.rows, kCorners, kInherited, "Corners along y. Goes with a formula.");
  }
  io("cell_m", f.cell_m, kNeeded, Bound::kPositive, "Side of a cell.");
  io("origin_m", f.origin_m, "Middle of the rectangle; its z is added to all heights.");
  if constexpr (Io::kResolved) {
    io("height_m", f.height_m);
  } else {
    io("height_m", f.formula,
       "A formula: heights by `x_m` and `y_m`, counted from the middle, or by `i` and `j`, counted "
       "from 0 at the corner of least x and y; `noise(seed, x, y)` is smooth, between -1 and 1, "
       "and "
       "has another value at each whole x and y.");
  }
  io("split", f.split, kSplits,
     "Along which diagonal a cell is split: by turns, always from its corner of least x and y, or "
     "that whose ends differ less in height.");
  if constexpr (Io::kResolved) {
    io("material", f.material);
  } else {
    SurfaceKeys(io, f.surface);
  }
}
void Check(const MapReader& map, HeightFieldText& field);

template <class Io>
void Keys(Io& io, Like<MeshPlaceText> auto& p) {
  io.Map("place", "terrain.mesh.place", "Where a mesh is: turned by `rotate`, then moved.");
  io("at_m", p.at_m, "Where the file's origin goes.");
  io("rotate", p.rotate, "Turns the mesh about the file's origin.");
}

template <class Io, Either<TerrainMeshDef, TerrainMeshText> Mesh>
void Keys(Io& io, Mesh& m) {
  io.Map("mesh", "terrain.mesh", "Ground of triangles from a file.",
         R"({"file": "rock.obj", "scale_m": 0.001})");
  io("name", m.name, kResolvedOnly);
  if constexpr (Io::kResolved) {
    Packed corners{m.corners_m};
    Packed triangles{m.triangles};
    io("corners_m", corners);
    io("triangles", triangles);
  } else {
    io("file", m.file, kNeeded,
       "Wavefront OBJ or STL, text or binary, from the experiment's folder. Corners run "
       "counter-clockwise seen from outside.");
    io("scale_m", m.scale_m, kNeeded, Bound::kPositive,
       "What 1 in the file is: 0.001 if it is in mm. Neither format says.");
    io("place", m.place);
  }
  io("solid", m.solid, kMeshKinds,
     "Whether the mesh encloses a solid, or is a thin sheet with two sides.");
  if constexpr (Io::kResolved) {
    io("material", m.material);
  } else {
    SurfaceKeys(io, m.surface);
  }
}
void Check(const MapReader& map, TerrainMeshText& mesh);

/// Of its file, if it has one.
std::string PathOf(const HeightFieldText& text);
std::string PathOf(const TerrainMeshText& text);
/// Heights from the file or the formula; nothing after a complaint.
std::optional<HeightFieldDef> ReadHeightField(const HeightFieldText& text, const Scope& scope);
/// Corners and triangles from the file, in place; nothing after a complaint.
std::optional<TerrainMeshDef> ReadTerrainMesh(const TerrainMeshText& text, const Scope& scope);

}  // namespace taut::description
