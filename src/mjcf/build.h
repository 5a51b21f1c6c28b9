/// From a scene to a robot: what its steps share. All in the file's units until the last one.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/unique_names.h"
#include "mjcf/scene.h"

namespace taut::mjcf {

/// A rigid body of the robot, or the world with what stands still and is no terrain.
struct Rigid {
  int root = 0;           ///< Body of the scene.
  std::string placement;  ///< That its nodes are in; empty: none.
  bool moves = false, called_as_robot = false;
  std::vector<int> sites, shapes;  ///< Of the scene; shapes that are terrain are not here.
  int body = kWorld;               ///< Of the robot.
};

struct Building {
  Scene& scene;
  const MjcfImport& options;
  ImportedMjcf& made;
  Diagnostics& out;
  std::vector<Rigid> rigids;  ///< In the order of the robot's bodies; the world's last.
  std::vector<std::size_t> rigid_of_body;  ///< Per body of the scene, its index in `rigids`.
  std::vector<int> node_of_site;
  /// Per shape of the scene: a sphere, capsule or box of the robot, or a part of its terrain.
  struct Made {
    const char* list = "";
    std::size_t index = 0;
  };
  std::vector<Made> made_of_shape;
  base::UniqueNames nodes, pairs, terrain;

  ModelDef& def() { return made.robot.def; }
  void Note(const std::string& text) { made.notes.push_back(text); }
  const Rigid& RigidOf(int body) const;
};

/// Which bodies are one, what of them is terrain, where their nodes go.
void FindRigids(Building& b);
/// Bodies, nodes and shapes.
void BuildBodies(Building& b);
void NameBodies(Building& b);
/// Which shapes touch anything: before shapes are built.
void FindWhatCollides(Building& b);
/// Which bodies touch nothing of each other, and with what friction they touch.
void BuildContacts(Building& b);
/// The scene's bodies where the key has them; null: as described.
void PutAt(const Key* key, Building& b);
void BuildCables(const Key* key, Building& b);
/// To SI units; a warning if that is unlikely to be what was meant.
void ScaleUnits(Building& b);

/// What taut lets be a name: other characters become `_`.
std::string ToName(const std::string& text, const std::string& if_empty);
/// "3 geoms" or "1 geom".
std::string Count(std::size_t count, const std::string& what);

}  // namespace taut::mjcf
