/// Other physics engines that run the same `ModelDef` as taut, for comparison in tests and
/// benchmarks. taut does not use them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "taut/world_batch.h"

namespace taut::peers {

enum class Engine { kMujoco, kBullet, kOde };
inline constexpr Engine kEngines[] = {Engine::kMujoco, Engine::kBullet, Engine::kOde};

/// Returns "mujoco", "bullet" or "ode".
const char* Name(Engine engine);
/// Returns whether this program was built with the engine.
bool Available(Engine engine);
/// Returns the version that this program runs with; "not built in" without the engine.
std::string Version(Engine engine);

/// Settings of the engines. All others keep the engine's defaults.
struct Options {
  int iterations = 10;          ///< Of Bullet's solver and of ODE's quick step.
  bool two_directions = false;  ///< Bullet: friction in both tangential directions.
  bool full_step = false;       ///< ODE: direct solver instead of the quick step.
  bool elliptic = false;        ///< MuJoCo: elliptic instead of pyramidal friction cones.
};

/// Mass properties of a body in an engine: in W, at the current pose.
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
  /// Sets the rest length of a cable [m] immediately: the peers have no motors.
  virtual void SetRestLength(int cable, double rest_length_m) = 0;

  virtual CableState Cable(int cable) const = 0;  ///< Of the current state.
  virtual BodyState Body(int body) const = 0;
  virtual MassState Mass(int body) const = 0;
  virtual int ContactCount() const = 0;  ///< Of the last step.
  /// Returns the number of steps since the start that the engine reported as unsolved. Only ODE's
  /// full step reports this.
  virtual int UnsolvedSteps() const { return 0; }
};

/// Returns the reason why the peers cannot run a model; empty if they can.
std::string Unsupported(const ModelDef& def);

/// Returns the model as MJCF, with a keyframe of its start, as the MuJoCo peer runs it; for other
/// versions of MuJoCo. The model must be supported.
std::string Mjcf(const ModelDef& def, const Options& options = {});
/// Returns the heights of a field in the form in which that model loads them: 0 to 1, single
/// precision.
std::vector<float> MujocoHeights(const HeightFieldDef& field);

/// Returns a world as `def` describes it. Throws std::invalid_argument with the reason if the
/// engine is not available or the model is not supported.
std::unique_ptr<World> MakeWorld(Engine engine, const ModelDef& def, const Options& options = {});

}  // namespace taut::peers
