/// Export of a model as MJCF, for users and for the MuJoCo peer.
#pragma once

#include <string>
#include <vector>

#include "mechanics/height_range.h"
#include "taut/mjcf.h"

namespace taut::mjcf {

struct WriteOptions : MjcfExport {
  bool elliptic = true;  ///< Elliptic friction cones (true) or pyramidal ones.
  /// Writes the variant of the model for comparisons of speed with MuJoCo: MuJoCo 2's solver
  /// settings, memory for all possible contacts, and height fields without data. The program sets
  /// the heights after it has loaded the model.
  bool as_peer = false;
};

/// Reports errors for features that MJCF lacks.
void RefuseWhatMjcfLacks(const ModelDef& def, const WriteOptions& options, Diagnostics& out);
/// Warns of features that the export omits.
void WarnOfWhatIsLeftOut(const ModelDef& def, const WriteOptions& options, Diagnostics& out);

/// Returns the MJCF text of a model. `RefuseWhatMjcfLacks` must have reported no errors.
std::string Text(const ModelDef& def, const WriteOptions& options);

/// Friction coefficients for MuJoCo. MuJoCo uses the larger coefficient of two geoms, or the
/// coefficient of the geom with higher priority.
struct Friction {
  /// Two geoms that need a pair element: their friction does not follow from MuJoCo's rule.
  struct Pair {
    std::string geom1, geom2;
    double friction = 0;
  };
  double shape = 0;           ///< Friction of the first shape that collides, written as the
                              ///< default.
  bool grounds_rule = false;  ///< Whether grounds have a higher priority than shapes.
  std::vector<Pair> pairs;
};

/// Geoms of the model with unique names.
struct Geoms {
  struct Geom {
    std::string name;
    int body = kWorld;
    const Material* material = nullptr;
    bool meets_planes = true, meets_bodies = true;
    bool is_plane = false;
  };
  std::vector<Geom> shapes;  ///< In the order of `EachShape`.
  std::vector<Geom> planes, terrain_boxes, height_fields;
};
Geoms GeomsOf(const ModelDef& def);
double FrictionOf(const ModelDef& def, const Material& a, const Material& b);
Friction FrictionsOf(const ModelDef& def, const Geoms& geoms);
/// Returns the friction coefficient to write in the geom element.
double OwnFriction(const ModelDef& def, const Friction& all, const Geoms::Geom& geom);

/// Returns the height range of a height field for MuJoCo [m], which must be positive.
double RiseOf(const mechanics::HeightRange& range);

}  // namespace taut::mjcf
