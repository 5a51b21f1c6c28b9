#include "plant/channels.h"
#include "plant/strut.h"

namespace taut::plant {
namespace {

/// Minus what acts on an anchored body, its weight included (docs/theory/loads.md, eq. 6).
void FillAnchor(int body, const Vec3& weight_n, const World& world,
                const std::vector<BodyForce>& forces, double* out) {
  const Vec3 origin_m = world.Body(0, body).position_m;
  Vec3 force_n = -1.0 * weight_n, torque_n_m;
  for (const BodyForce& force : forces) {
    if (force.body != body) continue;
    force_n = force_n - force.force_n;
    torque_n_m = torque_n_m - Cross(force.point_m - origin_m, force.force_n);
  }
  Put(force_n, out);
  Put(torque_n_m, out + 3);
}

struct Anchor {
  int body;
  Vec3 weight_n;
};

}  // namespace

/// All are filled together: the forces on bodies are gathered once a row.
void AddLoadChannels(const ExperimentSpec& experiment, Recorder& recorder) {
  const ModelDef& def = experiment.robot.def;
  std::vector<Strut> struts;
  std::vector<Anchor> anchors;
  std::vector<ChannelInfo> names;
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    const auto strut = StrutOf(def, static_cast<int>(b));
    if (!strut) continue;
    struts.push_back(*strut);
    names.push_back({"strut/" + def.bodies[b].name + "/axial_n", "N"});
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
        const auto& gathered = forces.Gather(*s.exact, *s.world);
        for (const Strut& strut : struts) {
          *out++ = AxialForce(strut, s.world->BodyMass(0, strut.body), s.world->Body(0, strut.body),
                              gathered);
        }
        for (const Anchor& anchor : anchors) {
          FillAnchor(anchor.body, anchor.weight_n, *s.world, gathered, out);
          out += 6;
        }
      });
}

}  // namespace taut::plant
