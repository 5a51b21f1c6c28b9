// Any bytes as OBJ, STL or heights in CSV: ground that a ball falls on, or complaints.
#include <cmath>

#include "description/mesh_file.h"
#include "fuzz/readers.h"

namespace {

using taut::Diagnostics;
using taut::ModelDef;
using taut::fuzz::Must;

/// What compiles can be stepped on.
void DropABall(ModelDef def) {
  taut::BodyDef body;
  body.mass_kg = 1;
  body.inertia_kg_m2 = {1, 1, 1, 0, 0, 0};
  body.com_m = {0, 0, 0.2};
  def.bodies.push_back(body);
  def.capsules.push_back({"rod", 0, {-0.3, 0, 0.2}, {0.3, 0.1, 0.2}, 0.05, {}});
  Diagnostics refused;
  const auto model = taut::Model::Compile(def, refused);
  Must((model != nullptr) == refused.ok(), "compiled or refused");
  if (!model) return;
  taut::Batch world(model, {});
  world.Step(1e-3, 20);
  const taut::Vec3 p = world.Body(0, 0).position_m;
  Must(std::isfinite(p.x + p.y + p.z), "a place");
}

}  // namespace

/// The first byte says what the others are: 0 OBJ, 1 STL, 2 CSV, and then whether meshes are
/// closed.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const taut::fuzz::Folder folder;
  if (size == 0) return 0;
  const int kind = data[0] % 3;
  const bool solid = data[0] / 3 % 2 == 0;
  const char* const names[] = {"ground.obj", "ground.stl", "ground.csv"};
  const std::string path = folder.Write(names[kind], data + 1, size - 1);
  Diagnostics out;
  if (kind < 2) {
    auto mesh = taut::description::ReadMeshFile(path, out);
    Must(mesh.has_value() == out.ok(), "a mesh or a complaint");
    if (!mesh) return 0;
    ModelDef def;
    def.terrain_meshes.push_back({"mesh", mesh->corners, mesh->triangles, solid, {}});
    DropABall(def);
    return 0;
  }
  const std::string text =
      "taut: 1\nkind: experiment\nname: e\nmodel: model.yaml\nduration_s: 1\n"
      "terrain:\n  - {name: g, height_field: {file: ground.csv, cell_m: 0.1}}\n";
  const std::string model =
      "taut: 1\nkind: model\nname: m\nnodes: {a: [0, 0, 1], b: [0, 0, 2]}\n"
      "pairs: [{nodes: [a, b], tags: [rod]}]\n"
      "builders: [{match: rod, rod: {radius_m: 0.01, mass_kg: 1}}]\n";
  const auto bytes = [](const std::string& words) {
    return reinterpret_cast<const std::uint8_t*>(words.data());
  };
  folder.Write("model.yaml", bytes(model), model.size());
  const std::string experiment = folder.Write("input.yaml", bytes(text), text.size());
  const auto read = taut::LoadExperiment(experiment, {}, out);
  Must(read.has_value() == out.ok(), "an experiment or a complaint");
  if (!read) return 0;
  ModelDef def;
  def.height_fields = read->robot.def.height_fields;
  DropABall(def);
  return 0;
}
