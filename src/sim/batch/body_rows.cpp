// Direct access to the rows of body positions and velocities of a batch.
#include "taut/body_rows.h"

#include "sim/batch/batch_inside.h"
#include "sim/batch/check_index.h"

namespace taut {

BodyRows RowsOfBodies(WorldBatch& batch, int group) noexcept {
  const BatchInside::Impl& d = BatchInside::Of(batch);
  sim::CheckIndex(__func__, "group", group, batch.groups());
  // Without bodies, the rows are empty and may start after the last row.
  const auto first = [&](int row) {
    return d.groups[static_cast<std::size_t>(group)].rows + row * d.lanes();
  };
  return {d.lanes(), group * d.lanes(), first(d.layout.pos), first(d.layout.vel)};
}

std::ptrdiff_t GroupStride(WorldBatch& batch) noexcept {
  const auto& groups = BatchInside::Of(batch).groups;
  return groups.size() < 2 ? 0 : groups[1].rows - groups[0].rows;
}

}  // namespace taut
