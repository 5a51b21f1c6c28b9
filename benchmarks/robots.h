/// Robots of the benchmarks, and a common interface to run them in every engine.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "benchmarks/peers/peer.h"
#include "taut/world_batch.h"

namespace taut::bench {

inline constexpr double kStepS = 0.001;
inline constexpr int kControlSteps = 10;  ///< Rest lengths are commanded at 100 Hz.

/// Returns a model of share/models/ on the ground.
ModelDef OnGround(const std::string& robot);

/// Returns a model of share/models/, or "six_strut_stiff", whose cables are rows of the solver,
/// above hills with `corners` grid points along each side; 0: above a plane.
ModelDef OnHills(const std::string& robot, int corners);
/// Returns a ball that rolls at 1 m/s, ideally without end, over level triangles.
ModelDef BallOnTriangles();
/// Shifts the worlds along, so that each stands on other hills.
void SpreadOut(WorldBatch& batch);

/// Returns Tetraspine3 with another number of segments, on the ground.
ModelDef Spine(int segments);

/// Returns a disc that stands on `contacts` feet on the ground and is dragged back and forth by a
/// cable.
ModelDef Footed(int contacts);

/// Returns a swinging chain of rods of 0.1 m on ball joints with the given friction each.
ModelDef SwingingChain(int rods, double friction_n_m);

/// Rest lengths of all cables against time: a sine of 1 Hz and 2 % about the described length, with
/// a different phase for each cable of each world. Tabulated, so that it costs the engines nothing.
class Motion {
 public:
  explicit Motion(const ModelDef& def);
  int cables() const { return static_cast<int>(rest_m_.size()); }
  int period() const { return static_cast<int>(factor_.size()); }  ///< In ticks.
  double RestLength(int world, int cable, int tick) const;

 private:
  std::vector<double> rest_m_;
  std::vector<double> factor_;
};

/// Worlds of a robot in an engine, which stand and move.
class Runner {
 public:
  Runner() = default;
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;
  virtual ~Runner() = default;
  virtual void Run(int control_periods) = 0;
  virtual int worlds() const = 0;
  virtual double contacts() = 0;               ///< Of the first world.
  virtual BodyState Body(int body) const = 0;  ///< Of the first world.
  /// Returns whether every contact solve since the start reached its tolerance, as far as the
  /// engine reports it.
  virtual bool converged() const = 0;
};

/// Runner for taut. Throws an exception if a world is not finite or has too many contacts.
class TautRunner final : public Runner {
 public:
  TautRunner(const ModelDef& def, const WorldBatchOptions& options,
             int control_steps = kControlSteps);
  void Run(int control_periods) override;
  int worlds() const override { return batch_.worlds(); }
  double contacts() override { return static_cast<double>(batch_.Contacts(0).size()); }
  BodyState Body(int body) const override { return batch_.Body(0, body); }
  bool converged() const override { return converged_; }
  WorldBatch& batch() { return batch_; }
  int joints() const { return static_cast<int>(batch_.model().def().joints.size()); }
  /// Mean over the first world's steps, sampled at the last step of each period.
  double linear_solves() const { return linear_solves_ / tick_; }

 private:
  Motion motion_;
  WorldBatch batch_;
  std::vector<double> targets_m_;  ///< Of all cables of all worlds.
  int control_steps_;
  bool converged_ = true;
  double linear_solves_ = 0;  ///< Sum over the periods.
  int tick_ = 0;
};

/// Returns the depth of the first world's robot in the ground, by taut's geometry [m].
double Deepest(const ModelDef& def, const Runner& runner);

class PeerRunner final : public Runner {
 public:
  PeerRunner(peers::Engine engine, const ModelDef& def, const peers::Options& options);
  void Run(int control_periods) override;
  int worlds() const override { return 1; }
  double contacts() override { return world_->ContactCount(); }
  BodyState Body(int body) const override { return world_->Body(body); }
  bool converged() const override { return world_->UnsolvedSteps() == 0; }

 private:
  Motion motion_;
  std::unique_ptr<peers::World> world_;
  int tick_ = 0;
};

}  // namespace taut::bench
