// Convex polyhedra from boxes and hulls, and their nearest point to a given point.
#include "sim/geometry/convex.h"

namespace taut::sim {
namespace {

/// Distance below which the direction from the surface to a point is undefined [m].
constexpr double kOnSurfaceM = 1e-12;

/// Topology of a box. Corner c is at + along axis k if bit k of c is set. Face 2 k + 1 is at + of
/// axis k, face 2 k at -.
struct BoxParts {
  int first_in_face[7] = {0, 4, 8, 12, 16, 20, 24};
  int in_face[24] = {};
  HullEdge edges[12] = {};
};

constexpr BoxParts MakeBoxParts() {
  BoxParts parts;
  int edge_count = 0;
  for (int k = 0; k < 3; ++k) {
    const int u = (k + 1) % 3, v = (k + 2) % 3;
    const int around[4] = {0, 1 << u, (1 << u) | (1 << v), 1 << v};
    for (int i = 0; i < 4; ++i) {
      parts.in_face[4 * (2 * k + 1) + i] = around[i] | (1 << k);
      parts.in_face[4 * (2 * k) + i] = around[3 - i];
    }
    // Edges along axis k, between face -u or +u and face -v or +v. Left and right alternate around
    // the axis.
    for (int i = 0; i < 4; ++i) {
      const int beside_u = 2 * u + (i & 1), beside_v = 2 * v + (i >> 1);
      const int from = ((i & 1) << u) | ((i >> 1) << v);
      const bool v_is_right = (i & 1) == (i >> 1);
      parts.edges[edge_count++] = {from, from | (1 << k), v_is_right ? beside_u : beside_v,
                                   v_is_right ? beside_v : beside_u};
    }
  }
  return parts;
}

constexpr BoxParts kBoxParts = MakeBoxParts();

constexpr HullTable MakeBoxTable() {
  HullTable table;
  table.corner_count = 8, table.face_count = 6, table.edge_count = 12;
  table.first_in_face = kBoxParts.first_in_face;
  table.in_face = kBoxParts.in_face;
  table.edges = kBoxParts.edges;
  return table;
}

constexpr HullTable kBoxTable = MakeBoxTable();

}  // namespace

Convex::Convex(const HullShape& hull) noexcept : table(hull.table), thin_m(hull.table->thin_m) {
  const auto turned = [&](const Vec3& p) noexcept {
    const double at[3] = {p.x, p.y, p.z};
    double out[3];
    Turn(hull.at, at, out);
    return Load(out);
  };
  const Vec3 origin = Load(hull.at.origin);
  center = turned(table->center) + origin;
  for (int i = 0; i < table->corner_count; ++i) corners[i] = turned(table->corners[i]) + origin;
  for (int i = 0; i < table->face_count; ++i) {
    normals[i] = turned(table->normals[i]);
    offsets_m[i] = table->offsets_m[i] + Dot(normals[i], origin);
  }
}

Convex::Convex(const BoxShape& box) noexcept
    : table(&kBoxTable),
      center(Load(box.center)),
      thin_m(Smaller(Smaller(box.half_m[0], box.half_m[1]), box.half_m[2])) {
  for (int i = 0; i < 8; ++i) {
    Vec3 p = center;
    for (int k = 0; k < 3; ++k) {
      p = p + ((i >> k & 1) != 0 ? 1.0 : -1.0) * box.half_m[k] * AxisOf(box, k);
    }
    corners[i] = p;
  }
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = AxisOf(box, k);
    const double at = Dot(axis, center);
    normals[2 * k] = -1.0 * axis, normals[2 * k + 1] = axis;
    offsets_m[2 * k] = box.half_m[k] - at, offsets_m[2 * k + 1] = box.half_m[k] + at;
  }
}

NearestOfConvex NearestTo(const Convex& convex, const Vec3& point) noexcept {
  int nearest_face = 0;
  double above = -1e300;
  for (int face = 0; face < convex.table->face_count; ++face) {
    const double at = convex.Above(face, point);
    if (at > above) above = at, nearest_face = face;
  }
  const Vec3 up = convex.normals[nearest_face];
  if (above <= 0.0) return {point - above * up, up, above};
  NearestOfConvex best{point, up, 1e300};
  for (int face = 0; face < convex.table->face_count; ++face) {
    const double height = convex.Above(face, point);
    if (!(height > 0.0) || height >= best.distance_m) continue;
    const Vec3 normal = convex.normals[face];
    const Vec3 foot = point - height * normal;
    bool over = true;
    convex.EachSide(face, [&](const Vec3& from, const Vec3& to) noexcept {
      const Vec3 side = to - from;
      if (Dot(Cross(normal, side), foot - from) >= 0.0) return;
      over = false;
      const Vec3 place = from + Clamp(Dot(side, point - from) / Dot(side, side), 0.0, 1.0) * side;
      const Vec3 way = point - place;
      const double distance = Norm(way);
      if (!(distance < best.distance_m)) return;
      best = {place, distance > kOnSurfaceM ? (1.0 / distance) * way : normal, distance};
    });
    if (over) best = {foot, normal, height};
  }
  return best;
}

}  // namespace taut::sim
