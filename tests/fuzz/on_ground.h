/// Ground from files under a falling rod, for the fuzz targets that read meshes and heights.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "fuzz/reader_targets.h"
#include "fuzz/refusals.h"

namespace taut::fuzz {

/// Compiles the model with a rod above its ground and steps it `steps` times.
inline void DropARod(ModelDef def, int steps) {
  BodyDef body;
  body.mass_kg = 1;
  body.inertia_kg_m2 = {1, 1, 1, 0, 0, 0};
  body.com_m = {0, 0, 0.2};
  def.bodies.push_back(body);
  const int index = static_cast<int>(def.bodies.size()) - 1;
  def.capsules.push_back({"rod", index, {-0.3, 0, 0.2}, {0.3, 0.1, 0.2}, 0.05, {}});
  Diagnostics refused;
  const auto model = Model::Compile(def, refused);
  Must((model != nullptr) == refused.ok(), "compiled or refused");
  if (!model) return;
  WorldBatch world(model, {});
  world.Step(1e-3, steps);
  const Vec3 p = world.Body(0, index).position_m;
  Must(std::isfinite(p.x + p.y + p.z), "a finite position");
}

/// Writes a model of one rod and an experiment with this terrain; reads the experiment.
inline std::optional<ExperimentSpec> ReadTerrain(const Folder& folder, const std::string& terrain,
                                                 Diagnostics& out) {
  const std::string model =
      "taut: 1\nkind: model\nname: m\nnodes: {a: [0, 0, 1], b: [0, 0, 2]}\n"
      "pairs: [{nodes: [a, b], tags: [rod]}]\n"
      "builders: [{match: rod, rod: {radius_m: 0.01, mass_kg: 1}}]\n";
  const std::string text =
      "taut: 1\nkind: experiment\nname: e\nmodel: model.yaml\nduration_s: 1\nterrain:\n  - " +
      terrain + "\n";
  folder.Write("model.yaml", model.data(), model.size());
  auto read = LoadExperiment(folder.Write("input.yaml", text.data(), text.size()), {}, out);
  CheckReading(read.has_value(), out);
  return read;
}

/// Returns the height field of `ReadTerrain` alone, with a height for each corner.
inline ModelDef HeightsOf(const ExperimentSpec& read) {
  ModelDef def;
  def.height_fields = read.robot.def.height_fields;
  const HeightFieldDef& field = def.height_fields.at(0);
  Must(field.height_m.size() ==
           static_cast<std::size_t>(field.columns) * static_cast<std::size_t>(field.rows),
       "a height for each corner");
  return def;
}

}  // namespace taut::fuzz
