/// What a model is like before it moves: lengths and tensions of its cables, the forces on its
/// bodies, its principal inertias, what may touch what. Made from the plain description alone.
#pragma once

#include <vector>

#include "taut/model_def.h"

namespace taut {

/// Between the ends, along all attachments [m].
double CableLength(const CableDef& cable);

/// k (l - L), 0 when slack [N].
double CableTension(const CableDef& cable);

/// What acts on a body at the start.
struct BodyLoad {
  Vec3 cable_force_n;     ///< Sum over all cables, in W.
  Vec3 cable_torque_n_m;  ///< The same about the body's centre of mass, in W.
  Vec3 weight_n;          ///< In W.
};

/// Per body of `def`. Fixed bodies carry loads, too: what holds them has to.
std::vector<BodyLoad> StartLoads(const ModelDef& def);

/// Moments about the principal axes, ascending [kg m^2].
Vec3 PrincipalMoments(const Inertia& inertia_kg_m2);

/// Sum over the bodies that move [kg].
double TotalMass(const ModelDef& def);

/// How many shapes of a body may touch something.
struct ShapeCount {
  int capsules = 0, spheres = 0, boxes = 0, hulls = 0;
  int total() const noexcept { return capsules + spheres + boxes + hulls; }
};
std::vector<ShapeCount> CollidingShapes(const ModelDef& def);  ///< Per body of `def`.

}  // namespace taut
