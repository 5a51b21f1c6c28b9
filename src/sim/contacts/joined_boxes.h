/// Adjacent terrain boxes and other adjacent terrain form one surface. A contact with one of the
/// boxes may then be inside this surface (docs/theory/ground.md, sections 8 and 9).
///
/// A step includes this header, so it does not use the standard library.
#pragma once

#include <stdint.h>

#include "sim/data/view.h"
#include "sim/geometry/swept_test.h"

namespace taut::sim {

/// Contact point of a shape with a static box.
struct JoinedPoint {
  TouchPoint touch;
  int box;  ///< Index among the shapes.
  bool kept;
};

/// Marks the points of a shape, given in W, that are contacts with the union of the boxes. Moves
/// them to the surface of the shape, like contacts with surfaces.
void MarkKept(const Shape& shape, const ShapeTable* shapes, JoinedPoint* points,
              int count) noexcept;

/// Returns a bit mask of the closing points (swept_test.h) that reach an adjacent box or other
/// adjacent terrain instead of `box`.
uint32_t ArrivesBeside(const MovingShape& a, const ShapeTable* shapes, int box, uint32_t closing,
                       const TouchPoint* points, int count) noexcept;

}  // namespace taut::sim
