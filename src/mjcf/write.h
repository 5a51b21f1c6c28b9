/// A model as MJCF, for people and for the MuJoCo peer.
#pragma once

#include <string>
#include <vector>

#include "mechanics/height_range.h"
#include "taut/mjcf.h"

namespace taut::mjcf {

struct WriteOptions : MjcfExport {
  bool elliptic = true;  ///< In place of pyramidal friction cones.
  /// As the peer is measured: MuJoCo 2's solver settings, room for all contacts it may have, and
  /// height fields without heights, which are put in when the model is loaded.
  bool as_peer = false;
};

/// What MJCF has no word for: errors by name.
void RefuseWhatMjcfLacks(const ModelDef& def, const WriteOptions& options, Diagnostics& out);
/// What is left out, in words: warnings.
void WarnOfWhatIsLeftOut(const ModelDef& def, const WriteOptions& options, Diagnostics& out);

/// The text of a model of which nothing is refused.
std::string Text(const ModelDef& def, const WriteOptions& options);

/// The friction that MuJoCo is told: its own rule for two geoms is the larger one, or that of the
/// one of higher priority.
struct Friction {
  /// Two shapes, or a shape and a ground, whose friction does not follow from theirs.
  struct Pair {
    std::string geom1, geom2;
    double friction = 0;
  };
  double shape = 0;           ///< Of the first shape that collides: most are like it.
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
  std::vector<Geom> spheres, capsules, boxes, hulls;  ///< Per shape of the model.
  std::vector<Geom> planes, terrain_boxes, height_fields;
};
Geoms GeomsOf(const ModelDef& def);
double FrictionOf(const ModelDef& def, const Material& a, const Material& b);
Friction FrictionsOf(const ModelDef& def, const Geoms& geoms);
/// What the geom itself says.
double OwnFriction(const ModelDef& def, const Friction& all, const Geoms::Geom& geom);

/// How high a height field is in MuJoCo, which wants it above 0 [m].
double RiseOf(const mechanics::HeightRange& range);

}  // namespace taut::mjcf
