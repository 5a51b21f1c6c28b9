/// The robots that are measured, and one way to run them for every engine.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "benchmarks/peers/peer.h"
#include "taut/batch.h"

namespace taut::bench {

inline constexpr double kStepS = 0.001;
inline constexpr int kControlSteps = 10;  ///< Rest lengths are commanded at 100 Hz.

/// A model of share/models/ on the ground.
ModelDef OnGround(const std::string& robot);

/// A model of share/models/, or "six_strut_stiff", whose cables are rows of the solver, above hills
/// with so many corners along each side; 0: above a plane.
ModelDef OnHills(const std::string& robot, int corners);
/// A ball that rolls at 1 m/s, and would for ever, over level triangles.
ModelDef BallOnTriangles();
/// Each world a bit further along, so that each stands on other hills.
void SpreadOut(Batch& batch);

/// Tetraspine3 with another number of segments, on the ground.
ModelDef Spine(int segments);

/// A disc that stands on `contacts` feet on the ground and is dragged to and fro by a cable.
ModelDef Footed(int contacts);

/// Rods of 0.1 m on balls that swing, each ball with that much friction.
ModelDef SwingingChain(int rods, double friction_n_m);

/// All cables' rest lengths against time: a sine of 1 Hz and 2 % about the described length, each
/// cable of each world with a phase of its own. Looked up, so that it costs engines nothing.
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

/// Worlds of a robot in some engine, which stand and move.
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
  /// Whether every contact solve since the start reached its tolerance, as far as the engine says.
  virtual bool converged() const = 0;
};

/// taut. A world that is not finite or has too many contacts becomes an exception.
class TautRunner final : public Runner {
 public:
  TautRunner(const ModelDef& def, const BatchOptions& options, int control_steps = kControlSteps);
  void Run(int control_periods) override;
  int worlds() const override { return batch_.worlds(); }
  double contacts() override { return static_cast<double>(batch_.Contacts(0).size()); }
  BodyState Body(int body) const override { return batch_.Body(0, body); }
  bool converged() const override { return converged_; }
  Batch& batch() { return batch_; }
  int joints() const { return static_cast<int>(batch_.model().def().joints.size()); }
  /// Of the first world's steps, in the mean: each period's last.
  double linear_solves() const { return linear_solves_ / tick_; }

 private:
  Motion motion_;
  Batch batch_;
  std::vector<double> targets_m_;  ///< Of all cables of all worlds.
  int control_steps_;
  bool converged_ = true;
  double linear_solves_ = 0;  ///< Sum over the periods.
  int tick_ = 0;
};

/// How deep the robot of the first world is in the ground, by taut's geometry [m].
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
