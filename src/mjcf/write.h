/// Export of a model as MJCF, for users and for the MuJoCo peer.
#pragma once

#include <string>
#include <vector>

#include "mechanics/height_range.h"
#include "taut/mjcf.h"

namespace taut::mjcf {

struct WriteOptions : MjcfExport {
  bool elliptic = true;  ///< Elliptic friction cones; else pyramidal.
  /// Writes the model as the peer is measured: MuJoCo 2's solver settings, memory for all its
  /// possible contacts, and height fields without heights, which are set when the model is loaded.
  bool as_peer = false;
};

/// Reports errors, with names, for features that MJCF lacks.
void RefuseWhatMjcfLacks(const ModelDef& def, const WriteOptions& options, Diagnostics& out);
/// Warns of features that are left out.
void WarnOfWhatIsLeftOut(const ModelDef& def, const WriteOptions& options, Diagnostics& out);

/// Returns the MJCF text of a model without refused features.
std::string Text(const ModelDef& def, const WriteOptions& options);

/// Friction values for MuJoCo, which uses the larger friction of two geoms, or the friction of the
/// geom with higher priority.
struct Friction {
  /// Two shapes, or a shape and a ground, whose friction does not follow from their values.
  struct Pair {
    std::string geom1, geom2;
    double friction = 0;
  };
  double shape = 0;           ///< Of the first shape that collides: usual value.
  bool grounds_rule = false;  ///< Grounds have a higher priority.
  std::vector<Pair> pairs;
};

/// Geoms of the model by unique names.
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
/// Returns the friction value of the geom element.
double OwnFriction(const ModelDef& def, const Friction& all, const Geoms::Geom& geom);

/// Returns the height of a height field in MuJoCo, which requires more than 0 [m].
double RiseOf(const mechanics::HeightRange& range);

}  // namespace taut::mjcf
