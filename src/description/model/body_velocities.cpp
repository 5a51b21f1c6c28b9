// Initial velocities of bodies from the velocities of placements.
#include "description/model/body_velocities.h"

#include "math/vec.h"

namespace taut::description {

void SetBodyVelocities(const BodyInstances& in, ModelDef& model, Diagnostics& out) {
  std::vector<double> mass(in.assembly.instances.size(), 0.0);
  std::vector<Vec3> moment(in.assembly.instances.size());
  for (std::size_t body = 0; body < model.bodies.size(); ++body) {
    const int instance = in.instance_of_body[body];
    if (instance < 0) continue;
    const BodyDef& def = model.bodies[body];
    mass[instance] += def.mass_kg;
    moment[instance] = moment[instance] + def.mass_kg * def.com_m;
  }
  for (std::size_t body = 0; body < model.bodies.size(); ++body) {
    BodyDef& def = model.bodies[body];
    const int instance = in.instance_of_body[body];
    if (instance < 0) {
      for (const int node : in.weld_of_body[body]->nodes) {
        const Instance& moving = in.assembly.instances[in.assembly.nodes[node].instance];
        if (Dot(moving.velocity_m_per_s, moving.velocity_m_per_s) +
                Dot(moving.angular_velocity_rad_per_s, moving.angular_velocity_rad_per_s) >
            0.0) {
          out.Error("body.velocity_of_several_parts", moving.at,
                    "the body \"" + def.name +
                        "\" joins several placements, so none of them can have a velocity");
          break;
        }
      }
      continue;
    }
    if (def.fixed || mass[instance] == 0.0) continue;
    const Instance& moving = in.assembly.instances[instance];
    const Vec3 arm = def.com_m - (1.0 / mass[instance]) * moment[instance];
    const bool alone = in.bodies_in_instance[instance] == 1;  // if so, `arm` is rounding error
    def.velocity_m_per_s =
        alone ? moving.velocity_m_per_s
              : moving.velocity_m_per_s + Cross(moving.angular_velocity_rad_per_s, arm);
    def.angular_velocity_rad_per_s = moving.angular_velocity_rad_per_s;
  }
}

}  // namespace taut::description
