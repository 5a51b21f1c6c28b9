// Program that uses only the core of taut, as a subfolder: defines a model in C++, steps it and
// computes a tension set point.
#include <cmath>
#include <cstdio>

#include "taut/control/impedance.h"
#include "taut/version.h"
#include "taut/world_batch.h"

int main() {
  taut::ModelDef def;
  def.bodies.resize(1);
  def.bodies[0].name = "mass";
  def.bodies[0].mass_kg = 0.5;
  def.bodies[0].inertia_kg_m2 = {1e-3, 1e-3, 1e-3};
  taut::CableDef cable;
  cable.name = "cable";
  cable.attachments = {{taut::kWorld, {0, 0, 1}}, {0, {0, 0, 0}}};
  cable.stiffness_n_per_m = 500;
  cable.rest_length_m = 0.9;
  def.cables.push_back(cable);
  taut::Diagnostics diagnostics;
  const auto model = taut::Model::Compile(def, diagnostics);
  if (!model) return std::fputs(diagnostics.Format().c_str(), stderr), 1;
  taut::WorldBatch batch(model, {});
  batch.Step(0.001, 10);
  const taut::control::Impedance<double> law{7.0, 0.2, 100.0, 100.0};
  const taut::CableState seen = batch.Cable(0, 0);
  const double set_point_n =
      taut::control::ImpedanceTension(law, seen.length_m, seen.rate_m_per_s, 0.0);
  if (!(seen.tension_n > 0.0) || !std::isfinite(set_point_n)) return 1;
  std::printf("taut %s: %zu cable, %.3f N, set point %.3f N\n", taut::kVersion, def.cables.size(),
              seen.tension_n, set_point_n);
  return 0;
}
