// Closed triangle meshes of shapes, scaled to have the volume of the exact shapes.
#include "taut/shape_mesh.h"

#include <cmath>
#include <numbers>

#include "export/cable_points.h"
#include "math/convex_hull.h"
#include "math/vec.h"
#include "taut/statics.h"

namespace taut {
namespace {

constexpr int kSides = 24, kCableSides = 8;
constexpr int kRings = 6;                    // rings between the equator and a pole
constexpr double kTurnByShape = 2.39996323;  // rotation per shape, see Axes [rad]
constexpr double kNoLength_m = 1e-12;

/// Direction of a shape and two perpendicular axes. Each shape is rotated differently about its
/// direction. Otherwise, consecutive rods would share edges, and programs that merge equal corners
/// would report a fault.
struct Axes {
  Vec3 along, u, v;
  Axes(const Vec3& way, std::size_t shape) {
    const double length = Length(way);
    along = length > 0 ? (1 / length) * way : Vec3{0, 0, 1};
    const Vec3 other = std::fabs(along.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    Vec3 s = other - Dot(other, along) * along;
    s = (1 / Length(s)) * s;
    const Vec3 t = Cross(along, s);
    const double turn = kTurnByShape * static_cast<double>(shape);
    u = std::cos(turn) * s + std::sin(turn) * t;
    v = Cross(along, u);
  }
  Vec3 Around(double angle) const { return std::cos(angle) * u + std::sin(angle) * v; }
};

/// Returns the circumradius of a regular polygon, divided by the radius of a circle of equal area.
double Wider(int sides) {
  const double step = 2 * std::numbers::pi / sides;
  return std::sqrt(step / std::sin(step));
}

/// Returns the height of a half sphere made of rings, divided by the radius of an exact half sphere
/// of equal volume.
double Higher() {
  double volume = 0;  // sum over frusta, in units of pi r^3
  for (int k = 0; k < kRings; ++k) {
    const double low = 0.5 * std::numbers::pi * k / kRings,
                 high = 0.5 * std::numbers::pi * (k + 1) / kRings;
    const double a = std::cos(low), b = k + 1 < kRings ? std::cos(high) : 0.0;
    volume += (std::sin(high) - std::sin(low)) * (a * a + a * b + b * b) / 3;
  }
  return 2.0 / 3.0 / volume;
}

/// Surface of rings of corners, from one pole to the other.
class Round {
 public:
  Round(ShapeMesh& mesh, const Axes& axes, int sides) : mesh_(mesh), axes_(axes), sides_(sides) {}

  void Pole(const Vec3& at, const Vec3& normal) {
    Add(at, normal);
    rings_.push_back({static_cast<int>(mesh_.corners_m.size()) - 1, 1});
  }
  /// `rise`: component of the normals along the axis.
  void Ring(const Vec3& center, double radius, double rise) {
    rings_.push_back({static_cast<int>(mesh_.corners_m.size()), sides_});
    const double level = std::sqrt(1 - rise * rise);
    for (int i = 0; i < sides_; ++i) {
      const Vec3 out = axes_.Around(2 * std::numbers::pi * i / sides_);
      Add(center + radius * out, level * out + rise * axes_.along);
    }
  }
  void Close() {
    for (std::size_t k = 1; k < rings_.size(); ++k) Between(rings_[k - 1], rings_[k]);
  }

 private:
  struct Row {
    int first, count;
    int At(int i) const { return first + i % count; }
  };
  void Add(const Vec3& at, const Vec3& normal) {
    mesh_.corners_m.push_back(at), mesh_.normals.push_back(normal);
  }
  void Between(const Row& low, const Row& high) {
    for (int i = 0; i < sides_; ++i) {
      if (low.count > 1) mesh_.triangles.push_back({low.At(i), low.At(i + 1), high.At(i)});
      if (high.count > 1) mesh_.triangles.push_back({low.At(i + 1), high.At(i + 1), high.At(i)});
    }
  }
  ShapeMesh& mesh_;
  const Axes& axes_;
  int sides_;
  std::vector<Row> rings_;
};

/// Adds the surface at distance `radius` from a segment, whose length may be zero.
void AddCapsule(ShapeMesh& mesh, const Vec3& from, const Vec3& to, double radius,
                std::size_t shape) {
  const Axes axes(to - from, shape);
  const double wide = Wider(kSides) * radius, high = Higher() * radius;
  Round round(mesh, axes, kSides);
  round.Pole(from - high * axes.along, -1.0 * axes.along);
  const auto ring = [&](const Vec3& center, int k) {
    const double latitude = 0.5 * std::numbers::pi * k / kRings;
    round.Ring(center + (high * std::sin(latitude)) * axes.along, wide * std::cos(latitude),
               std::sin(latitude));
  };
  const bool ball = Length(to - from) < kNoLength_m;
  for (int k = 1 - kRings; k < (ball ? 0 : 1); ++k) ring(from, k);
  for (int k = 0; k < kRings; ++k) ring(to, k);
  round.Pole(to + high * axes.along, axes.along);
  round.Close();
}

void AddBox(ShapeMesh& mesh, const BoxDef& box) {
  const Vec3& h = box.half_extents_m;
  for (int i = 0; i < 8; ++i) {
    const Vec3 out{i & 1 ? h.x : -h.x, i & 2 ? h.y : -h.y, i & 4 ? h.z : -h.z};
    mesh.corners_m.push_back(box.center_m + Rotate(box.orientation, out));
  }
  static constexpr int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& face : kFaces) {
    mesh.triangles.push_back({face[0], face[1], face[2]});
    mesh.triangles.push_back({face[0], face[2], face[3]});
  }
}

/// Adds a cylinder with flat ends.
void AddPiece(ShapeMesh& mesh, const Vec3& from, const Vec3& to, double radius, std::size_t piece) {
  const Axes axes(to - from, piece);
  const int first = static_cast<int>(mesh.corners_m.size());
  for (const Vec3& end : {from, to}) {
    for (int i = 0; i < kCableSides; ++i) {
      const Vec3 out = axes.Around(2 * std::numbers::pi * i / kCableSides);
      mesh.corners_m.push_back(end + (Wider(kCableSides) * radius) * out);
    }
  }
  const auto low = [&](int i) { return first + i % kCableSides; };
  const auto high = [&](int i) { return low(i) + kCableSides; };
  for (int i = 0; i < kCableSides; ++i) {
    mesh.triangles.push_back({low(i), low(i + 1), high(i)});
    mesh.triangles.push_back({low(i + 1), high(i + 1), high(i)});
  }
  for (int i = 2; i < kCableSides; ++i) {
    mesh.triangles.push_back({low(0), low(i), low(i - 1)});
    mesh.triangles.push_back({high(0), high(i - 1), high(i)});
  }
}

}  // namespace

std::vector<ShapeMesh> ShapesOf(const ModelDef& def, const ShapeOptions& options) {
  std::vector<ShapeMesh> shapes;
  const auto add = [&](ShapeMesh::Kind kind, const std::string& name, int body) -> ShapeMesh& {
    ShapeMesh& mesh = shapes.emplace_back();
    mesh.kind = kind, mesh.name = name, mesh.body = body;
    return mesh;
  };
  for (const CapsuleDef& rod : def.capsules) {
    AddCapsule(add(ShapeMesh::Kind::kRod, rod.name, rod.body), rod.from_m, rod.to_m, rod.radius_m,
               shapes.size());
  }
  for (const SphereDef& sphere : def.spheres) {
    AddCapsule(add(ShapeMesh::Kind::kSphere, sphere.name, sphere.body), sphere.center_m,
               sphere.center_m, sphere.radius_m, shapes.size());
  }
  for (const BoxDef& box : def.boxes) AddBox(add(ShapeMesh::Kind::kBox, box.name, box.body), box);
  for (const HullDef& hull : def.hulls) {
    ShapeMesh& mesh = add(ShapeMesh::Kind::kHull, hull.name, hull.body);
    const math::ConvexHull solid = math::HullOf(hull.corners_m, HullDef::kMostCorners);
    mesh.corners_m = solid.corners;
    mesh.triangles = math::TrianglesOf(solid);
  }
  if (!(options.cable_radius_m > 0)) return shapes;
  std::size_t pieces = 0;
  for (const CableDef& cable : def.cables) {
    const bool taut = CableTension(cable) > 0;
    ShapeMesh& mesh =
        add(taut ? ShapeMesh::Kind::kCable : ShapeMesh::Kind::kSlackCable, cable.name, kWorld);
    const std::vector<Vec3> path = exporting::CablePoints(cable);
    for (std::size_t i = 1; i < path.size(); ++i) {
      if (Length(path[i] - path[i - 1]) < kNoLength_m) continue;
      AddPiece(mesh, path[i - 1], path[i], options.cable_radius_m, ++pieces);
    }
  }
  return shapes;
}

}  // namespace taut
