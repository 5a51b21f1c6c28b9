/// Conversion of an MJCF scene to a robot: data that its steps share. All quantities are in the
/// file's units until `ScaleUnits`.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/unique_names.h"
#include "mjcf/mjcf_scene.h"

namespace taut::mjcf {

/// Rigid body of the robot, or the world with all static parts that are not terrain.
struct Rigid {
  int root = 0;           ///< Index of its root body in the scene.
  std::string placement;  ///< Name of the placement of its nodes; empty: none.
  bool moves = false, called_as_robot = false;
  std::vector<int> sites, shapes;  ///< Indices in the scene. Shapes of the terrain are excluded.
  int body = kWorld;               ///< Index of the body in the robot.
};

struct Building {
  Scene& scene;
  const MjcfImport& options;
  ImportedMjcf& made;
  Diagnostics& out;
  std::vector<Rigid> rigids;  ///< In the order of the robot's bodies; the world is last.
  std::vector<std::size_t> rigid_of_body;  ///< Index into `rigids`, per body of the scene.
  std::vector<int> node_of_site;
  /// Result of a shape of the scene: a sphere, capsule or box of the robot, or an element of the
  /// terrain.
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

/// Determines rigid bodies, terrain, and the placements of nodes.
void FindRigids(Building& b);
/// Adds bodies, nodes and shapes.
void BuildBodies(Building& b);
void NameBodies(Building& b);
/// Determines the shapes that collide. Call this before `BuildBodies`.
void FindWhatCollides(Building& b);
/// Sets pairs of bodies that do not collide, and the friction of materials.
void BuildContacts(Building& b);
/// Moves the scene's bodies to the poses of a keyframe. Null: described poses.
void PutAt(const Key* key, Building& b);
void BuildCables(const Key* key, Building& b);
/// Converts all quantities to SI units. Warns if the results are implausible.
void ScaleUnits(Building& b);

/// Returns a valid name of taut: all other characters become `_`.
std::string ToName(const std::string& text, const std::string& if_empty);
/// Returns text such as "3 geoms" or "1 geom".
std::string Count(std::size_t count, const std::string& what);

}  // namespace taut::mjcf
