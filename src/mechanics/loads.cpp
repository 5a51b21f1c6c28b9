#include "taut/loads.h"

#include "math/described_path.h"
#include "mechanics/strut.h"

namespace taut {

std::vector<BodyForce> StartForces(const ModelDef& def, const std::vector<JointLoad>& joints) {
  std::vector<double> tensions;
  for (const CableDef& cable : def.cables) tensions.push_back(CableTension(cable));
  return ForcesUnder(def, tensions, joints);
}

std::vector<BodyForce> ForcesUnder(const ModelDef& def, const std::vector<double>& cable_tension_n,
                                   const std::vector<JointLoad>& joints) {
  std::vector<BodyForce> forces;
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    const CableDef& cable = def.cables[c];
    const double tension_n = cable_tension_n[c];
    if (tension_n == 0) continue;
    math::DescribedPath path(cable);
    for (int i = 0; i < path.count(); ++i) {
      forces.push_back({cable.attachments[path.attachment(i)].body, path.points()[i].p,
                        tension_n * PullAt(path.count(), path.points(), i)});
    }
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const JointDef& joint = def.joints[j];
    for (const BodyForce& force :
         mechanics::JointForces(joint, joints[j], joint.from_m, joint.to_m)) {
      forces.push_back(force);
    }
  }
  return forces;
}

std::vector<StrutForce> StrutForces(const ModelDef& def, const std::vector<BodyForce>& forces) {
  std::vector<StrutForce> out;
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    const BodyDef& body = def.bodies[b];
    const auto strut = mechanics::StrutOf(def, static_cast<int>(b));
    if (!strut) continue;
    out.push_back({strut->body, mechanics::AxialForceOf(
                                    *strut, body.mass_kg,
                                    {body.com_m, {}, body.angular_velocity_rad_per_s}, forces)});
  }
  return out;
}

std::vector<Reaction> AnchorReactions(const ModelDef& def, const std::vector<BodyForce>& forces) {
  std::vector<Reaction> out;
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    const BodyDef& body = def.bodies[b];
    if (!body.fixed) continue;
    out.push_back(mechanics::ReactionOf(static_cast<int>(b), body.com_m,
                                        body.mass_kg * def.gravity_m_per_s2, forces));
  }
  return out;
}

}  // namespace taut
