// Models that taut exports as MJCF, with their properties, for tests/mjcf/mujoco3.mjs: a JSON list
// of
//   name, mjcf    the model
//   spring        the same with cables as springs
//   masses_kg, inertias_kg_m2 (xx yy zz xy xz yz), lengths_m, tensions_n   in the described pose
//   free          the same without contacts and with shorter cables, as MJCF
//   step_s, steps, positions_m   positions of the bodies after these steps
#include <iostream>
#include <nlohmann/json.hpp>

#include "mjcf/shipped_robots.h"
#include "taut/statics.h"
#include "taut/world_batch.h"

namespace taut::test {
namespace {

nlohmann::json CaseOf(const std::string& name) {
  constexpr double kStep_s = 2e-5;
  constexpr int kSteps = 5000;
  ModelDef def = Shipped(name).def;
  nlohmann::json one{{"name", name},
                     {"mjcf", Exported(def)},
                     {"spring", Exported(def, {.cables = MjcfCables::kSpring})},
                     {"step_s", kStep_s},
                     {"steps", kSteps}};
  for (const char* list : {"masses_kg", "inertias_kg_m2", "lengths_m", "tensions_n"}) {
    one[list] = nlohmann::json::array();
  }
  for (const BodyDef& body : def.bodies) {
    const Inertia& j = body.inertia_kg_m2;
    one["masses_kg"].push_back(body.mass_kg);
    one["inertias_kg_m2"].push_back({j.xx, j.yy, j.zz, j.xy, j.xz, j.yz});
  }
  for (const CableDef& cable : def.cables) {
    one["lengths_m"].push_back(CableLength(cable));
    one["tensions_n"].push_back(CableTension(cable));
  }
  for (SphereDef& s : def.spheres) s.collides = false;
  for (CapsuleDef& c : def.capsules) c.collides = false;
  for (HullDef& h : def.hulls) h.collides = false;
  for (CableDef& cable : def.cables) cable.rest_length_m *= 0.98;
  one["free"] = Exported(def);
  Diagnostics out;
  WorldBatch batch(Model::Compile(def, out), {});
  batch.Step(kStep_s, kSteps);
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    const Vec3 p = batch.Body(0, static_cast<int>(b)).position_m;
    one["positions_m"].push_back({p.x, p.y, p.z});
  }
  return one;
}

}  // namespace
}  // namespace taut::test

int main() {
  nlohmann::json all = nlohmann::json::array();
  for (const char* name : taut::test::kExportable) all.push_back(taut::test::CaseOf(name));
  std::cout << all;
}
