#include "benchmarks/peers/adapters.h"

#include <cmath>

#include "math/vec.h"
#include "mechanics/contact_roles.h"

namespace taut::peers {
namespace {

const Vec3& Com(const ModelDef& def, int body) {
  return def.bodies[static_cast<std::size_t>(body)].com_m;
}

}  // namespace

Vec3 operator*(const Rotation& r, const Vec3& x) {
  const double* const m = r.m;
  return {m[0] * x.x + m[1] * x.y + m[2] * x.z, m[3] * x.x + m[4] * x.y + m[5] * x.z,
          m[6] * x.x + m[7] * x.y + m[8] * x.z};
}

Rotation operator*(const Rotation& a, const Rotation& b) {
  Rotation c;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      c.m[3 * i + j] =
          a.m[3 * i] * b.m[j] + a.m[3 * i + 1] * b.m[3 + j] + a.m[3 * i + 2] * b.m[6 + j];
    }
  }
  return c;
}

Rotation Transposed(const Rotation& r) {
  const double* const m = r.m;
  return {{m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]}};
}

Rotation RotationOf(const Quat& q) {
  const double w = q.w, x = q.x, y = q.y, z = q.z;
  return {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z),
           1 - 2 * (x * x + z * z), 2 * (y * z - w * x), 2 * (x * z - w * y), 2 * (y * z + w * x),
           1 - 2 * (x * x + y * y)}};
}

Quat QuatOf(const Rotation& r) {
  // The largest component first, from the diagonal; the others follow without cancellation.
  const double* const m = r.m;
  const double w = 1 + m[0] + m[4] + m[8], x = 1 + m[0] - m[4] - m[8], y = 1 - m[0] + m[4] - m[8],
               z = 1 - m[0] - m[4] + m[8];
  Quat q;
  if (w >= x && w >= y && w >= z) {
    q = {w, m[7] - m[5], m[2] - m[6], m[3] - m[1]};
  } else if (x >= y && x >= z) {
    q = {m[7] - m[5], x, m[1] + m[3], m[2] + m[6]};
  } else if (y >= z) {
    q = {m[2] - m[6], m[1] + m[3], y, m[5] + m[7]};
  } else {
    q = {m[3] - m[1], m[2] + m[6], m[5] + m[7], z};
  }
  const double s = 1 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {s * q.w, s * q.x, s * q.y, s * q.z};
}

Rotation RotationFromZ(const Vec3& axis) {
  const Vec3 other = std::abs(axis.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  Vec3 x = Cross(other, axis);
  x = (1 / std::sqrt(Dot(x, x))) * x;
  const Vec3 y = Cross(axis, x);
  return {{x.x, y.x, axis.x, x.y, y.y, axis.y, x.z, y.z, axis.z}};
}

Inertia Turned(const Rotation& r, const Vec3& moments) {
  const double d[3] = {moments.x, moments.y, moments.z};
  const auto entry = [&](int i, int j) {
    double sum = 0;
    for (int a = 0; a < 3; ++a) sum += r.m[3 * i + a] * d[a] * r.m[3 * j + a];
    return sum;
  };
  return {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)};
}

std::vector<Shape> ShapesOf(const ModelDef& def) {
  const mechanics::ContactRoles roles = mechanics::ContactRolesOf(def);
  std::vector<Shape> shapes;
  for (std::size_t i = 0; i < def.spheres.size(); ++i) {
    const SphereDef& s = def.spheres[i];
    if (!s.collides) continue;
    shapes.push_back({.body = s.body,
                      .center_m = s.center_m - Com(def, s.body),
                      .radius_m = s.radius_m,
                      .meets_bodies = roles.spheres[i].meets_bodies});
  }
  for (std::size_t i = 0; i < def.capsules.size(); ++i) {
    const CapsuleDef& c = def.capsules[i];
    if (!c.collides) continue;
    const Vec3 ends[2] = {c.from_m - Com(def, c.body), c.to_m - Com(def, c.body)};
    const Vec3 d = ends[1] - ends[0];
    const double length = std::sqrt(Dot(d, d));
    shapes.push_back({.kind = Shape::Kind::kCapsule,
                      .body = c.body,
                      .center_m = 0.5 * (ends[0] + ends[1]),
                      .turn = RotationFromZ((1 / length) * d),
                      .half_length_m = 0.5 * length,
                      .radius_m = c.radius_m,
                      .meets_planes = roles.capsules[i].meets_planes});
  }
  for (const BoxDef& b : def.boxes) {
    if (!b.collides) continue;
    shapes.push_back({.kind = Shape::Kind::kBox,
                      .body = b.body,
                      .center_m = b.center_m - Com(def, b.body),
                      .turn = RotationOf(b.orientation),
                      .half_extents_m = b.half_extents_m});
  }
  return shapes;
}

Springs::Springs(const ModelDef& def) {
  for (const CableDef& cable : def.cables) {
    cables_.push_back({static_cast<int>(points_.size()), static_cast<int>(cable.attachments.size()),
                       cable.stiffness_n_per_m, cable.damping_n_s_per_m, cable.rest_length_m});
    for (const AttachmentDef& a : cable.attachments) {
      points_.push_back(
          {a.body, a.body == kWorld ? a.position_m : a.position_m - Com(def, a.body)});
    }
  }
}

void Springs::SetRestLength(int cable, double rest_length_m) {
  cables_[static_cast<std::size_t>(cable)].rest_m = rest_length_m;
}

Springs::Place Springs::Where(const Point& point, const std::vector<Pose>& poses) {
  if (point.body == kWorld) return {{}, point.p, {}};
  const Pose& pose = poses[static_cast<std::size_t>(point.body)];
  const Vec3 arm = pose.r * point.p;
  return {arm, pose.p + arm, pose.v + Cross(pose.w, arm)};
}

CableState Springs::Measure(const Cable& cable, const std::vector<Pose>& poses) const {
  CableState state;
  Place from = Where(points_[static_cast<std::size_t>(cable.first)], poses);
  for (int i = 1; i < cable.count; ++i) {
    const Place to = Where(points_[static_cast<std::size_t>(cable.first + i)], poses);
    const Vec3 d = to.p - from.p;
    const double length = std::sqrt(Dot(d, d));
    state.length_m += length;
    state.rate_m_per_s += Dot(d, to.v - from.v) / length;
    from = to;
  }
  state.rest_length_m = cable.rest_m;
  state.stiffness_n_per_m = cable.k;
  const double stretch = state.length_m - cable.rest_m;
  state.elastic_n = std::fmax(0.0, cable.k * stretch);
  state.tension_n =
      stretch > 0 ? std::fmax(0.0, cable.k * stretch + cable.b * state.rate_m_per_s) : 0.0;
  return state;
}

CableState Springs::State(int cable, const std::vector<Pose>& poses) const {
  return Measure(cables_[static_cast<std::size_t>(cable)], poses);
}

void Springs::Pull(const std::vector<Pose>& poses, std::vector<Load>& loads) const {
  for (Load& load : loads) load = {};
  for (const Cable& cable : cables_) {
    const double tension = Measure(cable, poses).tension_n;
    if (tension == 0) continue;
    for (int i = 0; i + 1 < cable.count; ++i) {
      const Point& a = points_[static_cast<std::size_t>(cable.first + i)];
      const Point& b = points_[static_cast<std::size_t>(cable.first + i + 1)];
      const Place from = Where(a, poses), to = Where(b, poses);
      const Vec3 d = to.p - from.p;
      const Vec3 f = (tension / std::sqrt(Dot(d, d))) * d;
      if (a.body != kWorld) {
        Load& load = loads[static_cast<std::size_t>(a.body)];
        load.force_n = load.force_n + f;
        load.torque_n_m = load.torque_n_m + Cross(from.arm, f);
      }
      if (b.body != kWorld) {
        Load& load = loads[static_cast<std::size_t>(b.body)];
        load.force_n = load.force_n - f;
        load.torque_n_m = load.torque_n_m - Cross(to.arm, f);
      }
    }
  }
}

}  // namespace taut::peers
