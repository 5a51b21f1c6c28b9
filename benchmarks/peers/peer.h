/// Other engines that run the very same `ModelDef` as taut: what tests and benchmarks compare
/// taut with. Nothing of taut itself uses them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "taut/batch.h"

namespace taut::peers {

enum class Engine { kMujoco, kBullet, kOde };
inline constexpr Engine kEngines[] = {Engine::kMujoco, Engine::kBullet, Engine::kOde};

/// "mujoco", "bullet", "ode".
const char* Name(Engine engine);
/// Whether this program was built with the engine.
bool Available(Engine engine);
/// The version that this program runs with, "not built in" without it.
std::string Version(Engine engine);

/// The engines' own settings. What is not here is left at the engine's default.
struct Options {
  int iterations = 10;          ///< Of Bullet's solver and of ODE's quick step.
  bool two_directions = false;  ///< Bullet: friction in both tangential directions.
  bool full_step = false;       ///< ODE: its direct solver in place of the quick step.
  bool elliptic = false;        ///< MuJoCo: elliptic in place of pyramidal friction cones.
};

/// What an engine holds for a body: in W, at the current pose.
struct MassState {
  double mass_kg = 0;
  Vec3 com_m;
  Inertia inertia_kg_m2;
};

/// One world of a model in another engine.
class World {
 public:
  World() = default;
  World(const World&) = delete;
  World& operator=(const World&) = delete;
  virtual ~World() = default;

  virtual void Step(double step_s, int count = 1) = 0;
  /// The rest length of a cable [m], at once: the peers have no motors.
  virtual void SetRestLength(int cable, double rest_length_m) = 0;

  virtual CableState Cable(int cable) const = 0;  ///< Of the current state.
  virtual BodyState Body(int body) const = 0;
  virtual MassState Mass(int body) const = 0;
  virtual int ContactCount() const = 0;  ///< Of the last step.
  /// Steps since the start that the engine says it has not solved. Only ODE's full step says so.
  virtual int UnsolvedSteps() const { return 0; }
};

/// Why the peers cannot run a model, in words; empty if they can.
std::string Unsupported(const ModelDef& def);

/// The model in MuJoCo's language, with a keyframe of its start: what the engine of that name runs,
/// for other versions of it. The model is supported.
std::string Mjcf(const ModelDef& def, const Options& options = {});
/// The heights of a field as that model takes them when it is loaded, from 0 to 1 in single
/// precision.
std::vector<float> MujocoHeights(const HeightFieldDef& field);

/// A world as `def` describes it. The engine is available and the model supported, otherwise
/// std::invalid_argument says what is wrong.
std::unique_ptr<World> MakeWorld(Engine engine, const ModelDef& def, const Options& options = {});

}  // namespace taut::peers
