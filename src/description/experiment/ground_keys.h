/// Keys of uneven ground in an experiment's terrain: height fields and meshes.
#pragma once

#include <optional>
#include <string>

#include "description/model/surface_keys.h"
#include "description/yaml/keys.h"
#include "taut/model_def.h"
#include "trace/table_budget.h"

namespace taut::description {

/// Expression of the height, which may also refer to x and y.
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
/// Key `place` of a mesh.
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

/// Larger height fields would take gigabytes of memory.
inline constexpr Bound kCorners{.least = 2, .most = 100'000};

template <class Io, Either<HeightFieldDef, HeightFieldText> Field>
void Keys(Io& io, Field& f) {
  io.Map(
      "height_field", "terrain.height_field",
      "Height field over a rectangle, solid below: heights at the corners of square cells, each "
      "split into two triangles. There is no ground outside the rectangle.",
      R"json({"columns": 240, "rows": 240, "cell_m": 0.04, "height_m": "0.02 * sin(i) * cos(j)"})json");
  io("name", f.name, kResolvedOnly);
  if constexpr (Io::kResolved) {
    io("columns", f.columns);
    io("rows", f.rows);
  } else {
    io.OneOf({"file", "height_m"});
    io("file", f.file,
       "File with the heights, relative to the experiment's folder. CSV: heights in m, one line "
       "per row of "
       "corners, beginning with the "
       "smallest y, with x increasing along the line; lines that begin with # are skipped. PNG: "
       "gray, preferably 16 bits, with `height_range_m`; x increases to the right and y upward. "
       "HDF5: `hills.h5:/z` is the data set z of hills.h5, in m, with rows as in CSV.");
    io("height_range_m", f.height_range_m, "Heights of black and of white pixels in a PNG file.");
    io("columns", f.columns, kCorners, kInherited,
       "Number of corners along x. Only with `height_m`.");
    io("rows", f.rows, kCorners, kInherited, "Number of corners along y. Only with `height_m`.");
  }
  io("cell_m", f.cell_m, kNeeded, Bound::kPositive, "Edge length of a cell.");
  io("origin_m", f.origin_m, "Center of the rectangle; its z is added to all heights.");
  if constexpr (Io::kResolved) {
    io("height_m", f.height_m);
  } else {
    io("height_m", f.formula,
       "Formula for the height. Its variables are `x_m` and `y_m`, measured from the center, or "
       "`i` and `j`, the indices of a corner along x and y, from 0 at the smallest x and y. "
       "`noise(seed, x, y)` is a smooth random function between -1 and 1, with an independent "
       "value at each pair of integers x and y.");
  }
  io("split", f.split, kSplits,
     "Diagonal that splits a cell. `alternating`: the direction changes from cell to cell. `same`: "
     "always the diagonal from the "
     "corner with the smallest x and y. `shortest`: the diagonal with the smaller height "
     "difference.");
  if constexpr (Io::kResolved) {
    io("material", f.material);
  } else {
    SurfaceKeys(io, f.surface);
  }
}
void Check(const MapReader& map, HeightFieldText& field);

template <class Io>
void Keys(Io& io, Like<MeshPlaceText> auto& p) {
  io.Map("place", "terrain.mesh.place",
         "Placement of a mesh, which is rotated by `rotate`, then translated by `at_m`.");
  io("at_m", p.at_m, "Position of the file's origin.");
  io("rotate", p.rotate, "Rotation about the file's origin.");
}

template <class Io, Either<TerrainMeshDef, TerrainMeshText> Mesh>
void Keys(Io& io, Mesh& m) {
  io.Map("mesh", "terrain.mesh", "Ground mesh of triangles from a file.",
         R"({"file": "rock.obj", "scale_m": 0.001})");
  io("name", m.name, kResolvedOnly);
  if constexpr (Io::kResolved) {
    Packed corners{m.corners_m};
    Packed triangles{m.triangles};
    io("corners_m", corners);
    io("triangles", triangles);
  } else {
    io("file", m.file, kNeeded,
       "Wavefront OBJ or STL file, text or binary, relative to the experiment's folder. Corners "
       "are counter-clockwise seen from outside.");
    io("scale_m", m.scale_m, kNeeded, Bound::kPositive,
       "Length of one unit of the file: 0.001 for mm. OBJ and STL files do not contain their "
       "unit.");
    io("place", m.place);
  }
  io("solid", m.solid, kMeshKinds,
     "`closed`: the mesh encloses a solid. `surface`: a thin sheet with two sides.");
  if constexpr (Io::kResolved) {
    io("material", m.material);
  } else {
    SurfaceKeys(io, m.surface);
  }
}
void Check(const MapReader& map, TerrainMeshText& mesh);

/// Returns the path of the file, if any.
std::string PathOf(const HeightFieldText& text);
std::string PathOf(const TerrainMeshText& text);
/// Limit of the number of heights, summed over all height fields of an experiment.
inline constexpr double kMostHeights = 1e8;
/// Returns a height field with heights from a file or a formula. Adds the number of heights to the
/// budget of the experiment. Returns nothing after an error.
std::optional<HeightFieldDef> ReadHeightField(const HeightFieldText& text, const Scope& scope,
                                              trace::TableBudget& budget);
/// Returns a terrain mesh from a file, transformed to W. Returns nothing after an error.
std::optional<TerrainMeshDef> ReadTerrainMesh(const TerrainMeshText& text, const Scope& scope);

}  // namespace taut::description
