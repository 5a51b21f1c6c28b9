// Convex solids of a model, from a file or by their corners.
#include <cmath>
#include <string>
#include <utility>

#include "base/brief.h"
#include "description/mesh_file.h"
#include "description/model_keys.h"
#include "math/convex_hull.h"
#include "math/vec.h"

namespace taut::description {
namespace {

using base::Brief;

/// A hull that encloses so many times what its object does is worth a word.
constexpr double kMuchLarger = 1.05;
constexpr std::size_t kMostParts = 256;

/// What is complained about: the place of `convex`, and the object in its file.
struct Subject {
  SourceRef at;
  std::string what;
};

void WarnOfHull(const Subject& subject, const ConvexText::Part& part, const math::ConvexHull& hull,
                std::size_t corners, Diagnostics& out) {
  if (static_cast<int>(hull.corners.size()) >= HullDef::kMostCorners && hull.left_out_m > 0.0) {
    out.Warning(subject.at,
                subject.what + " has " + std::to_string(corners) + " corners: of those that " +
                    std::to_string(HullDef::kMostCorners) + " hold, others are up to " +
                    Brief(hull.left_out_m) + " m outside",
                "they do not touch anything; fewer corners, or more objects, say where");
  }
  const double own = math::SixVolumes(part.corners_m, part.triangles);
  const double held = math::SixVolumes(hull.corners, math::TrianglesOf(hull));
  if (held > kMuchLarger * own) {
    out.Warning(subject.at,
                subject.what + " is not convex: its hull, which is what touches, has " +
                    Brief(held / own) + " times its volume",
                "several convex objects in the file are as many hulls");
  }
}

/// False after a complaint.
bool AddPart(const Subject& subject, ConvexText::Part part, ConvexText& convex, Diagnostics& out) {
  math::ConvexHull hull = math::HullOf(part.corners_m, HullDef::kMostCorners);
  if (hull.corners.empty()) {
    out.Error(subject.at, subject.what + " has no volume",
              "corners that are not all in one plane, four at least");
    return false;
  }
  if (part.triangles.empty()) {
    part.corners_m = hull.corners;
    part.triangles = math::TrianglesOf(hull);
  } else if (const std::string why = math::WhyNotClosed(part.corners_m, part.triangles);
             !why.empty()) {
    out.Error(subject.at, subject.what + why, "without an inside it has no mass");
    return false;
  } else {
    WarnOfHull(subject, part, hull, part.corners_m.size(), out);
  }
  part.hull_m = std::move(hull.corners);
  convex.parts.push_back(std::move(part));
  return true;
}

/// The triangles from one number up to another, with their corners.
ConvexText::Part PartOf(const MeshFile& mesh, std::size_t first, std::size_t end, double scale_m) {
  ConvexText::Part part;
  std::vector<int> number(mesh.corners.size(), -1);
  for (std::size_t t = first; t < end; ++t) {
    std::array<int, 3> triangle = mesh.triangles[t];
    for (int& corner : triangle) {
      int& known = number[static_cast<std::size_t>(corner)];
      if (known < 0) {
        known = static_cast<int>(part.corners_m.size());
        part.corners_m.push_back(scale_m * mesh.corners[static_cast<std::size_t>(corner)]);
      }
      corner = known;
    }
    part.triangles.push_back(triangle);
  }
  return part;
}

void ReadParts(const MapReader& map, ConvexText& convex) {
  Diagnostics& out = map.scope().out;
  const std::string path = PathBeside(convex.file.at.file, convex.file.text);
  const auto mesh = ReadMeshFile(path, out);
  if (!mesh) return;
  if (mesh->parts.size() > kMostParts) {
    map.Error("file", path + " has " + std::to_string(mesh->parts.size()) + " objects, more than " +
                          std::to_string(kMostParts));
    return;
  }
  for (std::size_t i = 0; i < mesh->parts.size(); ++i) {
    const bool last = i + 1 == mesh->parts.size();
    const std::size_t end = last ? mesh->triangles.size() : mesh->parts[i + 1].first_triangle;
    const std::string& name = mesh->parts[i].name;
    const Subject subject{
        map.Find("file")->at,
        mesh->parts.size() == 1
            ? path
            : "object " + (name.empty() ? std::to_string(i) : '"' + name + '"') + " of " + path};
    if (AddPart(subject, PartOf(*mesh, mesh->parts[i].first_triangle, end, convex.scale_m), convex,
                out)) {
      continue;
    }
    convex.parts.clear();
    return;
  }
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
    map.Error("scale_m", map.Path("scale_m") + " has no effect here", "it goes with a file");
  }
  if (!map.Has("corners_m")) return;
  const SourceRef at = map.Find("corners_m")->at;
  if (convex.corners_m.size() > HullDef::kMostCorners) {
    map.scope().out.Error(at, map.Path("corners_m") + " are " +
                                  std::to_string(convex.corners_m.size()) + ", more than " +
                                  std::to_string(HullDef::kMostCorners));
    return;
  }
  for (const Vec3& p : convex.corners_m) {
    if (!std::isfinite(p.x + p.y + p.z)) return;  // complained about
  }
  AddPart({at, "the hull"}, {{}, convex.corners_m, {}}, convex, map.scope().out);
}

}  // namespace taut::description
