/// Terrain boxes that touch each other or other ground form one surface: a contact with one of them
/// may be internal to the surface (docs/theory/ground.md, sections 8 and 9).
///
/// Part of a step: no standard library.
#pragma once

#include <stdint.h>

#include "sim/data/view.h"
#include "sim/geometry/passing.h"

namespace taut::sim {

/// A point where a shape touches a box of the world.
struct JoinedPoint {
  TouchPoint touch;
  int box;  ///< Among the shapes.
  bool kept;
};

/// Says which of all points of a shape, given in W, are contacts of the union of the boxes, and
/// moves them to the shape's surface, as where it meets ground.
void MarkKept(const Shape& shape, const ShapeTable* shapes, JoinedPoint* points,
              int count) noexcept;

/// Of points that close (passing.h), a bit for each that arrives where a box beside `box` goes on.
uint32_t ArrivesBeside(const MovingShape& a, const ShapeTable* shapes, int box, uint32_t closing,
                       const TouchPoint* points, int count) noexcept;

}  // namespace taut::sim
