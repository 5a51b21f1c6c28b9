// Importer of an MJCF file as a robot with an experiment.
#include "mjcf/mjcf_scene.h"

#include "description/yaml/reader.h"
#include "description/yaml/write_keys.h"

namespace taut {

std::optional<ImportedMjcf> ImportMjcf(const std::string& path, const MjcfImport& options,
                                       Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  std::vector<std::string> files;
  const auto root = mjcf::ReadXml(path, files, out);
  if (!root) return std::nullopt;
  mjcf::Scene scene;
  mjcf::CheckSchema(*root, scene.left_out, out);
  if (root->name != "mujoco") return std::nullopt;
  mjcf::Defaults defaults;
  for (const mjcf::Element* const e : mjcf::Sections(*root, "default")) defaults.Add(*e, out);
  mjcf::ReadSettings(*root, scene, out);
  mjcf::ReadBodies(*root, defaults, scene, out);
  mjcf::ReadTendons(*root, defaults, scene, out);
  mjcf::ReadActuators(*root, defaults, scene, out);
  mjcf::ReadContacts(*root, defaults, scene, out);
  mjcf::ReadEqualities(*root, defaults, scene, out);
  mjcf::ReadKeys(*root, scene, out);
  if (out.items().size() != errors_before) return std::nullopt;
  auto made = mjcf::BuildRobot(scene, path, options, out);
  if (made) made->robot.files = files;
  return made;
}

std::string MjcfExperimentYaml(const ImportedMjcf& imported, const std::string& model_file) {
  using description::PlainOrQuoted, description::Shown;
  const ModelDef& def = imported.robot.def;
  const auto list = [](const Vec3& v) { return description::FlowWriter<false>::Text(v); };
  std::string text = "taut: 1\nkind: experiment\nname: " + PlainOrQuoted(def.name) +
                     "\nmodel: " + PlainOrQuoted(model_file) + "\n";
  if (!def.planes.empty() || !def.terrain_boxes.empty()) text += "\nterrain:\n";
  for (const PlaneDef& p : def.planes) {
    text += "  - {name: " + PlainOrQuoted(p.name) + ", plane: {normal: " + list(p.normal) +
            ", point_m: " + list(p.point_m) + ", friction: " + Shown(p.material.kinetic_friction) +
            "}}\n";
  }
  for (const TerrainBoxDef& box : def.terrain_boxes) {
    const Vec3& h = box.half_extents_m;
    const Quat& q = box.orientation;
    text += "  - {name: " + PlainOrQuoted(box.name) + ", box: {center_m: " + list(box.center_m) +
            ", size_m: " + list({2 * h.x, 2 * h.y, 2 * h.z});
    if (q.x != 0 || q.y != 0 || q.z != 0) {
      text += ", rotate: {quaternion: " + description::FlowWriter<false>::Text(q) + "}";
    }
    text += ", friction: " + Shown(box.material.kinetic_friction) + "}}\n";
  }
  return text + "\nstep_s: " + Shown(imported.step_s) + "\nduration_s: 5\n";
}

}  // namespace taut
