#include "mechanics/strut.h"
#include "plant/body_forces.h"
#include "plant/channels.h"

namespace taut::plant {
namespace {

struct Anchor {
  int body;
  Vec3 weight_n;
};

}  // namespace

/// All loads are in one block, so that the forces on bodies are gathered once per row.
void AddLoadChannels(const ExperimentSpec& experiment, Recorder& recorder) {
  const ModelDef& def = experiment.robot.def;
  std::vector<mechanics::Strut> struts;
  std::vector<Anchor> anchors;
  std::vector<ChannelInfo> names;
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    const auto strut = mechanics::StrutOf(def, static_cast<int>(b));
    if (!strut) continue;
    struts.push_back(*strut);
    for (const char* const quantity : {"axial_n", "axial_least_n", "axial_greatest_n"}) {
      names.push_back({"strut/" + def.bodies[b].name + "/" + quantity, "N"});
    }
  }
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    const BodyDef& body = def.bodies[b];
    if (!body.fixed) continue;
    anchors.push_back({static_cast<int>(b), body.mass_kg * def.gravity_m_per_s2});
    for (const char* const quantity : {"force_x_n", "force_y_n", "force_z_n"}) {
      names.push_back({"anchor/" + body.name + "/" + quantity, "N"});
    }
    for (const char* const quantity : {"torque_x_n_m", "torque_y_n_m", "torque_z_n_m"}) {
      names.push_back({"anchor/" + body.name + "/" + quantity, "N m"});
    }
  }
  recorder.Add(
      "", names,
      [struts, anchors, forces = BodyForces(def)](const RecordSource& s, double* out) mutable {
        const auto& gathered = forces.Gather(*s.exact, *s.world, s.lane);
        for (const mechanics::Strut& strut : struts) {
          const AxialForce axial =
              mechanics::AxialForceOf(strut, s.world->BodyMass(s.lane, strut.body),
                                      MomentOf(*s.world, strut.body, s.lane), gathered);
          *out++ = axial.middle_n;
          *out++ = axial.least_n;
          *out++ = axial.greatest_n;
        }
        for (const Anchor& anchor : anchors) {
          const Reaction held =
              mechanics::ReactionOf(anchor.body, s.world->Body(s.lane, anchor.body).position_m,
                                    anchor.weight_n, gathered);
          Put(held.force_n, out);
          Put(held.torque_n_m, out + 3);
          out += 6;
        }
      });
}

}  // namespace taut::plant
