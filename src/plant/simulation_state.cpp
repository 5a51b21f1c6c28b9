// Snapshots of a simulation's worlds. Not in the browser build, which writes no experiments.
#include "base/assert.h"
#include "base/hash.h"
#include "plant/simulation_impl.h"

namespace taut {

plant::Sealing Simulation::Impl::Seal() {
  if (kind == 0) {
    base::Fnv1a hash;
    hash.AddText("simulation");
    hash.AddText(ResolvedYaml(experiment));
    kind = hash.value();
  }
  return {"simulation", kind, "both simulations must be of the same experiment"};
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
  return nullptr;
}

std::vector<std::uint8_t> Simulation::Save(int world) {
  plant::SimulationGroup& group = impl_->GroupOf(__func__, world);
  plant::WorldSlot& slot = impl_->SlotOf(world);
  const int lane = impl_->LaneOf(world);
  plant::Bytes saved;
  plant::LaneState state(lane, impl_->lanes, saved);
  const plant::Bytes bytes = group.batch.Save(lane);
  std::uint64_t variant = impl_->HashOf(*slot.variant), size = bytes.size(),
                forces = slot.forces.size();
  state.Values(variant, size, forces);
  saved.insert(saved.end(), bytes.begin(), bytes.end());
  for (ExternalForce& force : slot.forces) {
    state.Value(force.node);
    state.Value(force.force_n);
  }
  group.loop.Serialize(state);
  return impl_->Seal().Seal(saved);
}

bool Simulation::Restore(std::span<const std::uint8_t> snapshot, Diagnostics& out, int world) {
  plant::SimulationGroup& group = impl_->GroupOf(__func__, world);
  const auto saved = impl_->Seal().Open(snapshot, out);
  if (!saved) return false;
  const int lane = impl_->LaneOf(world);
  plant::LaneState head(lane, impl_->lanes, *saved);
  std::uint64_t hash = 0, size = 0, count = 0;
  head.Values(hash, size, count);
  constexpr std::size_t kHead = 3 * sizeof(std::uint64_t);
  const std::shared_ptr<plant::Variant> variant = impl_->VariantWith(hash, world);
  if (!variant) {
    out.Error("snapshot.other_variant", {},
              "the snapshot is of a variant that no world of this simulation has",
              "create both simulations with the same variants, or reset a world to the variant");
    return false;
  }
  const auto bytes = saved->subspan(kHead, static_cast<std::size_t>(size));
  if (!group.batch.Restore(lane, {bytes.begin(), bytes.end()})) {
    out.Error("snapshot.other_model", {},
              "the state in the snapshot does not belong to this model");
    return false;
  }
  plant::WorldSlot& slot = impl_->SlotOf(world);
  slot.variant = variant;
  group.loop.Restart(lane, variant->world);
  plant::LaneState state(lane, impl_->lanes, saved->subspan(kHead + bytes.size()));
  slot.forces.assign(static_cast<std::size_t>(count), {});
  for (ExternalForce& force : slot.forces) {
    state.Value(force.node);
    state.Value(force.force_n);
  }
  group.loop.SetHandForces(lane, slot.forces);
  group.loop.Serialize(state);
  TAUT_ASSERT(state.at_end());
  return true;
}

}  // namespace taut
