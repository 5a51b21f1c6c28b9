/// Collision shapes: capsules and spheres, boxes, convex hulls, terrain surfaces.
///
/// A new kind needs a value of `ShapeKind`; a struct with `kKind` and a function `Moved`; a member
/// of `Shape` and a line in `WithShape`; a file with `Touch` and `Distance`; and declarations of
/// both in shape_contacts.h for every kind that it may meet. A missing pair does not compile. All
/// of this is part of a step: no standard library, no heap, no function pointers.
#pragma once

namespace taut::sim {

/// In `Touch(a, b)`, the kind of `a` is not after the kind of `b` in this order.
enum class ShapeKind { kRound, kBox, kHull, kSurface };

/// Sphere (from = to) or capsule.
struct RoundShape {
  static constexpr ShapeKind kKind = ShapeKind::kRound;
  double from[3], to[3];
  double radius_m;
};

/// Box; the rows of `axes` are its unit axes.
struct BoxShape {
  static constexpr ShapeKind kKind = ShapeKind::kBox;
  double center[3], axes[9], half_m[3];
};

struct HullTable;
struct SurfaceTable;

/// Pose of a frame: x -> r x + origin.
struct ShapePose {
  double r[9];  ///< Row-major.
  double origin[3];
};

/// Convex body with flat faces (hull.h).
struct HullShape {
  static constexpr ShapeKind kKind = ShapeKind::kHull;
  const HullTable* table;
  ShapePose at;  ///< Pose of the frame of the table.
};

/// Static triangles (surface.h).
struct SurfaceShape {
  static constexpr ShapeKind kKind = ShapeKind::kSurface;
  const SurfaceTable* table;
};

inline void Turn(const ShapePose& pose, const double* p, double* out) noexcept {
  for (int i = 0; i < 3; ++i) {
    const double* const row = pose.r + 3 * i;
    out[i] = row[0] * p[0] + row[1] * p[1] + row[2] * p[2];
  }
}
inline void Move(const ShapePose& pose, const double* p, double* out) noexcept {
  for (int i = 0; i < 3; ++i) {
    const double* const row = pose.r + 3 * i;
    out[i] = pose.origin[i] + row[0] * p[0] + row[1] * p[1] + row[2] * p[2];
  }
}

inline RoundShape Moved(const RoundShape& shape, const ShapePose& pose) noexcept {
  RoundShape moved;
  Move(pose, shape.from, moved.from);
  Move(pose, shape.to, moved.to);
  moved.radius_m = shape.radius_m;
  return moved;
}
inline BoxShape Moved(const BoxShape& shape, const ShapePose& pose) noexcept {
  BoxShape moved;
  Move(pose, shape.center, moved.center);
  for (int i = 0; i < 3; ++i) {
    Turn(pose, shape.axes + 3 * i, moved.axes + 3 * i);
    moved.half_m[i] = shape.half_m[i];
  }
  return moved;
}
inline HullShape Moved(const HullShape& shape, const ShapePose& pose) noexcept {
  HullShape moved;
  moved.table = shape.table;
  Move(pose, shape.at.origin, moved.at.origin);
  for (int k = 0; k < 3; ++k) {
    const double column[3] = {shape.at.r[k], shape.at.r[3 + k], shape.at.r[6 + k]};
    double turned[3];
    Turn(pose, column, turned);
    for (int i = 0; i < 3; ++i) moved.at.r[3 * i + k] = turned[i];
  }
  return moved;
}

inline SurfaceShape Moved(const SurfaceShape& shape, const ShapePose&) noexcept { return shape; }

/// Shape of any kind; only the member of its `kind` is valid.
struct Shape {
  ShapeKind kind = ShapeKind::kRound;
  RoundShape round = {};
  BoxShape box = {};
  HullShape hull = {};
  SurfaceShape surface = {};
};

/// Returns the distance of the surface from the skeleton (points and lines).
inline double RadiusOf(const Shape& shape) noexcept {
  return shape.kind == ShapeKind::kRound ? shape.round.radius_m : 0.0;
}

/// Calls `use` with the struct of the kind of the shape.
template <class Use>
auto WithShape(const Shape& shape, const Use& use) noexcept {
  switch (shape.kind) {
    case ShapeKind::kRound:
      return use(shape.round);
    case ShapeKind::kBox:
      return use(shape.box);
    case ShapeKind::kHull:
      return use(shape.hull);
    case ShapeKind::kSurface:
      return use(shape.surface);
  }
  __builtin_unreachable();
}

}  // namespace taut::sim
