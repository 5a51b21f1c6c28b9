// Height fields by formula or from files, and placement of meshes.
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "base/brief.h"
#include "description/assets/height_csv.h"
#include "description/assets/height_image.h"
#include "description/assets/mesh_file.h"
#include "description/experiment/ground_keys.h"
#include "description/yaml/expression.h"
#include "description/yaml/reader.h"
#include "math/vec.h"
#include "trace/hdf5_table.h"

namespace taut::description {
namespace {

constexpr double kMostByFormula = 4e6;
/// Limit of evaluation steps of a formula, summed over all corners. One step takes 5 to 50 ns.
constexpr double kMostSteps = 4e8;

/// Computes the heights by a formula at each corner.
bool FillByFormula(const HeightFieldText& text, const Scope& scope, trace::TableBudget& budget,
                   HeightFieldDef& field) {
  const Value& formula = *text.formula.value;
  if (formula.kind != Value::Kind::kScalar) {
    scope.out.Error(
        "heights.formula_missing", formula.at,
        "height_field.height_m must be a formula, got " + std::string(KindName(formula)));
    return false;
  }
  NameTable names = scope.names;
  if (scope.used != nullptr) {
    for (const std::string& name : NamesIn(formula.text)) scope.used->insert(name);
  }
  double& i_of = names["i"] = 0;
  double& j_of = names["j"] = 0;
  double& x_m = names["x_m"] = 0;
  double& y_m = names["y_m"] = 0;
  const Formula parsed(formula.text, names);
  const double corners = static_cast<double>(field.columns) * field.rows;
  if (corners * static_cast<double>(parsed.size()) > kMostSteps) {
    scope.out.Error("heights.formula_too_costly", formula.at,
                    "height_field.height_m has " + std::to_string(parsed.size()) +
                        " operations and operands for each of " + base::Brief(corners) +
                        " corners, more than 400 000 000 in all",
                    "use a shorter formula, fewer, larger cells, or a file");
    return false;
  }
  if (corners > budget.left()) {
    scope.out.Error(
        "heights.too_many", formula.at,
        "this height field has " + base::Brief(corners) + " heights" + budget.MoreThan(),
        "use fewer, larger cells");
    return false;
  }
  budget.Add(corners);
  field.height_m.reserve(static_cast<std::size_t>(field.columns) *
                         static_cast<std::size_t>(field.rows));
  for (int j = 0; j < field.rows; ++j) {
    for (int i = 0; i < field.columns; ++i) {
      i_of = i, j_of = j;
      x_m = (i - 0.5 * (field.columns - 1)) * field.cell_m;
      y_m = (j - 0.5 * (field.rows - 1)) * field.cell_m;
      const Evaluated height = parsed.Value();
      if (!height.error.empty()) {
        scope.out.Error("heights.formula_error", formula.at,
                        "height_field.height_m at i = " + std::to_string(i) +
                            ", j = " + std::to_string(j) + ": " + height.error,
                        height.hint);
        return false;
      }
      if (std::isnan(height.value)) return false;
      field.height_m.push_back(height.value);
    }
  }
  return true;
}

bool ReadCsv(const std::string& path, const Scope& scope, trace::TableBudget& budget,
             HeightFieldDef& field) {
  auto table = ReadHeightCsv(path, budget, scope.out);
  if (!table) return false;
  field.columns = table->columns;
  field.rows = table->rows;
  field.height_m = std::move(table->height_m);
  return true;
}

bool IsImage(const std::string& file) { return EndsIn(file, ".png"); }

bool ReadImage(const HeightFieldText& text, const std::string& path, const Scope& scope,
               trace::TableBudget& budget, HeightFieldDef& field) {
  auto image = ReadHeightImage(path, budget, scope.out);
  if (!image || !text.height_range_m) return false;
  const auto [low, high] = *text.height_range_m;
  const double steps = std::exp2(image->bits) - 1;
  if (image->bits < 16) {
    scope.out.Warning("heights.coarse_image", {path, 0, 0},
                      "the image has " + std::to_string(image->bits) +
                          " bits per sample, so heights have steps of " +
                          base::Brief(std::fabs(high - low) / steps) + " m",
                      "use 16 bits for smooth slopes");
  }
  field.columns = image->columns;
  field.rows = image->rows;
  field.height_m = std::move(image->shares);  // a copy would double the memory use
  for (double& height : field.height_m) height = low + (high - low) * height;
  return true;
}

/// Returns the position of the data set's name in a path such as `hills.h5:/z`; npos for other
/// files.
std::size_t SetIn(const std::string& file) {
  for (const char* end : {".h5:", ".hdf5:"}) {
    const std::size_t at = file.find(end);
    if (at != file.npos) return at + std::string_view(end).size();
  }
  return file.npos;
}

bool ReadHdf5(const std::string& path, const std::string& set, const Scope& scope,
              trace::TableBudget& budget, HeightFieldDef& field) {
  auto table = trace::ReadHdf5Table(path, set, budget, scope.out);
  if (!table) return false;
  for (std::size_t i = 0; i < table->values.size(); ++i) {
    if (std::isfinite(table->values[i])) continue;
    const std::size_t columns = static_cast<std::size_t>(table->columns);
    scope.out.Error("heights.not_finite", {path, 0, 0},
                    set + ": row " + std::to_string(i / columns) + ", column " +
                        std::to_string(i % columns) + " is not a finite number",
                    "expected heights in m");
    return false;
  }
  field.columns = table->columns;
  field.rows = table->rows;
  field.height_m = std::move(table->values);
  return true;
}

/// Reads the heights from a CSV, PNG or HDF5 file.
bool ReadHeights(const HeightFieldText& text, const Scope& scope, trace::TableBudget& budget,
                 HeightFieldDef& field) {
  field.columns = field.rows = 0;
  const std::string& file = text.file.text;
  const std::size_t set = SetIn(file);
  const std::string path = PathOf(text);
  const bool good = set != file.npos ? ReadHdf5(path, file.substr(set), scope, budget, field)
                    : IsImage(file)  ? ReadImage(text, path, scope, budget, field)
                                     : ReadCsv(path, scope, budget, field);
  if (!good || (field.columns >= 2 && field.rows >= 2)) return good;
  scope.out.Error("heights.too_small", {path, 0, 0},
                  "the file must have at least two rows of at least two heights");
  return false;
}

}  // namespace

void Check(const MapReader& map, HeightFieldText& field) {
  field.material = ToMaterial(map, field.surface);
  field.at = map.at();
  const std::string& file = field.file.text;
  if (IsImage(file)) {
    map.Require("height_range_m");
  } else if (map.Has("height_range_m")) {
    map.Error("heights.range_without_effect", "height_range_m",
              map.Path("height_range_m") + " has no effect here",
              "it sets the heights of black and white in a .png image");
  }
  if ((EndsIn(file, ".h5") || EndsIn(file, ".hdf5"))) {
    map.Error("heights.data_set_missing", "file",
              map.Path("file") + " needs the name of a data set",
              "add it after a colon: " + file + ":/z");
  }
  for (const char* key : {"columns", "rows"}) {
    if (map.Has("height_m")) map.Require(key);
    if (map.Has("file") && map.Has(key)) {
      map.Error("heights.key_without_effect", key, map.Path(key) + " has no effect here",
                "the file defines the numbers of columns and rows");
    }
  }
}

void Check(const MapReader& map, TerrainMeshText& mesh) {
  mesh.material = ToMaterial(map, mesh.surface);
  mesh.at = map.at();
}

std::string PathOf(const HeightFieldText& text) {
  const std::string& file = text.file.text;
  const std::size_t set = SetIn(file);
  return PathBeside(text.file.at.file, set == file.npos ? file : file.substr(0, set - 1));
}

std::string PathOf(const TerrainMeshText& text) {
  return PathBeside(text.file.at.file, text.file.text);
}

std::optional<HeightFieldDef> ReadHeightField(const HeightFieldText& text, const Scope& scope,
                                              trace::TableBudget& budget) {
  HeightFieldDef field = text;
  if (!text.file.text.empty()) {
    if (!ReadHeights(text, scope, budget, field)) return std::nullopt;
  } else {
    const bool known = text.formula.value != nullptr && field.columns >= 2 && field.rows >= 2 &&
                       std::isfinite(field.cell_m);
    if (known && static_cast<double>(field.columns) * field.rows > kMostByFormula) {
      scope.out.Error("heights.too_many", text.at,
                      "a height field by formula can have at most 4 000 000 corners",
                      "use fewer, larger cells, or a file");
      return std::nullopt;
    }
    if (!known || !FillByFormula(text, scope, budget, field)) return std::nullopt;
  }
  return field;
}

std::optional<TerrainMeshDef> ReadTerrainMesh(const TerrainMeshText& text, const Scope& scope) {
  if (text.file.text.empty() || !std::isfinite(text.scale_m)) return std::nullopt;
  const std::string path = PathOf(text);
  auto mesh = ReadMeshFile(path, scope.out);
  if (!mesh) return std::nullopt;
  const MeshWords words{"the mesh", ", or write `solid: surface`"};
  if (!ReportFaults(*mesh, text.solid, path, words, scope.out)) return std::nullopt;
  TerrainMeshDef def = text;
  def.triangles = std::move(mesh->triangles);
  for (const Vec3& corner : mesh->corners) {
    def.corners_m.push_back(text.place.at_m + Rotate(text.place.rotate, text.scale_m * corner));
  }
  return def;
}

}  // namespace taut::description
