#include "description/experiment/area_loads.h"

#include <algorithm>
#include <cmath>

#include "description/experiment/experiment_parts.h"
#include "math/vec.h"

namespace taut::description {
namespace {

constexpr double kSamePoint_m = 1e-9;
/// Largest distance of the fourth corner of a flat quadrilateral from the plane of the others,
/// relative to the length of its diagonals.
constexpr double kFlat = 1e-6;
/// Least cosine between the normal of a loaded face and the direction.
constexpr double kParallel = 1e-9;

}  // namespace

AreaLoads::AreaLoads(const RobotSpec& robot, const Scope& scope)
    : robot_(robot), scope_(scope), places_(robot) {}

void AreaLoads::AddTo(LoadCaseSpec& out, const std::vector<AreaLoadText>& loads) {
  force_n_.clear();
  for (const AreaLoadText& load : loads) {
    const bool by_nodes = load.nodes.value != nullptr;
    if (!by_nodes && !load.members.value) continue;
    const std::vector<LoadMember> members = Members(load);
    if (members.empty() || !Connect(load, members)) continue;
    const std::vector<Face> faces = Faces();
    if (faces.empty()) {
      scope_.out.Error("load_case.no_surface", load.at,
                       std::string("area_loads: the selected ") + (by_nodes ? "nodes" : "members") +
                           " form no triangle and no flat quadrilateral",
                       "select all members at the edges of the surface");
    }
    for (const Face& face : faces) {
      if (!IsHidden(face, faces, load.direction)) Press(load, face);
    }
  }
  for (const auto& [node, force_n] : force_n_) out.forces.push_back({node, force_n});
}

std::vector<LoadMember> AreaLoads::Members(const AreaLoadText& load) const {
  if (load.members.value) {
    return SelectMembers(*load.members.value, "area_loads.members", true, robot_, scope_);
  }
  const std::vector<int> nodes = SelectNodes(*load.nodes.value, "area_loads.nodes", robot_, scope_);
  if (nodes.empty()) return {};
  std::vector<bool> chosen(robot_.def.nodes.size(), false);
  for (const int node : nodes) chosen[static_cast<std::size_t>(node)] = true;
  const auto ends_there = [&](const LoadPoint& point) {
    const auto node = places_.At(point);
    return node && chosen[static_cast<std::size_t>(*node)];
  };
  std::vector<LoadMember> members;
  for (const LoadMember& member : AllMembers(robot_)) {
    const std::vector<LoadPoint> points = PointsOf(member, robot_);
    if (std::all_of(points.begin(), points.end(), ends_there)) members.push_back(member);
  }
  if (members.empty()) {
    scope_.out.Error("load_case.no_surface", load.nodes.value->at,
                     "area_loads.nodes: no member connects two of the selected nodes");
  }
  return members;
}

bool AreaLoads::Connect(const AreaLoadText& load, const std::vector<LoadMember>& members) {
  node_of_.clear(), at_m_.clear(), joined_.clear(), corner_at_x_.clear();
  for (const LoadMember& member : members) {
    const std::vector<LoadPoint> points = PointsOf(member, robot_);
    for (std::size_t i = 1; i < points.size(); ++i) {
      if (!ConnectPair(load, points[i - 1], points[i], NameOf(member, robot_))) return false;
    }
  }
  return true;
}

bool AreaLoads::ConnectPair(const AreaLoadText& load, const LoadPoint& a, const LoadPoint& b,
                            const std::string& member) {
  const auto from = CornerAt(a, load, member), to = CornerAt(b, load, member);
  if (!from || !to) return false;
  if (*from == *to) return true;
  joined_[static_cast<std::size_t>(*from)].insert(*to);
  joined_[static_cast<std::size_t>(*to)].insert(*from);
  return true;
}

/// Returns the corner at a point; members that end at the same place share it, whichever bodies
/// they belong to.
std::optional<int> AreaLoads::CornerAt(const LoadPoint& point, const AreaLoadText& load,
                                       const std::string& member) {
  const auto node = places_.At(point);
  if (!node && point.body != kWorld) {
    scope_.out.Error("load_case.end_without_node", load.at,
                     "area_loads: \"" + member + "\" has no node at its end",
                     "add a node to the part at this end");
    return std::nullopt;
  }
  const double x_m = point.at_m.x;
  for (auto near = corner_at_x_.lower_bound(x_m - kSamePoint_m);
       near != corner_at_x_.end() && near->first <= x_m + kSamePoint_m; ++near) {
    const auto i = static_cast<std::size_t>(near->second);
    if (Length(at_m_[i] - point.at_m) > kSamePoint_m) continue;
    if (node_of_[i] < 0 && node) node_of_[i] = *node;
    return near->second;
  }
  corner_at_x_.emplace(x_m, static_cast<int>(at_m_.size()));
  node_of_.push_back(node.value_or(-1));
  at_m_.push_back(point.at_m);
  joined_.emplace_back();
  return static_cast<int>(at_m_.size()) - 1;
}

std::vector<AreaLoads::Face> AreaLoads::Faces() const {
  std::vector<Face> faces;
  const auto near = [&](int corner) -> const std::set<int>& {
    return joined_[static_cast<std::size_t>(corner)];
  };
  const auto add = [&](Face face) {
    if (!IsDivided(face)) faces.push_back(std::move(face));
  };
  // Each face once: its first corner has the least index, and the second one less than the last.
  for (int a = 0; a < static_cast<int>(joined_.size()); ++a) {
    for (const int b : near(a)) {
      if (b < a) continue;
      for (const int d : near(a)) {
        if (d <= b) continue;
        if (near(b).contains(d)) {
          add({a, b, d});
          continue;
        }
        for (const int c : near(b)) {
          if (c <= a || c == d || !near(c).contains(d) || near(a).contains(c)) continue;
          if (IsFlatConvex({a, b, c, d})) add({a, b, c, d});
        }
      }
    }
  }
  return faces;
}

/// Returns whether a quadrilateral is flat and convex.
bool AreaLoads::IsFlatConvex(const Face& face) const {
  const auto at = [&](std::size_t i) { return at_m_[static_cast<std::size_t>(face[i % 4])]; };
  const Vec3 first = at(2) - at(0), second = at(3) - at(1);
  const double size_m = std::fmax(Length(first), Length(second));
  const Vec3 normal = Cross(first, second);
  const double twice_m2 = Length(normal);
  if (twice_m2 <= kFlat * size_m * size_m) return false;
  if (std::fabs(Dot(normal, at(1) - at(0))) > kFlat * size_m * twice_m2) return false;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 turn = Cross(at(i + 1) - at(i), at(i + 2) - at(i + 1));
    if (Dot(turn, normal) <= 0) return false;
  }
  return true;
}

/// Returns whether a corner lies on a flat face, inside of its boundary.
bool AreaLoads::Contains(const Face& face, int corner) const {
  const auto at = [&](std::size_t i) {
    return at_m_[static_cast<std::size_t>(face[i % face.size()])];
  };
  const Vec3 point = at_m_[static_cast<std::size_t>(corner)];
  const Vec3 normal = Cross(at(1) - at(0), at(2) - at(0));
  const double size_m = std::fmax(Length(at(1) - at(0)), Length(at(2) - at(0)));
  if (std::fabs(Dot(normal, point - at(0))) > kFlat * size_m * Length(normal)) return false;
  for (std::size_t i = 0; i < face.size(); ++i) {
    if (Dot(Cross(at(i + 1) - at(i), point - at(i)), normal) <= 0) return false;
  }
  return true;
}

/// Returns whether members divide a face into smaller ones: another corner lies on it.
bool AreaLoads::IsDivided(const Face& face) const {
  for (const int corner : face) {
    for (const int other : joined_[static_cast<std::size_t>(corner)]) {
      if (std::find(face.begin(), face.end(), other) == face.end() && Contains(face, other)) {
        return true;
      }
    }
  }
  return false;
}

/// Returns whether another face lies before the middle of a face, seen along the direction.
bool AreaLoads::IsHidden(const Face& face, const std::vector<Face>& faces,
                         const Vec3& direction) const {
  const auto at = [&](int corner) { return at_m_[static_cast<std::size_t>(corner)]; };
  Vec3 middle_m;
  for (const int corner : face) {
    middle_m = middle_m + (1 / static_cast<double>(face.size())) * at(corner);
  }
  // Moeller and Trumbore (1997): the point middle - t direction in coordinates u, v of a triangle
  const auto covered_by = [&](int first, int second, int third) {
    const Vec3 origin = at(first), e1 = at(second) - origin, e2 = at(third) - origin;
    const Vec3 across = Cross(direction, e2);
    const double det = Dot(e1, across);
    if (std::fabs(det) <= kParallel * Length(e1) * Length(e2)) return false;
    const Vec3 from = middle_m - origin, turned = Cross(from, e1);
    const double u = Dot(from, across) / det, v = Dot(direction, turned) / det;
    const double before_m = -Dot(e2, turned) / det;
    return u >= -kFlat && v >= -kFlat && u + v <= 1 + kFlat && before_m > kFlat * Length(e1);
  };
  return std::any_of(faces.begin(), faces.end(), [&](const Face& other) {
    return &other != &face && (covered_by(other[0], other[1], other[2]) ||
                               (other.size() == 4 && covered_by(other[0], other[2], other[3])));
  });
}

void AreaLoads::Press(const AreaLoadText& load, const Face& face) {
  if (face.size() == 3) return PressTriangle(load, {face[0], face[1], face[2]}, 1);
  PressTriangle(load, {face[0], face[1], face[2]}, 0.5);
  PressTriangle(load, {face[0], face[2], face[3]}, 0.5);
  PressTriangle(load, {face[0], face[1], face[3]}, 0.5);
  PressTriangle(load, {face[1], face[2], face[3]}, 0.5);
}

void AreaLoads::PressTriangle(const AreaLoadText& load, std::array<int, 3> corners, double share) {
  const auto at = [&](std::size_t i) { return at_m_[static_cast<std::size_t>(corners[i])]; };
  const Vec3 area_m2 = 0.5 * Cross(at(1) - at(0), at(2) - at(0));  // along the normal
  const double across_m2 = Dot(area_m2, load.direction);
  if (std::fabs(across_m2) <= kParallel * Length(area_m2)) return;
  const double side_pa = share * load.pressure_pa * (across_m2 < 0 ? -1.0 : 1.0);
  const Vec3 force_n = load.projected ? (side_pa * across_m2) * load.direction : side_pa * area_m2;
  for (const int corner : corners) {
    const int node = node_of_[static_cast<std::size_t>(corner)];
    if (node < 0) continue;  // on the ground
    Vec3& sum_n = force_n_.emplace(node, Vec3{}).first->second;
    sum_n = sum_n + (1.0 / 3) * force_n;
  }
}

}  // namespace taut::description
