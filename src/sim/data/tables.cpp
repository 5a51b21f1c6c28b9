// Pointer view of the tables for the step, and memory layout of a group of worlds.
#include "sim/data/tables.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace taut::sim {

View Tables::View() const noexcept {
  return {body_count,
          cable_count,
          node_count,
          plane_count,
          bound_m.data(),
          cables.data(),
          attachments.data(),
          spots.data(),
          nodes.data(),
          planes.data(),
          first_point.data(),
          points.data(),
          shapes.data(),
          static_cast<int>(shapes.size()),
          shape_pairs.data(),
          static_cast<int>(shape_pairs.size()),
          world_pairs.data(),
          static_cast<int>(world_pairs.size()),
          colliders.data(),
          static_cast<int>(colliders.size()),
          first_shape.data(),
          body_shapes.data(),
          shape_pairs_before.data(),
          apart.data(),
          first_apart.data(),
          moving_pairs.data(),
          static_cast<int>(moving_pairs.size()),
          near_capacity,
          near_m,
          def().friction_combine,
          def().restitution_combine,
          first_slot.data(),
          slot_count,
          first_pair_id,
          pair_capacity,
          max_attachments,
          static_cast<int>(attachments.size()),
          static_cast<int>(spots.size()),
          static_cast<int>(wheels.size()),
          max_wheels,
          wheels.data(),
          chain_count,
          span_count,
          static_cast<int>(slips.size()),
          chain_link_count,
          slips.data(),
          along_slip,
          !surfaces.empty(),
          kept_count,
          static_cast<int>(motors.size()),
          static_cast<int>(supplies.size()),
          motors.data(),
          supplies.data(),
          static_cast<int>(tree.size()),
          tree_shapes,
          tree.data(),
          static_cast<int>(world_shapes.size()),
          world_shapes.data(),
          static_cast<int>(touches.size()),
          touches.data(),
          static_cast<int>(touch_rods.size()),
          touch_rods.data(),
          nullptr,
          floor_m,
          static_cast<int>(shapes.size() - surfaces.size()),
          static_cast<int>(surfaces.size()),
          static_cast<int>(joints.size()),
          static_cast<int>(joint_rows.size()),
          static_cast<int>(joint_bodies.size()) -
              (joints.empty() ? 0 : static_cast<int>(motions.size())),
          turn_friction_count,
          joints.data(),
          joint_rows.data(),
          joint_bodies.data(),
          joint_number.data(),
          hinged.data(),
          &joint_pattern,
          &world_pattern,
          world_bodies.data(),
          world_number.data(),
          joint_loops,
          free_chains.empty() ? 0 : static_cast<int>(free_chains.size()) - 1,
          free_chains.data(),
          free_chain_bodies.data(),
          static_cast<int>(motions.size()),
          motions.data(),
          motion_knots.data(),
          motion_of_body.data()};
}

void LayOutFloor(Tables& t) {
  const ModelDef& def = t.def();
  t.floor_m = -std::numeric_limits<double>::infinity();
  if (t.surfaces.empty() || !def.planes.empty()) return;
  t.floor_m = -t.floor_m;
  for (const Surface& surface : t.surfaces) {
    t.floor_m = std::min(t.floor_m, surface.table().low.z);
  }
  for (const TerrainBoxDef& box : def.terrain_boxes) {
    // The bounding sphere of the box gives a lower bound of all corners.
    const Vec3& h = box.half_extents_m;
    t.floor_m = std::min(t.floor_m, box.center_m.z - std::sqrt(h.x * h.x + h.y * h.y + h.z * h.z));
  }
}

Layout Tables::MakeLayout() const {
  const struct View m = View();
  Layout l;
  for (const RowInfo& row : kStateRows) {
    l.*row.first = l.rows;
    l.rows += row.width * m.Count(row.per);
    if (row.role <= Role::kParameter) l.hash_rows = l.rows;
    if (row.role <= Role::kReading) l.snapshot_rows = l.rows;
  }
  return l;
}

}  // namespace taut::sim
