/// Forces on bodies, axial forces of struts and reactions of anchored bodies
/// (docs/theory/loads.md).
///
/// Threads: any number may call these functions at once.
#pragma once

#include <vector>

#include "taut/model_def.h"
#include "taut/statics.h"

namespace taut {

/// Force and torque on a body at a point, in W, without the weight.
struct BodyForce {
  int body = 0;
  Vec3 point_m, force_n;
  Vec3 torque_n_m = {};  ///< In addition to the moment of the force.
};
/// Returns forces of all cables at their attachments and of `joints` (one per joint) at their
/// points, including those on the world, for the described tensions.
std::vector<BodyForce> StartForces(const ModelDef& def, const std::vector<JointLoad>& joints);
/// Returns the same forces for given tensions, one per cable.
std::vector<BodyForce> ForcesUnder(const ModelDef& def, const std::vector<double>& cable_tension_n,
                                   const std::vector<JointLoad>& joints);

/// Axial force of a straight rod, positive in tension: in its middle, and its minimum (if negative,
/// the largest compression) and maximum along the rod (docs/theory/loads.md, section 2).
struct AxialForce {
  double middle_n = 0, least_n = 0, greatest_n = 0;
};
struct StrutForce {
  int body = 0;
  AxialForce axial;
};
/// Returns the axial forces of all bodies that are one straight rod with at most a mass at either
/// end; in other bodies, load sharing is not determined by the known data. `forces`: all forces on
/// bodies except weights. A body that is not in equilibrium accelerates; a body's described angular
/// velocity counts.
std::vector<StrutForce> StrutForces(const ModelDef& def, const std::vector<BodyForce>& forces);

/// Reaction of an anchored body to all `forces` and its weight.
struct Reaction {
  int body = 0;
  Vec3 force_n;     ///< In W.
  Vec3 torque_n_m;  ///< About the body's `com_m`, in W.
};
/// Returns the reactions of all fixed bodies.
std::vector<Reaction> AnchorReactions(const ModelDef& def, const std::vector<BodyForce>& forces);

}  // namespace taut
