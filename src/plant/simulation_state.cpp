// Snapshots of a simulation's worlds. The browser build excludes this file, since it cannot write
// the resolved experiment, from which the snapshots' hash is computed.
#include "base/hash.h"
#include "plant/simulation_impl.h"

namespace taut {

plant::Sealing Simulation::Impl::Seal() {
  if (kind == 0) {
    base::Fnv1a hash;
    hash.AddText("simulation");
    hash.AddText(std::to_string(extensions.controllers.size()));
    hash.AddText(extensions.sensors ? "own sensors" : "");
    hash.AddText(batch_options.friction ? "own friction" : "");
    hash.AddText(ResolvedYaml(experiment));
    kind = hash.value();
  }
  return {"simulation", kind,
          "both must have the same experiment, number of custom controllers, custom sensors and "
          "custom friction law"};
}

std::uint64_t Simulation::Impl::HashOf(plant::Variant& variant) const {
  if (variant.hash == 0) {
    base::Fnv1a hash;
    hash.AddText(ResolvedYaml(ExperimentOf(experiment, variant.world)));
    for (const double number : variant.world.numbers) hash.AddNumber(number);
    variant.hash = hash.value();
  }
  return variant.hash;
}

std::shared_ptr<plant::Variant> Simulation::Impl::VariantWith(std::uint64_t hash, int world) {
  if (HashOf(*SlotOf(world).variant) == hash) return SlotOf(world).variant;
  for (plant::WorldSlot& slot : slots) {
    if (HashOf(*slot.variant) == hash) return slot.variant;
  }
  for (const auto& variant : created) {
    if (HashOf(*variant) == hash) return variant;
  }
  return nullptr;
}

namespace {

/// Header of a world's bytes.
struct Head {
  std::uint64_t variant = 0, size = 0, forces = 0;
  void Serialize(plant::LaneState& state) { state.Values(variant, size, forces); }
  static constexpr std::size_t kBytes = 3 * sizeof(std::uint64_t);
};

/// Serialized size of an `ExternalForce`, which is smaller than its size in memory because of
/// padding.
constexpr std::size_t kForceBytes = sizeof(int) + sizeof(Vec3);

}  // namespace

plant::Bytes Simulation::Impl::StateOf(int world) {
  plant::SimulationGroup& group = *groups[static_cast<std::size_t>(world / lanes)];
  plant::WorldSlot& slot = SlotOf(world);
  plant::Bytes saved;
  plant::LaneState state(LaneOf(world), lanes, saved);
  const plant::Bytes bytes = group.batch.Save(LaneOf(world));
  Head head{HashOf(*slot.variant), bytes.size(), slot.forces.size()};
  head.Serialize(state);
  saved.insert(saved.end(), bytes.begin(), bytes.end());
  for (ExternalForce& force : slot.forces) {
    state.Value(force.node);
    state.Value(force.force_n);
  }
  group.loop.Serialize(state);
  return saved;
}

bool Simulation::Impl::Put(int world, std::span<const std::uint8_t> saved,
                           std::shared_ptr<plant::Variant> variant) {
  plant::SimulationGroup& group = *groups[static_cast<std::size_t>(world / lanes)];
  const int lane = LaneOf(world);
  plant::LaneState first(lane, lanes, saved);
  Head head;
  head.Serialize(first);
  if (first.failed() || head.size > saved.size() - Head::kBytes ||
      head.forces > saved.size() / kForceBytes) {
    return false;
  }
  const auto bytes = saved.subspan(Head::kBytes, static_cast<std::size_t>(head.size));
  if (!group.batch.Restore(lane, {bytes.begin(), bytes.end()})) return false;
  plant::WorldSlot& slot = SlotOf(world);
  slot.variant = std::move(variant);
  slot.recording.reset();
  group.loop.Restart(lane, slot.variant->world);
  plant::LaneState state(lane, lanes, saved.subspan(Head::kBytes + bytes.size()));
  slot.forces.assign(static_cast<std::size_t>(head.forces), {});
  for (ExternalForce& force : slot.forces) {
    state.Value(force.node);
    state.Value(force.force_n);
    if (force.node < 0 || force.node >= static_cast<int>(def().nodes.size())) return false;
  }
  group.loop.SetHandForces(lane, slot.forces);
  group.loop.Serialize(state);
  return state.at_end();
}

std::vector<std::uint8_t> Simulation::Save(int world) {
  impl_->GroupOf(__func__, world);
  return impl_->Seal().Seal(impl_->StateOf(world));
}

bool Simulation::Restore(std::span<const std::uint8_t> snapshot, Diagnostics& out, int world) {
  impl_->GroupOf(__func__, world);
  const auto saved = impl_->Seal().Open(snapshot, out);
  if (!saved) return false;
  plant::LaneState first(0, 1, *saved);
  Head head;
  head.Serialize(first);
  const std::shared_ptr<plant::Variant> variant = impl_->VariantWith(head.variant, world);
  if (!variant) {
    out.Error("snapshot.other_variant", {},
              "the snapshot belongs to a variant that this simulation does not have",
              "create both simulations with the same variants");
    return false;
  }
  const plant::Bytes before = impl_->StateOf(world);
  const std::shared_ptr<plant::Variant> variant_before = impl_->SlotOf(world).variant;
  if (impl_->Put(world, *saved, variant)) return true;
  impl_->Put(world, before, variant_before);
  out.Error("snapshot.other_controllers", {},
            "the snapshot belongs to a simulation with other custom controllers or sensors",
            "use the same custom controllers and sensors in both simulations");
  return false;
}

}  // namespace taut
