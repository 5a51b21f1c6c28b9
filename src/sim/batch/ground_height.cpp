// Height of the planes, boxes and surfaces of the terrain at a point.
#include "sim/batch/ground_height.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/vec.h"
#include "sim/data/tables.h"
#include "sim/geometry/surface.h"

namespace taut::sim {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

double TopOf(const PlaneDef& plane, double x, double y) {
  const Vec3 &n = plane.normal, &p = plane.point_m;
  if (n.z > 0) return p.z - (n.x * (x - p.x) + n.y * (y - p.y)) / n.z;
  const bool beside = n.z == 0 && n.x * (x - p.x) + n.y * (y - p.y) > 0;
  return beside ? -kInf : kInf;
}

/// Returns the height at which a vertical line leaves a box: intersection of three slabs.
double TopOf(const TerrainBoxDef& box, double x, double y) {
  const Quat back{box.orientation.w, -box.orientation.x, -box.orientation.y, -box.orientation.z};
  const Vec3 from = Rotate(back, Vec3{x, y, 0} - Vec3{box.center_m.x, box.center_m.y, 0});
  const Vec3 up = Rotate(back, {0, 0, 1});
  const double at[] = {from.x, from.y, from.z}, along[] = {up.x, up.y, up.z};
  const double half[] = {box.half_extents_m.x, box.half_extents_m.y, box.half_extents_m.z};
  double least = -kInf, most = kInf;
  for (int k = 0; k < 3; ++k) {
    if (along[k] == 0) {
      if (std::fabs(at[k]) > half[k]) return -kInf;
      continue;
    }
    const double a = (-half[k] - at[k]) / along[k], b = (half[k] - at[k]) / along[k];
    least = std::max(least, std::min(a, b));
    most = std::min(most, std::max(a, b));
  }
  return least <= most ? box.center_m.z + most : -kInf;
}

double TopOf(const SurfaceTable& surface, double x, double y) {
  double top = -kInf;
  const auto look = [&](const SurfaceTriangle& t) noexcept {
    const Vec3 &a = t.p[0], &b = t.p[1], &c = t.p[2];
    const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (area == 0) return;  // vertical triangle: others share its edges
    const double u = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / area;
    const double v = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / area;
    constexpr double kRounding = 1e-12;  // a line through an edge must hit one of its triangles
    if (u < -kRounding || v < -kRounding || u + v > 1 + kRounding) return;
    top = std::max(top, a.z + u * (b.z - a.z) + v * (c.z - a.z));
  };
  EachTriangle(surface, {x, y, surface.low.z}, {x, y, surface.high.z}, look);
  return top;
}

}  // namespace

double GroundHeight(const Model& model, double x_m, double y_m) {
  const auto& tables = static_cast<const Tables&>(model);
  const ModelDef& def = model.def();
  double top = -kInf;
  for (const PlaneDef& plane : def.planes) top = std::max(top, TopOf(plane, x_m, y_m));
  for (const TerrainBoxDef& box : def.terrain_boxes) top = std::max(top, TopOf(box, x_m, y_m));
  for (const Surface& surface : tables.surfaces) {
    top = std::max(top, TopOf(surface.table(), x_m, y_m));
  }
  return top;
}

}  // namespace taut::sim
