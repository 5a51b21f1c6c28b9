#include "plant/simulation_impl.h"

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <utility>

#include "plant/start_finder.h"
#include "taut/start.h"

namespace taut {

void plant::Names::WrongName(const char* function, const ModelDef& def,
                             std::string_view name) const {
  Diagnostics problem;
  find_(def, name, &problem);
  std::fprintf(stderr, "taut: %s: %s", function, problem.Format().c_str());
  std::abort();
}

void Simulation::Impl::MakeSlots(const SimulationOptions& options) {
  const std::span<const RolloutWorld> variants = options.variants;
  slots.resize(variants.empty() ? static_cast<std::size_t>(options.worlds) : variants.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (variants.empty() && i > 0) {
      slots[i].variant = slots[0].variant;
    } else {
      slots[i].variant = std::make_shared<plant::Variant>();
      slots[i].variant->world = variants.empty() ? WorldOf(experiment) : variants[i];
      created.push_back(slots[i].variant);
    }
  }
}

bool Simulation::Impl::FindStarts(std::span<plant::WorldSlot> of,
                                  const std::function<bool()>& keep_going, Diagnostics& out) {
  WorldBatchOptions alone;
  alone.friction = batch_options.friction;
  std::vector<std::unique_ptr<plant::StartFinder>> finders(
      static_cast<std::size_t>(pool.threads()));
  std::vector<Diagnostics> found(of.size());
  std::mutex one_at_a_time;
  std::atomic<bool> stopped{false};
  const auto go_on = [&] {
    if (keep_going && !stopped) {
      const std::lock_guard lock(one_at_a_time);
      if (!keep_going()) stopped = true;
    }
    return !stopped;
  };
  auto work = [&](int thread, std::size_t i) {
    if (stopped) return;
    auto& finder = finders[static_cast<std::size_t>(thread)];
    if (!finder) finder = std::make_unique<plant::StartFinder>(model, alone);
    plant::Variant& variant = *of[i].variant;
    std::optional<SettledStart> settled;
    auto start =
        finder->Find(ExperimentOf(experiment, variant.world), found[i], nullptr, go_on, &settled);
    if (start) variant.start = std::make_shared<const plant::Bytes>(std::move(*start));
    if (start && settled) WarnOfStart(settled->change, found[i]);
  };
  pool.ForEach(of.size(), work);
  const auto named = [&](Diagnostic one, std::size_t world) {
    if (of.size() > 1) one.what = "world " + std::to_string(world) + ": " + one.what;
    return one;
  };
  for (std::size_t i = 0; i < of.size(); ++i) {
    for (const Diagnostic& error : found[i].items()) out.AddError(named(error, i));
    for (const Diagnostic& warning : found[i].warnings()) out.AddWarning(named(warning, i));
  }
  return std::all_of(of.begin(), of.end(),
                     [](const plant::WorldSlot& s) { return s.variant->start; });
}

void Simulation::Impl::MakeGroups(std::optional<Simd> simd) {
  batch_options.simd = SimdOf({.worlds = static_cast<int>(slots.size()), .simd = simd});
  batch_options.worlds = lanes = static_cast<int>(*batch_options.simd);
  groups.resize((slots.size() + static_cast<std::size_t>(lanes) - 1) /
                static_cast<std::size_t>(lanes));
  auto work = [&](int, std::size_t g) {
    std::vector<const RolloutWorld*> variants;
    for (int j = 0; j < CountIn(g); ++j) {
      variants.push_back(&SlotOf(static_cast<int>(g) * lanes + j).variant->world);
    }
    groups[g] = std::make_unique<plant::SimulationGroup>(experiment, model, batch_options, variants,
                                                         extensions, static_cast<int>(g) * lanes);
    for (int j = 0; j < CountIn(g); ++j) PutToStart(static_cast<int>(g) * lanes + j);
    groups[g]->loop.Prepare();
  };
  pool.ForEach(groups.size(), work);
}

void Simulation::Impl::PutToStart(int world) {
  plant::SimulationGroup& group = *groups[static_cast<std::size_t>(world / lanes)];
  const plant::Bytes& start = *SlotOf(world).variant->start;
  const int lane = LaneOf(world);
  group.batch.Restore(lane, start);
  const int count = CountIn(static_cast<std::size_t>(world / lanes));
  for (int j = count; lane == 0 && j < lanes; ++j) group.batch.Restore(j, start);
}

void Simulation::Impl::StepLanes(std::size_t g, Lanes active) {
  plant::SimulationGroup& group = *groups[g];
  // Unused lanes of the last group step with its first world, so that all lanes can be stepped at
  // once.
  if (Has(active, 0)) active |= AllLanes(lanes) & ~AllLanes(CountIn(g));
  group.loop.Step(active);
  for (int j = 0; j < CountIn(g); ++j) {
    const int world = static_cast<int>(g) * lanes + j;
    const auto& recording = SlotOf(world).recording;
    if (Has(active, j) && recording && recording->IsDue(group.loop.time_s(j))) RecordRow(world);
  }
}

void Simulation::Impl::RecordRow(int world) {
  plant::SimulationGroup& group = *groups[static_cast<std::size_t>(world / lanes)];
  auto& recording = SlotOf(world).recording;
  const auto& row = group.recorder.Row(plant::SourceOf(group.loop, LaneOf(world)));
  if (recording->Append(group.loop.time_s(LaneOf(world)), row) != nullptr) recording.reset();
}

}  // namespace taut
