// Elimination order of all bodies of a world with joints, for the solver in lanes
// (solve/world_primal.inl).
#include <vector>

#include "sim/data/scratch_memory.h"
#include "sim/data/tables.h"

namespace taut::sim {
namespace {

/// Returns whether the solver in lanes has the laws of all constraints of the model, and whether
/// the model alone determines which bodies its constraints connect.
bool FitsWorldPrimal(const Tables& t) {
  if (t.joints.empty() || !t.motions.empty() || t.chain_count > 0 || !t.touches.empty()) {
    return false;
  }
  if (t.body_count > BlockPattern::kMostInTable) return false;
  for (int b = 0; b < t.body_count; ++b) {
    if (!t.Moves(b)) return false;
  }
  return true;
}

}  // namespace

void OrderWorld(Tables& t) {
  t.world_pattern = {nullptr, nullptr, nullptr, 0, 0, 0};
  if (!FitsWorldPrimal(t)) return;
  const int n = t.body_count;
  const auto count = static_cast<std::size_t>(n);
  std::vector<std::uint64_t> bits(count * static_cast<std::size_t>(BodyGraph::WordsFor(n)));
  BodyGraph graph{bits.data(), n, BodyGraph::WordsFor(n)};
  graph.Clear();
  for (const JointTable& j : t.joints) {
    if (j.a_moves && j.b_moves) graph.Join(j.a, j.b);
  }
  for (const CableTable& cable : t.cables) {
    const AttachmentTable* const ends = t.attachments.data() + cable.first_attachment;
    for (int i = 0; i < cable.attachment_count; ++i) {
      for (int k = 0; k < i; ++k) {
        if (ends[i].body < n && ends[k].body < n) graph.Join(ends[i].body, ends[k].body);
      }
    }
  }
  t.world_number.resize(count), t.world_bodies.resize(count);
  t.world_slot.resize(count * count), t.world_below.resize(count * count);
  t.world_first_below.resize(count + 1);
  BlockPattern pattern{
      t.world_slot.data(), t.world_below.data(), t.world_first_below.data(), 0, 0, 0};
  if (!Eliminate(graph, kMostPrimalBlocks, t.world_bodies.data(), t.world_number.data(), pattern)) {
    return;
  }
  t.world_pattern = pattern;
}

}  // namespace taut::sim
