/// A mass on a cable from a point of the world: a vertical oscillator.
#pragma once

#include "tests/scenes/solids.h"

namespace taut::scenes {

struct HangingMass {
  double mass_kg = 0.5;
  double stiffness_n_per_m = 400.0;
  double damping_n_s_per_m = 0.0;
  double rest_length_m = 1.0;
  double length_m = 1.0;  ///< At t = 0: the mass hangs this far below the origin.
  double gravity_m_per_s2 = 9.81;

  double sag_m() const { return mass_kg * gravity_m_per_s2 / stiffness_n_per_m; }

  ModelDef Def() const {
    ModelDef def;
    def.name = "hanging_mass";
    def.gravity_m_per_s2 = {0, 0, -gravity_m_per_s2};
    BodyDef body;
    body.name = "mass";
    body.mass_kg = mass_kg;
    body.com_m = {0, 0, -length_m};
    body.inertia_kg_m2 = SphereInertia(mass_kg, 0.05);
    def.bodies.push_back(body);
    def.nodes.push_back({"mass", 0, body.com_m});
    CableDef cable;
    cable.name = "cable";
    cable.attachments = {{kWorld, {0, 0, 0}}, {0, body.com_m}};
    cable.stiffness_n_per_m = stiffness_n_per_m;
    cable.damping_n_s_per_m = damping_n_s_per_m;
    cable.rest_length_m = rest_length_m;
    def.cables.push_back(cable);
    return def;
  }
};

}  // namespace taut::scenes
