#include "plant/motor_boards.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/assert.h"
#include "math/random.h"
#include "plant/board_lane.h"
#include "plant/random_streams.h"

namespace taut::plant {
namespace {

constexpr double kTick_s = 0.001;

/// State that sensors and controller share. Motor m of lane j is at [m * lanes + j].
class Boards {
 public:
  explicit Boards(const ControlSetup& setup)
      : def_(setup.experiment.robot.def),
        cables_(description::ActuatedCables(def_)),
        lanes_(setup.lanes.size()),
        specs_(lanes_, *BoardsOf(setup.experiment.controllers)),
        seeds_(lanes_),
        boards_(lanes_, BoardLane(static_cast<int>(cables_.size()))),
        start_m_(lanes_ * cables_.size()),
        inputs_(lanes_, std::vector<MotorInputs>(cables_.size())),
        values_(lanes_, std::vector<double>(cables_.size())) {
    mode_ = board::Mode::kPosition;
    for (const int cable : cables_) {
      names_.push_back(def_.cables[static_cast<std::size_t>(cable)].name);
      if (description::GainsOf(setup.experiment.controllers, cable) != nullptr) {
        mode_ = board::Mode::kImpedance;
      }
    }
    for (std::size_t j = 0; j < lanes_; ++j) Restart(j, *setup.lanes[j]);
  }

  void Restart(std::size_t lane, const RolloutWorld& world) {
    const BoardsSpec* const spec = BoardsOf(world.controllers);
    TAUT_ASSERT(spec != nullptr);
    specs_[lane] = *spec;
    seeds_[lane] = world.seed;
    boards_[lane].Configure(*spec, def_, cables_, world.controllers);
  }

  /// Reads load cells and encoders of a lane. The first tick starts its boards.
  void Read(std::size_t lane, std::int64_t tick, const Observation& exact) {
    const BoardsSpec& spec = specs_[lane];
    for (std::size_t m = 0; m < cables_.size(); ++m) {
      const std::size_t at = static_cast<std::size_t>(cables_[m]) * lanes_ + lane;
      const double* const rest_m = exact.shaft_m ? exact.shaft_m : exact.cables.rest_length_m;
      double& start_m = start_m_[m * lanes_ + lane];
      if (tick == 0) start_m = rest_m[at];
      const double noise = spec.load_cell.noise_counts > 0 ? Noise(lane, tick, m) : 0.0;
      const DcMotorDef& motor =
          *def_.cables[static_cast<std::size_t>(cables_[m])].actuator.dc_motor;
      inputs_[lane][m] = {
          LoadCellCode(spec.load_cell, exact.cables.tension_n[at], noise),
          static_cast<std::int64_t>(std::floor(
              (start_m - rest_m[at]) / description::LengthPerCount(motor, spec.encoder_lines)))};
    }
    if (tick == 0) boards_[lane].Start(inputs_[lane]);
  }

  /// Runs a tick of a lane and sets its commands.
  void Tick(std::size_t lane, std::int64_t tick, Commands& commands) {
    const BoardsSpec& spec = specs_[lane];
    BoardLane& boards = boards_[lane];
    const std::int64_t every = Ticks(spec.broadcast_s), delay = Ticks(spec.broadcast_delay_s);
    const double time_s = static_cast<double>(tick) * kTick_s;
    std::vector<double>& values = values_[lane];
    if (tick % every == 0) {
      for (std::size_t m = 0; m < cables_.size(); ++m) {
        const std::size_t at = static_cast<std::size_t>(cables_[m]) * lanes_ + lane;
        values[m] = mode_ == board::Mode::kPosition
                        ? commands.rest_length_m[at]
                        : spec.velocity_input_scale * commands.velocity_input_m_per_s[at];
      }
    }
    // The first broadcast, at the start, changes the mode.
    const bool broadcast = tick % every == delay || tick == 0;
    if (broadcast) {
      // Like the driver of a robot, which holds all motors after a fault.
      const bool holds = time_s < spec.hold_s - 1e-9 || boards.HasFault();
      boards.Broadcast(holds ? board::Mode::kHold : mode_, spec.capture, values);
    }
    boards.Tick(inputs_[lane], time_s);
    if (broadcast) boards.ReadStatus(tick <= delay ? 0.0 : spec.broadcast_s);
    for (std::size_t m = 0; m < cables_.size(); ++m) {
      const std::size_t at = static_cast<std::size_t>(cables_[m]) * lanes_ + lane;
      const int motor = static_cast<int>(m);
      commands.mode[at] = boards.IsPowered(motor) ? CommandMode::kDuty : CommandMode::kOff;
      commands.duty[at] = boards.Duty(motor);
      commands.set_point_n[at] = boards.readings(motor).set_point_n;
    }
  }

  const std::vector<int>& cables() const { return cables_; }
  const MotorReadings& readings(std::size_t lane, std::size_t motor) const {
    return boards_[lane].readings(static_cast<int>(motor));
  }
  std::size_t lanes() const { return lanes_; }
  const ModelDef& def() const { return def_; }
  std::string Faults(std::size_t lane) const { return boards_[lane].Faults(names_); }

  void Serialize(LaneState& state) {
    const auto lane = static_cast<std::size_t>(state.lane());
    boards_[lane].Serialize(state);
    state.Row(start_m_);
    for (MotorInputs& of : inputs_[lane]) state.Values(of.code, of.counts);
    for (double& value : values_[lane]) state.Value(value);
  }

 private:
  static std::int64_t Ticks(double time_s) {
    return static_cast<std::int64_t>(std::floor(time_s / kTick_s + 0.5));
  }

  double Noise(std::size_t lane, std::int64_t tick, std::size_t motor) const {
    const std::uint64_t sample = static_cast<std::uint64_t>(tick) * def_.cables.size() +
                                 static_cast<std::uint64_t>(cables_[motor]);
    return math::Random(seeds_[lane], kBoardLoadCellNoise, sample).Normal();
  }

  const ModelDef& def_;
  std::vector<int> cables_;  ///< Per motor.
  std::size_t lanes_;
  std::vector<BoardsSpec> specs_;
  std::vector<std::uint64_t> seeds_;
  std::vector<BoardLane> boards_;
  board::Mode mode_;
  std::vector<double> start_m_;  ///< Row of the motors: rest length at the first tick.
  std::vector<std::vector<MotorInputs>> inputs_;  ///< Per lane.
  std::vector<std::vector<double>> values_;       ///< Per lane: V0 or rest lengths of a broadcast.
  std::vector<std::string> names_;
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
    const auto cable = static_cast<std::size_t>(boards_->cables()[motor]);
    const std::size_t i = cable * boards_->lanes() + lane;
    const MotorReadings& from = boards_->readings(lane, motor);
    seen_.rest_length_m[i] = from.rest_length_m;
    seen_.length_m[i] = from.length_m;
    seen_.rate_m_per_s[i] = from.rate_m_per_s;
    seen_.tension_n[i] = from.tension_n;
    seen_.elastic_n[i] = from.tension_n > 0 ? from.tension_n : 0.0;
    std::uint32_t faults = kFaultNone;
    if ((from.faults & board::kSensor) != 0) faults |= kFaultSensor;
    if ((from.faults & ~board::kSensor) != 0) faults |= kFaultActuator;
    faults_[i] = faults;
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
