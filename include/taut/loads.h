/// Forces at points of bodies, what they make of rods, and what holds anchored bodies
/// (docs/theory/loads.md).
///
/// Threads: any number may call these functions at once.
#pragma once

#include <vector>

#include "taut/model_def.h"
#include "taut/statics.h"

namespace taut {

/// What acts on a body at a point, in W; weights are said apart.
struct BodyForce {
  int body = 0;
  Vec3 point_m, force_n;
  Vec3 torque_n_m = {};  ///< Beside what the force makes at its point.
};
/// Of all cables at their attachments and `joints` (per joint) at theirs; on the world, too.
std::vector<BodyForce> StartForces(const ModelDef& def, const std::vector<JointLoad>& joints);
/// The same with other tensions (per cable) than those described.
std::vector<BodyForce> ForcesUnder(const ModelDef& def, const std::vector<double>& cable_tension_n,
                                   const std::vector<JointLoad>& joints);

/// The force along a straight rod, positive in tension, in its middle and where it is least (the
/// largest compression, if it is negative) and greatest along it (docs/theory/loads.md, section 2).
struct AxialForce {
  double middle_n = 0, least_n = 0, greatest_n = 0;
};
struct StrutForce {
  int body = 0;
  AxialForce axial;
};
/// Of all bodies that are one straight rod with at most a mass at either end: others carry what
/// depends on more than is known. `forces`: all that acts on bodies; a body that does not balance
/// is let go, or spins as described.
std::vector<StrutForce> StrutForces(const ModelDef& def, const std::vector<BodyForce>& forces);

/// What an anchored body is held with against all `forces` and its weight.
struct Reaction {
  int body = 0;
  Vec3 force_n;     ///< In W.
  Vec3 torque_n_m;  ///< About the body's `com_m`, in W.
};
/// Of all bodies that are fixed.
std::vector<Reaction> AnchorReactions(const ModelDef& def, const std::vector<BodyForce>& forces);

}  // namespace taut
