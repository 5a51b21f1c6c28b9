/// Implementation of `Simulation`: groups of worlds with their variants and starts.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/thread_pool.h"
#include "plant/loop.h"
#include "plant/recording.h"
#include "plant/sealed.h"
#include "sim/batch/check_index.h"
#include "taut/find.h"
#include "taut/simulation.h"

namespace taut::plant {

using Bytes = std::vector<std::uint8_t>;

/// Variant of an experiment. Equal worlds share it.
struct Variant {
  RolloutWorld world;
  std::shared_ptr<const Bytes> start;
  /// Hash of the resolved experiment and `world.numbers`; 0: not computed yet.
  std::uint64_t hash = 0;
};

struct WorldSlot {
  std::shared_ptr<Variant> variant;
  std::vector<ExternalForce> forces;
  std::unique_ptr<Recording> recording;
};

/// Worlds that share a SIMD register.
struct SimulationGroup {
  SimulationGroup(const ExperimentSpec& experiment, const std::shared_ptr<const Model>& model,
                  const WorldBatchOptions& options, std::span<const RolloutWorld* const> lanes,
                  const Extensions& extensions, int first_world)
      : batch(model, options),
        plant(PlantOf(batch)),
        loop(experiment, lanes, *plant, extensions, first_world),
        recorder(experiment, plant.get()) {}

  WorldBatch batch;
  std::unique_ptr<Plant> plant;
  Loop loop;
  Recorder recorder;
};

/// Index of elements of one kind by name.
class Names {
 public:
  using Find = std::optional<int> (*)(const ModelDef&, std::string_view, Diagnostics*);

  template <class Elements>
  Names(const char* kind, const Elements& elements, Find find)
      : kind_(kind), count_(static_cast<int>(elements.size())), find_(find) {
    for (int i = count_; i-- > 0;) index_[elements[static_cast<std::size_t>(i)].name] = i;
  }

  int IndexOf(const char* function, const ModelDef& def, const ElementRef& element) const {
    if (!element.has_name()) {
      sim::CheckIndex(function, kind_, element.index(), count_);
      return element.index();
    }
    const auto found = index_.find(element.name());
    if (found != index_.end()) return found->second;
    WrongName(function, def, element.name());
  }

 private:
  [[noreturn]] void WrongName(const char* function, const ModelDef& def,
                              std::string_view name) const;

  const char* kind_;
  int count_;
  Find find_;
  std::unordered_map<std::string_view, int> index_;
};

}  // namespace taut::plant

namespace taut {

struct Simulation::Impl {
  Impl(const ExperimentSpec& spec, const SimulationOptions& of)
      : experiment(spec), extensions(of.extensions), pool(of.threads) {
    batch_options.friction = of.friction;
  }

  plant::SimulationGroup& GroupOf(const char* function, int world) const {
    sim::CheckIndex(function, "world", world, static_cast<int>(slots.size()));
    return *groups[static_cast<std::size_t>(world / lanes)];
  }
  int LaneOf(int world) const noexcept { return world % lanes; }
  plant::WorldSlot& SlotOf(int world) { return slots[static_cast<std::size_t>(world)]; }
  const ModelDef& def() const noexcept { return experiment.robot.def; }
  /// Returns the number of worlds in a group. Unused lanes of the last group repeat its first
  /// world.
  int CountIn(std::size_t group) const noexcept {
    return std::min(lanes, static_cast<int>(slots.size()) - static_cast<int>(group) * lanes);
  }

  /// Returns the index of a cable's value in the rows of the world's group.
  std::ptrdiff_t RowIndex(int cable, int world) const noexcept {
    return static_cast<std::ptrdiff_t>(cable) * lanes + LaneOf(world);
  }
  int ParameterIndex(const char* function, Parameter parameter, const ElementRef& of) const {
    switch (parameter) {
      case Parameter::kBodyMass:
        return bodies.IndexOf(function, def(), of);
      case Parameter::kCableStiffness:
      case Parameter::kCableDamping:
        return cables.IndexOf(function, def(), of);
      default:
        return 0;
    }
  }

  void MakeSlots(const SimulationOptions& options);
  /// Finds the start of each slot's variant, on all threads. Returns false if a variant has no
  /// start (with an error for each) or if `keep_going` returned false.
  bool FindStarts(std::span<plant::WorldSlot> of, const std::function<bool()>& keep_going,
                  Diagnostics& out);
  void MakeGroups(std::optional<Simd> simd);
  void PutToStart(int world);
  void StepLanes(std::size_t group, Lanes active);
  void RecordRow(int world);
  plant::Sealing Seal();
  std::uint64_t HashOf(plant::Variant& variant) const;
  /// Serializes a world, without a seal.
  plant::Bytes StateOf(int world);
  /// Restores a world from the bytes of `StateOf`. Returns false if they do not fit; the world's
  /// state is then invalid.
  bool Put(int world, std::span<const std::uint8_t> saved, std::shared_ptr<plant::Variant> variant);
  /// Returns the variant with this hash. Searches `world` first, then all worlds, then the variants
  /// at creation. Returns null if there is none.
  std::shared_ptr<plant::Variant> VariantWith(std::uint64_t hash, int world);

  const ExperimentSpec experiment;
  const Extensions extensions;
  std::shared_ptr<const Model> model;
  WorldBatchOptions batch_options;
  base::ThreadPool pool;
  int lanes = 1;
  std::vector<plant::WorldSlot> slots;
  std::vector<std::shared_ptr<plant::Variant>> created;  ///< Variants at creation.
  std::vector<std::unique_ptr<plant::SimulationGroup>> groups;
  std::uint64_t kind = 0;  ///< Kind of snapshots (`Sealing`); 0: not computed yet.
  plant::Names bodies{"body", experiment.robot.def.bodies, FindBody};
  plant::Names nodes{"node", experiment.robot.def.nodes, FindNode};
  plant::Names cables{"cable", experiment.robot.def.cables, FindCable};
  plant::Names joints{"joint", experiment.robot.def.joints, FindJoint};
  plant::Names motions{"motion", experiment.robot.def.motions, FindMotion};
};

}  // namespace taut
