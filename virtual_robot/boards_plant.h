/// A robot whose cables emulated boards control, as a plant (taut/plant.h): an experiment's gait
/// becomes the V0 of broadcasts every 10 ms, its gains parameters of the boards. A PC in virtual
/// time.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "taut/board/parameters.h"
#include "taut/board/protocol.h"
#include "taut/plant.h"
#include "virtual_robot/motor_plant.h"
#include "virtual_robot/robot.h"

namespace taut::virtual_robot {

/// What differs from what the boards have by default: a parameter of every motor.
struct BoardSetting {
  std::uint8_t parameter = 0;  ///< `board::MotorParameter`.
  float value = 0;
};

struct BoardsOptions {
  RobotOptions robot;
  std::vector<BoardSetting> settings;  ///< After what follows from model and experiment.
  Time period = 10 * kMillisecond;     ///< Of broadcasts.
};

/// What the PC has received of a board, as it came last.
struct Heard {
  board::Status status;
  Time at = -1;                                    ///< Never, while negative.
  std::array<std::uint8_t, board::kMores> more{};  ///< `board::More`, each as it was said last.
};

/// One lane. The robot is held on a stand until `Prepare` is through: boards began, parameters set,
/// references set, armed, holding.
class BoardsPlant final : public taut::Plant {
 public:
  /// The experiment's impedance controller says what the boards are told. Both outlive it.
  BoardsPlant(const ExperimentSpec& experiment, MotorPlant& motors, const BoardsOptions& options);

  /// False and complaints if a board does not answer or refuses.
  bool Prepare(Diagnostics& out);

  const Observation& Observe() override;
  Commands& commands() override { return simulation_->commands(); }
  void Advance(const double* step_s, const double* to_s) override;
  void Restart(int lane) override { simulation_->Restart(lane); }
  bool Goes(int lane) const override { return simulation_->Goes(lane); }
  World* world() noexcept override { return simulation_->world(); }

  /// Called when all boards have been read.
  std::function<void(double time_s)> on_cycle;
  const std::vector<Heard>& heard() const { return heard_; }
  std::int64_t bad_frames() const { return bad_frames_; }
  /// Ticks of all boards that came late since the experiment began; asks them.
  int LateTicks();
  std::int64_t late_cycles() const {
    return late_cycles_;
  }  ///< That had not ended when the next was due.
  /// From a cycle's begin to its last frame [s].
  double mean_cycle_s() const {
    return cycles_ > 0 ? cycle_sum_s_ / static_cast<double>(cycles_) : 0;
  }
  double longest_cycle_s() const { return longest_cycle_s_; }
  Robot& robot() { return robot_; }

 private:
  bool Ask(std::uint8_t board, const board::Asking& asking, board::Reply* reply, Diagnostics& out);
  bool SetUp(Diagnostics& out);
  bool ReadNonces(Diagnostics& out);
  int CountLateTicks();
  bool Set(int motor, board::MotorParameter parameter, double value, Diagnostics& out);
  std::vector<Bytes> CycleFrames();
  void TakeReply(const Bytes& reply);
  void Exchange();  ///< A cycle, letting time pass: while the robot is held.
  void Poll();      ///< As far as a cycle under way has come.

  const ExperimentSpec& experiment_;
  MotorPlant& motors_;
  BoardsOptions options_;
  std::unique_ptr<taut::Plant> simulation_;
  Robot robot_;
  Observation seen_;
  double time_s_ = 0;
  Time started_ = 0;  ///< Where the experiment's time is 0.
  board::Cyclic say_;
  std::array<std::uint16_t, board::kBoards> nonces_{};
  std::vector<Heard> heard_;
  std::vector<Bytes> frames_;  ///< Of the cycle under way.
  std::size_t sent_ = 0, answered_ = 0;
  Time next_cycle_ = 0, cycle_begun_ = 0;
  std::int64_t bad_frames_ = 0, late_cycles_ = 0, cycles_ = 0;
  int late_before_ = 0;  ///< Ticks, while the boards were set up.
  double cycle_sum_s_ = 0, longest_cycle_s_ = 0;
};

}  // namespace taut::virtual_robot
