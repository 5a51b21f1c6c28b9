/// Scene of an MJCF file, in the file's units, with all poses in W at qpos0. Frames, default
/// classes and the notations of orientations are resolved.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/mass_properties.h"
#include "mjcf/mjcf_schema.h"
#include "mjcf/values.h"
#include "taut/mjcf.h"

namespace taut::mjcf {

struct Shape {
  enum class Kind { kSphere, kCapsule, kCylinder, kBox, kPlane };
  Kind kind = Kind::kSphere;
  std::string name;  ///< May be empty.
  SourceRef at;
  int body = 0;
  Pose pose = {};
  Vec3 from = {}, to = {};  ///< Of a capsule or cylinder.
  Vec3 half = {};           ///< Of a box.
  double radius = 0;
  double mass = 0;
  double friction = 1;
  int contype = 1, conaffinity = 1, condim = 3, priority = 0;
  bool collides = true;  ///< With anything; known after all is read.
};

struct Site {
  std::string name;
  SourceRef at;
  int body = 0;
  Vec3 p;
};

/// A body of the file. The first is the world.
struct Body {
  std::string name;
  SourceRef at;
  bool is_free = false;  ///< Has a free joint.
  int root = 0;          ///< Body of the same rigid body: itself, its parent or the weld's.
  Pose frame = {};
  MassProperties mass = {};
  bool aligned = false;  ///< MuJoCo aligns its frame with its principal axes: poses of keys differ.
  bool own_masses = true;  ///< Each of its shapes has the mass of the same solid in taut.
};

struct Tendon {
  std::string name = {}, tag = {};  ///< The tag: its default class, if it names one.
  SourceRef at;
  std::vector<int> sites = {};
  double stiffness = 0, damping = 0, friction = 0;
  /// Below the first it pushes, above the second it pulls. Both -1: the length at qpos0.
  double springlength[2] = {-1, -1};
  std::optional<std::pair<double, double>> range = {};  ///< Limits of its length.
};

/// p = gain ctrl + bias0 + bias1 l + bias2 dl/dt along a tendon, where positive pushes.
struct Actuator {
  std::string name;
  SourceRef at;
  int tendon = 0;
  double gain = 0, bias[3] = {0, 0, 0};  ///< With the gear: for the tendon's l.
  std::optional<std::pair<double, double>> control_range = {}, force_range = {};  ///< Of p.
  double lag_s = 0;                       ///< Lag behind its control.
  std::optional<std::size_t> state = {};  ///< With a lag: its index in keys' `act`.
};

struct Key {
  std::string name;
  SourceRef at;
  std::vector<double> qpos, qvel, ctrl, act;  ///< Empty if not given.
};

struct ContactPair {
  SourceRef at;
  int shape1 = 0, shape2 = 0;
  double friction = 1;
};

struct Scene {
  std::string model;
  CompilerSettings settings;
  Vec3 gravity{0, 0, -9.81};
  double timestep = 0.002;
  bool clamps_controls = true, has_contacts = true, only_pairs = false, has_dry_friction = true,
       has_limits = true;
  std::vector<int> disabled_groups;  ///< Of actuators.
  std::vector<Body> bodies;
  std::vector<Shape> shapes;
  std::vector<Site> sites;
  std::vector<Tendon> tendons;
  std::vector<Actuator> actuators;
  std::size_t states = 0;        ///< Of actuators.
  bool lacks_actuators = false;  ///< Some are refused: numbers of keys cannot be checked.
  std::vector<Key> keys;
  std::vector<ContactPair> pairs;
  std::vector<std::pair<int, int>> excludes;  ///< Of bodies.
  std::map<std::string, int> site_by_name, body_by_name, shape_by_name, tendon_by_name;
  /// Indices of geoms that are no shapes: refused with an error, or of an unsupported type without
  /// contacts and mass.
  static constexpr int kRefused = -1, kLeftOut = -2;
  LeftOut left_out;
  std::vector<SourceRef> twisting;  ///< Geoms and pairs with torsional or rolling friction.
  int pictures = 0;                 ///< Tendons without effect.

  bool Moves(int body) const { return bodies[Index(bodies[Index(body)].root)].is_free; }
  static std::size_t Index(int i) { return static_cast<std::size_t>(i); }
};

/// Registers a name, unique per kind: an entry of the list that `by_name` indexes. Reports an error
/// for a duplicate.
void Register(std::map<std::string, int>& by_name, const Element& element, int index,
              Diagnostics& out);
/// Returns the index of the item that the attribute names; -1 after an error, also after an earlier
/// one about the item.
int Find(const std::map<std::string, int>& by_name, const Element& element,
         std::string_view attribute, const char* kind, Diagnostics& out);

// Each function reads its section. Members of `Scene` that are declared earlier have been read.
void ReadSettings(const Element& root, Scene& scene, Diagnostics& out);
void ReadBodies(const Element& root, const Defaults& defaults, Scene& scene, Diagnostics& out);
void ReadTendons(const Element& root, const Defaults& defaults, Scene& scene, Diagnostics& out);
void ReadActuators(const Element& root, const Defaults& defaults, Scene& scene, Diagnostics& out);
void ReadContacts(const Element& root, const Defaults& defaults, Scene& scene, Diagnostics& out);
void ReadEqualities(const Element& root, const Defaults& defaults, Scene& scene, Diagnostics& out);
void ReadKeys(const Element& root, Scene& scene, Diagnostics& out);

/// Returns all sections of that name, in order.
std::vector<const Element*> Sections(const Element& root, std::string_view name);

/// Returns the robot of the scene, in SI units.
std::optional<ImportedMjcf> BuildRobot(Scene& scene, const std::string& path,
                                       const MjcfImport& options, Diagnostics& out);

}  // namespace taut::mjcf
