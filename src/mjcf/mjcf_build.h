/// Conversion of an MJCF scene to a robot: data shared by its steps. All quantities are in the
/// file's units until the last step.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/unique_names.h"
#include "mjcf/mjcf_scene.h"

namespace taut::mjcf {

/// A rigid body of the robot, or the world with static parts that are not terrain.
struct Rigid {
  int root = 0;           ///< Body of the scene.
  std::string placement;  ///< Placement of its nodes; empty: none.
  bool moves = false, called_as_robot = false;
  std::vector<int> sites, shapes;  ///< Of the scene; without shapes that are terrain.
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

/// Finds rigidly connected bodies, terrain, and the placements of nodes.
void FindRigids(Building& b);
/// Adds bodies, nodes and shapes.
void BuildBodies(Building& b);
void NameBodies(Building& b);
/// Finds the shapes that collide with anything. Call it before shapes are built.
void FindWhatCollides(Building& b);
/// Sets pairs of bodies without contact, and the friction of materials.
void BuildContacts(Building& b);
/// Moves the scene's bodies to the poses of the key; null: as described.
void PutAt(const Key* key, Building& b);
void BuildCables(const Key* key, Building& b);
/// Converts to SI units; warns if the result is implausible.
void ScaleUnits(Building& b);

/// Returns a valid name of taut: other characters become `_`.
std::string ToName(const std::string& text, const std::string& if_empty);
/// Returns text such as "3 geoms" or "1 geom".
std::string Count(std::size_t count, const std::string& what);

}  // namespace taut::mjcf
