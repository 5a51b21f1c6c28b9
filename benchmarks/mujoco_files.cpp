#include "benchmarks/mujoco_files.h"

#include "benchmarks/robots.h"

namespace taut::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFreePeriods = 10;

/// Removes ground and contacts. Engines differ in contacts, which would mask differences between
/// models.
ModelDef WithoutContacts(ModelDef def) {
  def.planes.clear();
  def.height_fields.clear();
  for (SphereDef& sphere : def.spheres) sphere.collides = false;
  for (CapsuleDef& capsule : def.capsules) capsule.collides = false;
  for (BoxDef& box : def.boxes) box.collides = false;
  return def;
}

Json Free(const ModelDef& def, const peers::Options& options, bool moves) {
  Json free = {{"mjcf", peers::Mjcf(def, options)}, {"steps", kFreePeriods * kControlSteps}};
  if (!peers::Available(peers::Engine::kMujoco)) return free;
  const auto world = peers::MakeWorld(peers::Engine::kMujoco, def, options);
  const Motion motion(def);
  for (int tick = 0; tick < kFreePeriods; ++tick) {
    for (int c = 0; moves && c < motion.cables(); ++c) {
      world->SetRestLength(c, motion.RestLength(0, c, tick));
    }
    world->Step(kStepS, kControlSteps);
  }
  for (int b = 0; b < static_cast<int>(def.bodies.size()); ++b) {
    const Vec3 p = world->Body(b).position_m;
    free["masses_kg"].push_back(world->Mass(b).mass_kg);
    free["positions_m"].push_back({p.x, p.y, p.z});
  }
  return free;
}

}  // namespace

Json MujocoFile(const ModelDef& def, const peers::Options& options, bool moves) {
  const Motion motion(def);
  Json commands = Json::array();
  for (int tick = 0; moves && tick < motion.period(); ++tick) {
    Json row = Json::array();
    for (int c = 0; c < motion.cables(); ++c) row.push_back(motion.RestLength(0, c, tick));
    commands.push_back(row);
  }
  Json heights = Json::array();
  for (const HeightFieldDef& field : def.height_fields) heights = peers::MujocoHeights(field);
  return {{"mjcf", peers::Mjcf(def, options)},
          {"heights", heights},
          {"bodies", def.bodies.size()},
          {"step_s", kStepS},
          {"control_steps", kControlSteps},
          {"rest_lengths_m", commands},
          {"free", Free(WithoutContacts(def), options, moves)}};
}

}  // namespace taut::bench
