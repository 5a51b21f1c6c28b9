/// Scene of an MJCF file in the file's units, with all poses in W at qpos0. Frames, default classes
/// and orientations are already resolved.
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
  Vec3 from = {}, to = {};  ///< End points of a capsule or cylinder.
  Vec3 half = {};           ///< Half extents of a box.
  double radius = 0;
  double mass = 0;
  double friction = 1;
  int contype = 1, conaffinity = 1, condim = 3, priority = 0;
  bool collides = true;  ///< Whether this geom collides with any other one; known after the
                         ///< whole file has been read.
};

struct Site {
  std::string name;
  SourceRef at;
  int body = 0;
  Vec3 p;
};

/// Body of the file. The first is the world.
struct Body {
  std::string name;
  SourceRef at;
  bool is_free = false;  ///< Whether it has a free joint.
  int root = 0;          ///< Body that represents its rigid body: itself, its parent, or a body to
                         ///< which it is welded.
  Pose frame = {};
  MassProperties mass = {};
  bool aligned = false;  ///< Whether MuJoCo aligns its frame with its principal axes, which changes
                         ///< poses of keyframes.
  bool own_masses = true;  ///< Whether each of its shapes has the mass that taut computes for the
                           ///< same solid.
};

struct Tendon {
  std::string name = {}, tag = {};  ///< `tag`: its default class, if any.
  SourceRef at;
  std::vector<int> sites = {};
  double stiffness = 0, damping = 0, friction = 0;
  /// Below the first length, the tendon pushes; above the second, it pulls. Both -1: length at
  /// qpos0.
  double springlength[2] = {-1, -1};
  std::optional<std::pair<double, double>> range = {};  ///< Limits of the tendon's length.
};

/// Push of an actuator along a tendon: p = gain ctrl + bias0 + bias1 l + bias2 dl/dt.
struct Actuator {
  std::string name;
  SourceRef at;
  int tendon = 0;
  double gain = 0, bias[3] = {0, 0, 0};  ///< Include the gear: they apply to the tendon's length.
  /// Limits of the control (`ctrl`) and of the force.
  std::optional<std::pair<double, double>> control_range = {}, force_range = {};
  double lag_s = 0;                       ///< Time constant of the response to the control, plus
                                          ///< the delay.
  std::optional<std::size_t> state = {};  ///< If there is a lag: index into `act` of keyframes.
};

struct Key {
  std::string name;
  SourceRef at;
  std::vector<double> qpos, qvel, ctrl, act;  ///< Empty if absent from the file.
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
  std::vector<int> disabled_groups;  ///< Groups of actuators that are disabled.
  std::vector<Body> bodies;
  std::vector<Shape> shapes;
  std::vector<Site> sites;
  std::vector<Tendon> tendons;
  std::vector<Actuator> actuators;
  std::size_t states = 0;        ///< Number of actuators with a state.
  bool lacks_actuators = false;  ///< Whether actuators were rejected, so that the lengths of
                                 ///< keyframe vectors cannot be checked.
  std::vector<Key> keys;
  std::vector<ContactPair> pairs;
  std::vector<std::pair<int, int>> excludes;  ///< Pairs of bodies that do not collide.
  std::map<std::string, int> site_by_name, body_by_name, shape_by_name, tendon_by_name;
  /// Special indices of geoms that are not in `shapes`. kRefused: rejected with an error. kLeftOut:
  /// an unsupported type without contacts and mass.
  static constexpr int kRefused = -1, kLeftOut = -2;
  LeftOut left_out;
  std::vector<SourceRef> twisting;  ///< Geoms and pairs with torsional or rolling friction.
  int pictures = 0;                 ///< Number of tendons without effect.

  bool Moves(int body) const { return bodies[Index(bodies[Index(body)].root)].is_free; }
  static std::size_t Index(int i) { return static_cast<std::size_t>(i); }
};

/// Registers the name of an element. Names are unique per kind of element; `by_name` maps them to
/// indices. Reports duplicates.
void Register(std::map<std::string, int>& by_name, const Element& element, int index,
              Diagnostics& out);
/// Returns the index of the item to which an attribute refers. Returns -1 after an error, including
/// an earlier error about the item.
int Find(const std::map<std::string, int>& by_name, const Element& element,
         std::string_view attribute, const char* kind, Diagnostics& out);

// Each function reads its section. Call them in this order.
void ReadSettings(const Element& root, Scene& scene, Diagnostics& out);
void ReadBodies(const Element& root, const Defaults& defaults, Scene& scene, Diagnostics& out);
void ReadTendons(const Element& root, const Defaults& defaults, Scene& scene, Diagnostics& out);
void ReadActuators(const Element& root, const Defaults& defaults, Scene& scene, Diagnostics& out);
void ReadContacts(const Element& root, const Defaults& defaults, Scene& scene, Diagnostics& out);
void ReadEqualities(const Element& root, const Defaults& defaults, Scene& scene, Diagnostics& out);
void ReadKeys(const Element& root, Scene& scene, Diagnostics& out);

/// Returns all sections with this name, in order.
std::vector<const Element*> Sections(const Element& root, std::string_view name);

/// Returns the robot of the scene, in SI units.
std::optional<ImportedMjcf> BuildRobot(Scene& scene, const std::string& path,
                                       const MjcfImport& options, Diagnostics& out);

}  // namespace taut::mjcf
