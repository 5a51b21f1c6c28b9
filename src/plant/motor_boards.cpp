#include "plant/motor_boards.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/assert.h"
#include "math/random.h"
#include "plant/board_lane.h"
#include "plant/fault_bits.h"
#include "plant/random_streams.h"

namespace taut::plant {
namespace {

constexpr double kTick_s = 0.001;

/// State that sensors and controller share.
class Boards {
 public:
  explicit Boards(const ControlSetup& setup)
      : def_(setup.experiment.robot.def), cables_(description::ActuatedCables(def_)) {
    for (const int cable : cables_) {
      names_.push_back(def_.cables[static_cast<std::size_t>(cable)].name);
      if (description::GainsOf(setup.experiment.controllers, cable) != nullptr) {
        mode_ = board::Mode::kImpedance;
      }
    }
    lanes_.resize(setup.lanes.size(), Lane(cables_.size()));
    for (std::size_t j = 0; j < lanes_.size(); ++j) Restart(j, *setup.lanes[j]);
  }

  void Restart(std::size_t lane, const RolloutWorld& world) {
    const BoardsSpec* const spec = BoardsOf(world.controllers);
    TAUT_ASSERT(spec != nullptr);
    Lane& of = lanes_[lane];
    of.spec = *spec;
    of.seed = world.seed;
    of.every = Ticks(spec->broadcast_s);
    of.delay = Ticks(spec->broadcast_delay_s);
    for (std::size_t m = 0; m < cables_.size(); ++m) {
      const CableDef& cable = def_.cables[static_cast<std::size_t>(cables_[m])];
      of.m_per_count[m] =
          description::LengthPerCount(*cable.actuator.dc_motor, spec->encoder_lines);
    }
    of.boards.Configure(*spec, def_, cables_, world.controllers);
  }

  /// Reads load cells and encoders of a lane. The first tick starts its boards.
  void Read(std::size_t lane, std::int64_t tick, const Observation& exact) {
    Lane& of = lanes_[lane];
    const double* const rest_m = exact.shaft_m ? exact.shaft_m : exact.cables.rest_length_m;
    for (std::size_t m = 0; m < cables_.size(); ++m) {
      const std::size_t at = At(m, lane);
      if (tick == 0) of.start_m[m] = rest_m[at];
      const double noise = of.spec.load_cell.noise_counts > 0 ? Noise(of.seed, tick, m) : 0.0;
      const double counts = std::floor((of.start_m[m] - rest_m[at]) / of.m_per_count[m]);
      of.inputs[m] = {LoadCellCode(of.spec.load_cell, exact.cables.tension_n[at], noise),
                      static_cast<std::int64_t>(counts)};
    }
    if (tick == 0) of.boards.Start(of.inputs);
  }

  /// Runs a tick of a lane and sets its commands.
  void Tick(std::size_t lane, std::int64_t tick, Commands& commands) {
    Lane& of = lanes_[lane];
    const double time_s = static_cast<double>(tick) * kTick_s;
    if (tick % of.every == 0) {
      for (std::size_t m = 0; m < cables_.size(); ++m) {
        const std::size_t at = At(m, lane);
        of.values[m] = mode_ == board::Mode::kPosition
                           ? commands.rest_length_m[at]
                           : of.spec.velocity_input_scale * commands.velocity_input_m_per_s[at];
      }
    }
    // The first broadcast, at the start, changes the mode.
    const bool broadcast = tick % of.every == of.delay || tick == 0;
    if (broadcast) {
      // After a fault, the boards hold all motors, as the driver of a robot does.
      const bool holds = time_s < of.spec.hold_s - 1e-9 || of.boards.HasFault();
      of.boards.Broadcast(holds ? board::Mode::kHold : mode_, of.spec.capture, of.values);
    }
    of.boards.Tick(of.inputs, time_s);
    if (broadcast) of.boards.ReadStatus(tick <= of.delay ? 0.0 : of.spec.broadcast_s);
    for (std::size_t m = 0; m < cables_.size(); ++m) {
      const std::size_t at = At(m, lane);
      const int motor = static_cast<int>(m);
      commands.mode[at] = of.boards.IsPowered(motor) ? CommandMode::kDuty : CommandMode::kOff;
      commands.duty[at] = of.boards.Duty(motor);
      commands.set_point_n[at] = of.boards.readings(motor).set_point_n;
    }
  }

  const std::vector<int>& cables() const { return cables_; }
  const MotorReadings& readings(std::size_t lane, std::size_t motor) const {
    return lanes_[lane].boards.readings(static_cast<int>(motor));
  }
  std::size_t lanes() const { return lanes_.size(); }
  const ModelDef& def() const { return def_; }
  std::string Faults(std::size_t lane) const { return lanes_[lane].boards.Faults(names_); }
  /// Returns the index of a motor's cable in the rows of a plant.
  std::size_t At(std::size_t motor, std::size_t lane) const {
    return static_cast<std::size_t>(cables_[motor]) * lanes_.size() + lane;
  }

  void Serialize(LaneState& state) {
    Lane& of = lanes_[static_cast<std::size_t>(state.lane())];
    of.boards.Serialize(state);
    for (std::size_t m = 0; m < cables_.size(); ++m) {
      state.Values(of.start_m[m], of.inputs[m].code, of.inputs[m].counts, of.values[m]);
    }
  }

 private:
  /// Boards of one robot. Vectors have one entry per motor.
  struct Lane {
    explicit Lane(std::size_t motors)
        : boards(static_cast<int>(motors)),
          m_per_count(motors),
          start_m(motors),
          inputs(motors),
          values(motors) {}
    BoardsSpec spec;
    std::uint64_t seed = 0;
    std::int64_t every = 1, delay = 0;  ///< Period and delay of broadcasts [ticks].
    BoardLane boards;
    std::vector<double> m_per_count;  ///< Cable length per encoder count [m].
    std::vector<double> start_m;      ///< Rest lengths at the first tick.
    std::vector<MotorInputs> inputs;
    std::vector<double> values;  ///< V0 [m/s] or rest lengths [m] of the next broadcast.
  };

  static std::int64_t Ticks(double time_s) {
    return static_cast<std::int64_t>(std::floor(time_s / kTick_s + 0.5));
  }

  double Noise(std::uint64_t seed, std::int64_t tick, std::size_t motor) const {
    const std::uint64_t sample = static_cast<std::uint64_t>(tick) * def_.cables.size() +
                                 static_cast<std::uint64_t>(cables_[motor]);
    return math::Random(seed, kBoardLoadCellNoise, sample).Normal();
  }

  const ModelDef& def_;
  std::vector<int> cables_;  ///< Per motor.
  std::vector<std::string> names_;
  board::Mode mode_ = board::Mode::kPosition;
  std::vector<Lane> lanes_;
};

class BoardSensors final : public SensorModel {
 public:
  explicit BoardSensors(std::shared_ptr<Boards> boards) : boards_(std::move(boards)) {
    const std::size_t size = boards_->def().cables.size() * boards_->lanes();
    EachReading([size](std::vector<double>& row) { row.resize(size); }, seen_);
    shown_.cables = MapReadings([](const std::vector<double>& row) { return row.data(); }, seen_);
    faults_.resize(size);
  }

  ClockSpec clock() const override { return {kTick_s, 0.0}; }
  void Restart(int lane, const RolloutWorld& world) override {
    boards_->Restart(static_cast<std::size_t>(lane), world);
  }

  void Sample(const Tick& tick, const Observation& exact) override {
    shown_.lanes = exact.lanes;
    shown_.time_s = exact.time_s;
    shown_.bodies = exact.bodies;
    shown_.goal = exact.goal;
    shown_.faults = faults_.data();
    const std::size_t lanes = boards_->lanes();
    for (std::size_t j = 0; j < lanes; ++j) {
      if (!Has(tick.due, static_cast<int>(j))) continue;
      boards_->Read(j, tick.number[j], exact);
      // Cables without an actuator have no sensors.
      if (tick.number[j] == 0) ShowExact(j, exact);
      for (std::size_t m = 0; m < boards_->cables().size(); ++m) Show(j, m);
    }
  }
  const Observation& seen() const override { return shown_; }

  void Serialize(LaneState& state) override {
    boards_->Serialize(state);
    EachReading([&state](std::vector<double>& row) { state.Row(row); }, seen_);
    state.Row(faults_);
  }

 private:
  void ShowExact(std::size_t lane, const Observation& exact) {
    for (std::size_t i = lane; i < faults_.size(); i += boards_->lanes()) {
      const int cable = static_cast<int>(i / boards_->lanes());
      const CableDef& def = boards_->def().cables[static_cast<std::size_t>(cable)];
      seen_.stiffness_n_per_m[i] = exact.cables.stiffness_n_per_m[i];
      const bool has_motor = def.actuator.kind != ActuatorDef::Kind::kNone;
      faults_[i] = has_motor ? kFaultNone : kFaultNoReading;
      seen_.rest_length_m[i] = seen_.length_m[i] = def.rest_length_m;
      seen_.rate_m_per_s[i] = seen_.tension_n[i] = seen_.elastic_n[i] = 0;
    }
  }
  void Show(std::size_t lane, std::size_t motor) {
    const std::size_t i = boards_->At(motor, lane);
    const MotorReadings& from = boards_->readings(lane, motor);
    seen_.rest_length_m[i] = from.rest_length_m;
    seen_.length_m[i] = from.length_m;
    seen_.rate_m_per_s[i] = from.rate_m_per_s;
    seen_.tension_n[i] = from.tension_n;
    seen_.elastic_n[i] = from.tension_n > 0 ? from.tension_n : 0.0;
    faults_[i] = FaultBitsOf(from.faults);
  }

  std::shared_ptr<Boards> boards_;
  CableReadings<std::vector<double>> seen_;
  std::vector<std::uint32_t> faults_;
  Observation shown_;
};

class BoardController final : public Controller {
 public:
  explicit BoardController(std::shared_ptr<Boards> boards) : boards_(std::move(boards)) {}

  ClockSpec clock() const override { return {kTick_s, 0.0}; }
  void Act(const Tick& tick, const Observation& /*seen*/, Commands& commands) override {
    for (std::size_t j = 0; j < boards_->lanes(); ++j) {
      if (Has(tick.due, static_cast<int>(j))) boards_->Tick(j, tick.number[j], commands);
    }
  }
  std::string Faults(int lane) const override {
    return boards_->Faults(static_cast<std::size_t>(lane));
  }

 private:
  std::shared_ptr<Boards> boards_;
};

}  // namespace

MotorBoards MakeBoards(const ControlSetup& setup) {
  const auto boards = std::make_shared<Boards>(setup);
  return {std::make_unique<BoardSensors>(boards), std::make_unique<BoardController>(boards)};
}

}  // namespace taut::plant
