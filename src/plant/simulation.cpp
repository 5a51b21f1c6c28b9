#include "taut/simulation.h"

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "plant/simulation_impl.h"
#include "taut/minimal_experiment.h"
#include "taut/run.h"
#include "taut/time_limits.h"

namespace taut {

Simulation::Simulation(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Simulation::~Simulation() = default;

std::unique_ptr<Simulation> Simulation::Create(const ExperimentSpec& experiment,
                                               const SimulationOptions& options, Diagnostics& out) {
  if (options.variants.empty() && options.worlds < 1) {
    out.Error("simulation.no_world", {},
              "`worlds` must be at least 1, got " + std::to_string(options.worlds));
    return nullptr;
  }
  if (!CheckRecord(experiment, out)) return nullptr;
  auto impl = std::make_unique<Impl>(experiment, options);
  impl->model = Model::CompileForExperiment(impl->def(), out);
  if (!impl->model) return nullptr;
  impl->MakeSlots(options);
  const std::span<plant::WorldSlot> all(impl->slots);
  // Without variants, all worlds have the same start.
  const auto distinct = options.variants.empty() ? all.first(1) : all;
  if (!impl->FindStarts(distinct, options.keep_going, out)) return nullptr;
  impl->MakeGroups(options.simd);
  return std::unique_ptr<Simulation>(new Simulation(std::move(impl)));
}

std::unique_ptr<Simulation> Simulation::Create(const RobotSpec& robot,
                                               const SimulationOptions& options, Diagnostics& out) {
  return Create(MinimalExperiment(robot, StartKind::kAsDescribed), options, out);
}

std::unique_ptr<Simulation> Simulation::Load(const std::string& path, const Overrides& overrides,
                                             const SimulationOptions& options, Diagnostics& out) {
  const auto head = ReadFileHead(path, out);
  if (!head) return nullptr;
  if (head->kind == "model") {
    auto robot = LoadRobot(path, overrides, out);
    return robot ? Create(*robot, options, out) : nullptr;
  }
  const auto experiment = LoadExperiment(path, overrides, out);
  return experiment ? Create(*experiment, options, out) : nullptr;
}

const ExperimentSpec& Simulation::experiment() const noexcept { return impl_->experiment; }
const ModelDef& Simulation::def() const noexcept { return impl_->def(); }
int Simulation::worlds() const noexcept { return static_cast<int>(impl_->slots.size()); }

// --- time ----------------------------------------------------------------------------------------

void Simulation::Step() {
  auto work = [&](int, std::size_t g) { impl_->StepLanes(g, AllLanes(impl_->CountIn(g))); };
  impl_->pool.ForEach(impl_->groups.size(), work);
}

void Simulation::RunUntil(double time_s, const std::function<bool()>& keep_going) {
  if (!(time_s <= kLongestTime_s)) [[unlikely]] {
    std::fprintf(stderr, "taut: RunUntil: the time is %g s: valid are times up to %g s\n", time_s,
                 kLongestTime_s);
    std::abort();
  }
  auto work = [&](int, std::size_t g) {
    plant::Loop& loop = impl_->groups[g]->loop;
    for (;;) {
      Lanes active = 0;
      for (int j = 0; j < impl_->CountIn(g); ++j) {
        if (loop.time_s(j) < time_s - plant::kTimeToleranceS) active |= Lanes{1} << j;
      }
      if (active == 0 || (keep_going && !keep_going())) return;
      impl_->StepLanes(g, active);
    }
  };
  impl_->pool.ForEach(impl_->groups.size(), work);
}

double Simulation::Time(int world) const {
  return impl_->GroupOf(__func__, world).loop.time_s(impl_->LaneOf(world));
}
bool Simulation::IsRunning(int world) const {
  return impl_->GroupOf(__func__, world).loop.IsRunning(impl_->LaneOf(world));
}

// --- state ---------------------------------------------------------------------------------------

void Simulation::Reset(int world) {
  plant::SimulationGroup& group = impl_->GroupOf(__func__, world);
  plant::WorldSlot& slot = impl_->SlotOf(world);
  impl_->PutToStart(world);
  const int lane = impl_->LaneOf(world);
  group.loop.Restart(lane, slot.variant->world);
  for (int j = impl_->CountIn(static_cast<std::size_t>(world / impl_->lanes));
       lane == 0 && j < impl_->lanes; ++j) {
    group.loop.Restart(j, slot.variant->world);
  }
  slot.forces.clear();
  slot.recording.reset();
  group.loop.Prepare();
}

bool Simulation::Reset(const RolloutWorld& variant, Diagnostics& out, int world) {
  impl_->GroupOf(__func__, world);
  plant::WorldSlot changed{
      std::make_shared<plant::Variant>(plant::Variant{variant, nullptr, 0}), {}, nullptr};
  if (!impl_->FindStarts(std::span(&changed, 1), {}, out)) return false;
  impl_->SlotOf(world).variant = changed.variant;
  Reset(world);
  return true;
}

// --- recording -----------------------------------------------------------------------------------

const std::vector<ChannelInfo>& Simulation::channels() const noexcept {
  return impl_->groups[0]->recorder.channels();
}

const std::vector<double>& Simulation::Row(int world) {
  plant::SimulationGroup& group = impl_->GroupOf(__func__, world);
  return group.recorder.Row(plant::SourceOf(group.loop, impl_->LaneOf(world)));
}

void Simulation::Record(TraceWriter* writer, int world) {
  impl_->GroupOf(__func__, world);
  auto& recording = impl_->SlotOf(world).recording;
  recording.reset();
  if (writer == nullptr) return;
  recording =
      std::make_unique<plant::Recording>(impl_->experiment, std::vector{writer}, Time(world));
  impl_->RecordRow(world);
}

// --- groups --------------------------------------------------------------------------------------

int Simulation::groups() const noexcept { return static_cast<int>(impl_->groups.size()); }
int Simulation::lanes() const noexcept { return impl_->lanes; }

const Observation& Simulation::Observe(int group) const {
  sim::CheckIndex(__func__, "group", group, groups());
  return impl_->groups[static_cast<std::size_t>(group)]->loop.exact();
}
Commands& Simulation::commands(int group) {
  sim::CheckIndex(__func__, "group", group, groups());
  impl_->groups[static_cast<std::size_t>(group)]->loop.WatchCommands();
  return impl_->groups[static_cast<std::size_t>(group)]->plant->commands();
}
const World& Simulation::world(int group) const {
  sim::CheckIndex(__func__, "group", group, groups());
  return *impl_->groups[static_cast<std::size_t>(group)]->plant->world();
}
WorldBatch& Simulation::batch(int group) {
  sim::CheckIndex(__func__, "group", group, groups());
  return impl_->groups[static_cast<std::size_t>(group)]->batch;
}

}  // namespace taut
