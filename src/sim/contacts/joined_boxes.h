/// Terrain boxes that touch each other or other ground form one surface: a contact with one of them
/// may be internal to the surface (docs/theory/ground.md, sections 8 and 9).
///
/// Part of a step: no standard library.
#pragma once

#include <stdint.h>

#include "sim/data/view.h"
#include "sim/geometry/swept_test.h"

namespace taut::sim {

/// A contact point of a shape with a box of the world.
struct JoinedPoint {
  TouchPoint touch;
  int box;  ///< Index among the shapes.
  bool kept;
};

/// Marks the points of a shape, given in W, that are contacts with the union of the boxes, and
/// moves them to the shape's surface, like contacts with ground.
void MarkKept(const Shape& shape, const ShapeTable* shapes, JoinedPoint* points,
              int count) noexcept;

/// Returns a bit mask of the closing points (passing.h) that arrive where a box adjacent to `box`,
/// or other ground, continues.
uint32_t ArrivesBeside(const MovingShape& a, const ShapeTable* shapes, int box, uint32_t closing,
                       const TouchPoint* points, int count) noexcept;

}  // namespace taut::sim
