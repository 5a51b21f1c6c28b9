// Convex solids of a model, from a mesh file or from given corners.
#include <cmath>
#include <string>
#include <utility>

#include "base/brief.h"
#include "description/assets/mesh_file.h"
#include "description/model/model_keys.h"
#include "math/convex_hull.h"
#include "math/vec.h"

namespace taut::description {
namespace {

using base::Brief;

/// Warn if the convex hull's volume exceeds the object's volume by this factor.
constexpr double kMuchLarger = 1.05;
constexpr std::size_t kMostParts = 256;

void WarnOfHull(const SourceRef& at, const std::string& what, const ConvexText::Part& part,
                const math::ConvexHull& hull, Diagnostics& out) {
  if (static_cast<int>(hull.corners.size()) >= HullDef::kMostCorners && hull.left_out_m > 0.0) {
    out.Warning("convex.corners_left_out", at,
                what + " has " + std::to_string(part.corners_m.size()) +
                    " corners, but a hull has at most " + std::to_string(HullDef::kMostCorners) +
                    ": the farthest corner left out is " + Brief(hull.left_out_m) + " m outside",
                "corners outside the hull do not collide: simplify the mesh, or split it into "
                "several objects");
  }
  const double own = math::SixVolumes(part.corners_m, part.triangles);
  const double held = math::SixVolumes(hull.corners, math::TrianglesOf(hull));
  if (held > kMuchLarger * own) {
    out.Warning("convex.not_convex", at,
                what + " is not convex: its hull, which collides, has " + Brief(held / own) +
                    " times its volume",
                "split it into several convex objects in the file: each becomes a hull");
  }
}

math::ConvexHull HullOrComplaint(const SourceRef& at, const std::string& what,
                                 const std::vector<Vec3>& corners_m, Diagnostics& out) {
  math::ConvexHull hull = math::HullOf(corners_m, HullDef::kMostCorners);
  if (hull.corners.empty()) {
    out.Error("convex.no_volume", at, what + " has no volume",
              "expected at least four corners that are not all in one plane");
  } else if (hull.too_thin) {
    out.Error(
        "convex.too_thin", at,
        what + " is too thin for its faces to be distinguished: the farthest corner left out is " +
            Brief(hull.left_out_m) + " m outside",
        "expected a thickness of at least 1e-5 times its width");
    hull.corners.clear();
  }
  return hull;
}

/// Adds an object of a mesh file as a part. Returns false after an error.
bool AddObject(const MapReader& map, const std::string& path, const MeshFile& mesh,
               std::size_t number, ConvexText& convex) {
  Diagnostics& out = map.scope().out;
  const std::string& name = mesh.parts[number].name;
  std::string what = mesh.parts.size() == 1 ? "the mesh"
                     : name.empty()         ? "object " + std::to_string(number)
                                            : "the object \"" + name + '"';
  const MeshFile object = PartOf(mesh, number);
  Diagnostics faults;
  const bool closed =
      ReportFaults(object, true, path, {what, ", or give mass_kg, the mass of its hull"}, faults);
  if (!closed && !convex.mass.mass_kg) {
    for (const Diagnostic& fault : faults.items()) out.AddError(fault);
    return false;
  }
  ConvexText::Part part{{}, object.corners, object.triangles};
  for (Vec3& p : part.corners_m) p = convex.scale_m * p;
  const SourceRef at = map.Find("file")->at;
  what += " of " + path;
  math::ConvexHull hull = HullOrComplaint(at, what, part.corners_m, out);
  if (hull.corners.empty()) return false;
  if (!closed) {
    const Diagnostic& first = faults.items().front();
    out.Warning("convex.mass_as_hull", first.at,
                first.what + ", so the mass of " + what + " is distributed as in its hull");
    part.corners_m = hull.corners;
    part.triangles = math::TrianglesOf(hull);
  }
  WarnOfHull(at, what, part, hull, out);
  part.hull_m = std::move(hull.corners);
  convex.parts.push_back(std::move(part));
  return true;
}

void ReadParts(const MapReader& map, ConvexText& convex) {
  const std::string path = PathBeside(convex.file.at.file, convex.file.text);
  const auto mesh = ReadMeshFile(path, map.scope().out);
  if (!mesh) return;
  if (mesh->parts.size() > kMostParts) {
    map.Error("convex.too_many_parts", "file",
              path + " has " + std::to_string(mesh->parts.size()) + " objects, more than " +
                  std::to_string(kMostParts));
    return;
  }
  bool good = true;
  for (std::size_t i = 0; i < mesh->parts.size(); ++i) {
    good = AddObject(map, path, *mesh, i, convex) && good;
  }
  if (!good) convex.parts.clear();
  convex.read_file = path;
}

}  // namespace

void Check(const MapReader& map, ConvexText& convex) {
  convex.material = ToMaterial(map, convex.surface);
  if (map.Has("file")) {
    if (!map.Require("scale_m") || convex.file.text.empty() || !std::isfinite(convex.scale_m)) {
      return;
    }
    ReadParts(map, convex);
    return;
  }
  if (map.Has("scale_m")) {
    map.Error("convex.scale_without_effect", "scale_m", map.Path("scale_m") + " has no effect here",
              "leave it out, or give a `file`");
  }
  if (!map.Has("corners_m")) return;
  const SourceRef at = map.Find("corners_m")->at;
  if (convex.corners_m.size() > HullDef::kMostCorners) {
    map.scope().out.Error("convex.too_many_corners", at,
                          map.Path("corners_m") + " has " +
                              std::to_string(convex.corners_m.size()) + " corners, more than " +
                              std::to_string(HullDef::kMostCorners));
    return;
  }
  for (const Vec3& p : convex.corners_m) {
    if (!std::isfinite(p.x + p.y + p.z)) return;  // already reported
  }
  const math::ConvexHull hull = HullOrComplaint(at, "the hull", convex.corners_m, map.scope().out);
  if (hull.corners.empty()) return;
  convex.parts.push_back({hull.corners, hull.corners, math::TrianglesOf(hull)});
}

}  // namespace taut::description
