/// Forces on bodies, axial forces of struts, and reactions of anchored bodies
/// (docs/theory/loads.md).
///
/// Threads: any number may call these functions concurrently.
#pragma once

#include <vector>

#include "taut/model_def.h"
#include "taut/statics.h"

namespace taut {

/// Force and torque on a body at a point, in W. Weights are not included.
struct BodyForce {
  int body = 0;
  Vec3 point_m, force_n;
  Vec3 torque_n_m = {};  ///< In addition to the moment of `force_n`.
};
/// Returns the forces of all cables at their attachments under the described tensions, and of
/// `joints` (one per joint) at their points. Forces on the world are included.
std::vector<BodyForce> StartForces(const ModelDef& def, const std::vector<JointLoad>& joints);
/// Returns the same forces under given tensions, one per cable.
std::vector<BodyForce> ForcesUnder(const ModelDef& def, const std::vector<double>& cable_tension_n,
                                   const std::vector<JointLoad>& joints);

/// Axial force of a straight rod, tension > 0: at its middle, and the minimum and maximum along the
/// rod (docs/theory/loads.md, section 2). A negative minimum is the largest compression.
struct AxialForce {
  double middle_n = 0, least_n = 0, greatest_n = 0;
};
struct StrutForce {
  int body = 0;
  AxialForce axial;
};
/// Returns the axial forces of all bodies that consist of one straight rod with at most a point
/// mass at each end. For other bodies, the data do not determine the internal forces. `forces`: all
/// forces on bodies except weights. Inertial forces are included: bodies out of equilibrium
/// accelerate, and the described angular velocities count.
std::vector<StrutForce> StrutForces(const ModelDef& def, const std::vector<BodyForce>& forces);

/// Reaction of an anchored body to `forces` and to its weight.
struct Reaction {
  int body = 0;
  Vec3 force_n;     ///< Reaction force, in W.
  Vec3 torque_n_m;  ///< About `com_m` of the body, in W.
};
/// Returns the reactions of all fixed bodies.
std::vector<Reaction> AnchorReactions(const ModelDef& def, const std::vector<BodyForce>& forces);

}  // namespace taut
