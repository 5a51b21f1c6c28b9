#include "plant/loop.h"

#include <algorithm>

#include "base/assert.h"
#include "plant/controller_kinds.h"
#include "plant/goal.h"
#include "plant/motor_boards.h"
#include "plant/sensors.h"

namespace taut::plant {

Loop::Loop(const ExperimentSpec& experiment, std::span<const RolloutWorld* const> lanes,
           Plant& plant, const Extensions& extensions, int first_world)
    : experiment_(experiment),
      plant_(plant),
      many_(dynamic_cast<ManySteps*>(&plant)),
      count_(static_cast<int>(lanes.size())),
      plant_lanes_(plant.Observe().lanes),
      schedules_(1, Schedule(experiment.step_s, experiment.duration_s)),
      step_s_(static_cast<std::size_t>(plant_lanes_)),
      to_s_(step_s_.size()),
      check_(experiment.robot.def.cables, plant_lanes_),
      watches_readings_(plant.world() == nullptr || extensions.sensors) {
  TAUT_ASSERT(0 < count_ && count_ <= plant_lanes_);
  std::vector<const RolloutWorld*> all(lanes.begin(), lanes.end());
  all.resize(step_s_.size(), lanes[0]);
  const ControlSetup setup{experiment, all, first_world, count_};
  // Lanes without results have timelines, too: they restart with the first lane
  // (Simulation::Reset).
  for (int j = 0; j < plant_lanes_; ++j) timelines_.emplace_back(experiment);
  has_forces_ = !timelines_[0].idle();
  const auto add = [&](std::unique_ptr<SensorModel> model) {
    const LaneClock clock(model->clock(), plant_lanes_);
    sensors_.push_back({std::move(model), clock});
  };
  if (experiment.goal) add(std::make_unique<GoalSensor>(setup));
  if (experiment.sensors) {
    std::vector<std::uint64_t> seeds;
    for (const RolloutWorld* lane : all) seeds.push_back(lane->seed);
    add(std::make_unique<Sensors>(*experiment.sensors, experiment.robot.def.cables.size(),
                                  std::move(seeds)));
  }
  MotorBoards boards;
  if (BoardsOf(experiment.controllers) != nullptr && plant.commands().duty != nullptr) {
    boards = MakeBoards(setup);
    add(std::move(boards.sensors));
  }
  if (extensions.sensors) add(extensions.sensors(setup));
  for (auto& controller : MakeControllers(setup, extensions)) {
    const LaneClock clock(controller->clock(), plant_lanes_);
    laws_.push_back({std::move(controller), clock, {}});
  }
  const std::size_t own = laws_.size() - extensions.controllers.size();
  for (std::size_t i = own; i < laws_.size(); ++i) {
    laws_[i].custom = "custom controller " + std::to_string(i - own) + " sets";
  }
  if (own < laws_.size()) check_.Keep(plant_.commands());  // allocates memory in advance
  if (boards.controller) {
    const LaneClock clock(boards.controller->clock(), plant_lanes_);
    laws_.push_back({std::move(boards.controller), clock, {}});
  }
}

Lanes Loop::AtBoundary() const {
  if (schedules_.size() == 1) return schedules_[0].AtBoundary() ? AllLanes(plant_lanes_) : 0;
  Lanes at_boundary = 0;
  for (int j = 0; j < plant_lanes_; ++j) {
    if (ScheduleOf(j).AtBoundary()) at_boundary |= Lanes{1} << j;
  }
  return at_boundary;
}

void Loop::Sense(Lanes among) {
  if (sensors_.empty()) return;
  const Lanes at_boundary = AtBoundary() & among;
  if (at_boundary == 0) return;
  const Observation* seen = &plant_.Observe();
  const double* const time_s = seen->time_s;
  for (Sensor& sensor : sensors_) {
    const Tick tick = sensor.clock.Due(time_s, at_boundary);
    if (tick.due != 0) {
      sensor.model->Sample(tick, *seen);
      sensor.clock.Advance(tick.due);
    }
    seen = &sensor.model->seen();
  }
}

void Loop::Prepare(Lanes among) {
  const Lanes at_boundary = AtBoundary() & among;
  if (at_boundary == 0) return;
  Sense(among);
  const double* const time_s = plant_.Observe().time_s;
  const auto acts = [&](Law& law) { return law.clock.Due(time_s, at_boundary).due != 0; };
  const bool reads = watches_readings_ && std::any_of(laws_.begin(), laws_.end(), acts);
  const Lanes readable = reads ? check_.WithReadings(seen(), at_boundary) : at_boundary;
  const auto time_of = [time_s](int lane) { return time_s[lane]; };
  for (Law& law : laws_) {
    Tick tick = law.clock.Due(time_s, at_boundary);
    if (tick.due == 0) continue;
    const Lanes due = tick.due;
    tick.due &= readable;
    if (!law.custom.empty()) check_.Keep(plant_.commands());
    if (tick.due != 0) law.controller->Act(tick, seen(), plant_.commands());
    if (!law.custom.empty()) check_.PutBack(plant_.commands(), tick.due, time_of, law.custom);
    law.clock.Advance(due);
  }
  for (std::size_t j = 0; j < schedules_.size(); ++j) {
    if (Has(at_boundary, static_cast<int>(j))) {
      schedules_[j].Aim(NextBoundary(static_cast<int>(j)));
    }
  }
}

void Loop::SplitSchedules() {
  if (plant_lanes_ > 1) schedules_.resize(step_s_.size(), schedules_[0]);
}

void Loop::AdvanceSchedules(int count) {
  for (Schedule& schedule : schedules_) {
    for (int i = 0; i < count; ++i) schedule.Advance();
  }
  if (schedules_.size() == 1) {
    const double step_s = schedules_[0].step_s(), to_s = schedules_[0].time_s();
    for (std::size_t j = 0; j < step_s_.size(); ++j) step_s_[j] = step_s, to_s_[j] = to_s;
  } else {
    for (std::size_t j = 0; j < schedules_.size(); ++j) {
      step_s_[j] = schedules_[j].step_s();
      to_s_[j] = schedules_[j].time_s();
    }
  }
}

void Loop::WatchCommands() {
  if (!watches_commands_) check_.Keep(plant_.commands());
  watches_commands_ = true;
}

void Loop::Step(Lanes active) {
  const bool some_wait = active != AllLanes(plant_lanes_);
  if (some_wait) SplitSchedules();
  if (watches_commands_) {
    const auto time_of = [this](int lane) { return time_s(lane); };
    check_.PutBack(plant_.commands(), active, time_of, "the program sets");
  }
  Prepare(active);
  if (watches_commands_) check_.Keep(plant_.commands());
  if (has_forces_) Push(active);
  if (some_wait) {
    for (int j = 0; j < plant_lanes_; ++j) {
      const auto i = static_cast<std::size_t>(j);
      if (Has(active, j)) schedules_[i].Advance();
      step_s_[i] = Has(active, j) ? schedules_[i].step_s() : 0;
      to_s_[i] = schedules_[i].time_s();
    }
  } else {
    AdvanceSchedules(1);
  }
  plant_.Advance(step_s_.data(), to_s_.data());
}

int Loop::Steps(int most) {
  Prepare();
  std::int64_t count = many_ != nullptr && !has_forces_ ? most : 1;
  for (const Schedule& schedule : schedules_) {
    const bool alike = schedule.step_s() == schedules_[0].step_s();
    count = alike ? std::min(count, schedule.left()) : 1;
  }
  if (count < 2) {
    Step();
    return 1;
  }
  AdvanceSchedules(static_cast<int>(count));
  many_->AdvanceMany(step_s_[0], static_cast<int>(count), to_s_.data());
  return static_cast<int>(count);
}

void Loop::Push(Lanes active) {
  World* const world = plant_.world();
  for (int j = 0; world != nullptr && j < count_; ++j) {
    if (!Has(active, j)) continue;
    const Schedule& schedule = ScheduleOf(j);
    timelines_[static_cast<std::size_t>(j)].Apply(*world, j, schedule.time_s(), schedule.step_s());
  }
}

void Loop::Restart(int lane, const RolloutWorld& world) {
  TAUT_ASSERT(0 <= lane && lane < plant_lanes_);
  const auto j = static_cast<std::size_t>(lane);
  SplitSchedules();
  schedules_[j] = Schedule(experiment_.step_s, experiment_.duration_s);
  timelines_[j].Restart();
  for (Sensor& sensor : sensors_) {
    sensor.model->Restart(lane, world);
    sensor.clock.Restart(lane);
  }
  for (Law& law : laws_) {
    law.controller->Restart(lane, world);
    law.clock.Restart(lane);
  }
  plant_.Restart(lane);
  check_.Restart(lane);
}

void Loop::Retune(int lane, const std::vector<ControllerSpec>& controllers) {
  for (Law& law : laws_) law.controller->Retune(lane, controllers);
}

void Loop::Serialize(LaneState& state) {
  const auto lane = static_cast<std::size_t>(state.lane());
  schedules_[schedules_.size() == 1 ? 0 : lane].Serialize(state);
  timelines_[lane].Serialize(state);
  has_forces_ = has_forces_ || !timelines_[lane].idle();
  for (Sensor& sensor : sensors_) {
    sensor.model->Serialize(state);
    sensor.clock.Serialize(state);
  }
  for (Law& law : laws_) {
    law.controller->Serialize(state);
    law.clock.Serialize(state);
  }
  plant_.Serialize(state);
}

/// Returns the time of the next tick or of the next corner of the timeline.
double Loop::NextBoundary(int lane) const {
  const auto timeline = static_cast<std::size_t>(lane < count_ ? lane : 0);
  double next = timelines_[timeline].NextCorner(time_s(lane));
  for (const Sensor& sensor : sensors_) next = std::min(next, sensor.clock.NextS(lane));
  for (const Law& law : laws_) next = std::min(next, law.clock.NextS(lane));
  return next;
}

std::optional<ImpedanceGains> Loop::Gains(int lane, int cable) const {
  for (const Law& law : laws_) {
    if (auto gains = law.controller->Gains(lane, cable)) return gains;
  }
  return std::nullopt;
}

std::string Loop::Faults(int lane) const {
  std::string faults;
  for (const Law& law : laws_) {
    const std::string text = law.controller->Faults(lane);
    if (!text.empty()) faults += (faults.empty() ? "" : "; ") + text;
  }
  return faults;
}

bool Loop::SetGains(int lane, const ImpedanceGains& gains) {
  const FiniteCheck::Named numbers[] = {{"tension_offset_n", gains.tension_offset_n},
                                        {"length_offset_m", gains.length_offset_m},
                                        {"position_gain_n_per_m", gains.position_gain_n_per_m},
                                        {"velocity_gain_n_s_per_m", gains.velocity_gain_n_s_per_m},
                                        {"velocity_offset_m_per_s", gains.velocity_offset_m_per_s}};
  if (!Accepts(lane, "cable", CableName(gains.cable), numbers)) return false;
  return std::any_of(laws_.begin(), laws_.end(),
                     [&](Law& law) { return law.controller->SetGains(lane, gains); });
}

void Loop::SetRestLength(int lane, int cable, double rest_length_m) {
  const FiniteCheck::Named number{"rest_length_m", rest_length_m};
  if (!Accepts(lane, "cable", CableName(cable), {&number, 1})) return;
  for (Law& law : laws_) {
    if (law.controller->Hold(lane, cable, rest_length_m)) return;
  }
  plant_.commands().rest_length_m[static_cast<std::ptrdiff_t>(cable) * plant_lanes_ + lane] =
      rest_length_m;
}

void Loop::SetHandForces(int lane, std::vector<ExternalForce> forces) {
  has_forces_ = has_forces_ || !forces.empty();
  timelines_[static_cast<std::size_t>(lane)].SetHandForces(std::move(forces));
}

}  // namespace taut::plant
