#include "plant/strut.h"

#include <algorithm>
#include <cmath>

namespace taut::plant {
namespace {

constexpr double kRounding = 1e-9;  ///< What sums of a handful of solids may be off by, relatively.

Vec3 Times(const Inertia& i, const Vec3& v) {
  return {i.xx * v.x + i.xy * v.y + i.xz * v.z, i.xy * v.x + i.yy * v.y + i.yz * v.z,
          i.xz * v.x + i.yz * v.y + i.zz * v.z};
}

double Length(const Vec3& v) { return std::sqrt(Dot(v, v)); }

const CapsuleDef* OnlyCapsule(const ModelDef& def, int body) {
  const CapsuleDef* only = nullptr;
  for (const CapsuleDef& capsule : def.capsules) {
    if (capsule.body != body) continue;
    if (only != nullptr) return nullptr;
    only = &capsule;
  }
  return only;
}

/// How a rod's mass is shared out, as shares of the whole.
struct Masses {
  double rod = 0, start = 0, end = 0;
};

/// From the moments of the mass along the rod (eq. 5); nothing if no uniform rod with masses at its
/// ends has them.
std::optional<Masses> MassesOf(const BodyDef& body, const CapsuleDef& rod, const Vec3& along,
                               double length_m) {
  const double m = body.mass_kg, l2 = length_m * length_m, r2 = rod.radius_m * rod.radius_m;
  const double tiny = kRounding * m * l2;
  const Vec3 arm = body.com_m - 0.5 * (rod.from_m + rod.to_m);
  const double ahead_m = Dot(arm, along);
  if (Length(arm - ahead_m * along) > kRounding * length_m) return std::nullopt;
  const Inertia& inertia = body.inertia_kg_m2;
  const double axial = Dot(along, Times(inertia, along));
  const double across = 0.5 * (inertia.xx + inertia.yy + inertia.zz - axial);
  // The same about every axis across the rod: (I - across) v = 0 for all of them.
  for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    const Vec3 v = axis - Dot(axis, along) * along;
    if (Length(Times(inertia, v) - across * v) > tiny) return std::nullopt;
  }
  if (Length(Times(inertia, along) - axial * along) > tiny) return std::nullopt;
  const double spread = across + m * ahead_m * ahead_m - axial;
  Masses masses;
  masses.rod = (l2 / 4 - spread / m) / (l2 / 6 + r2 / 4);
  const double ends = 1 - masses.rod, difference = 2 * ahead_m / length_m;
  masses.start = 0.5 * (ends - difference);
  masses.end = 0.5 * (ends + difference);
  constexpr double kLeast = -10 * kRounding;
  if (!(masses.rod >= kLeast && masses.start >= kLeast && masses.end >= kLeast)) {
    return std::nullopt;
  }
  const double of_end_masses =
      axial - masses.rod * m * r2 / 2;  // their own moments, if they are balls
  const bool lone = std::fabs(ends) < -kLeast;
  if (of_end_masses < -tiny || (lone && of_end_masses > tiny)) return std::nullopt;
  return masses;
}

}  // namespace

std::optional<Strut> StrutOf(const ModelDef& def, int body) {
  const BodyDef& whole = def.bodies[static_cast<std::size_t>(body)];
  const CapsuleDef* const rod = OnlyCapsule(def, body);
  if (whole.fixed || rod == nullptr) return std::nullopt;
  const auto here = [&](const auto& shape) { return shape.body == body; };
  if (std::any_of(def.boxes.begin(), def.boxes.end(), here)) return std::nullopt;
  if (std::any_of(def.hulls.begin(), def.hulls.end(), here)) return std::nullopt;
  const double length_m = Length(rod->to_m - rod->from_m);
  const auto at_end = [&](const Vec3& point_m) {
    return std::min(Length(point_m - rod->from_m), Length(point_m - rod->to_m)) <=
           kRounding * length_m;
  };
  if (std::any_of(def.spheres.begin(), def.spheres.end(),
                  [&](const SphereDef& s) { return here(s) && !at_end(s.center_m); })) {
    return std::nullopt;
  }
  const Vec3 along = (1 / length_m) * (rod->to_m - rod->from_m);
  const auto masses = MassesOf(whole, *rod, along, length_m);
  if (!masses) return std::nullopt;
  // At a node that is no end there may be a point mass; without masses at the ends there is none.
  const bool ends_only = std::all_of(def.nodes.begin(), def.nodes.end(), [&](const NodeDef& node) {
    return !here(node) || at_end(node.position_m);
  });
  if (!ends_only && std::max(masses->start, masses->end) > 10 * kRounding) return std::nullopt;
  Strut strut;
  strut.body = body;
  strut.middle = {body, 0.5 * (rod->from_m + rod->to_m) - whole.com_m};
  strut.along = along;
  strut.lower = masses->rod / 2 + masses->start;
  strut.upper = masses->rod / 2 + masses->end;
  if (!(strut.lower > 0 && strut.upper > 0)) return std::nullopt;
  strut.apart_m = (masses->rod * length_m / 8 + masses->start * length_m / 2) / strut.lower +
                  (masses->rod * length_m / 8 + masses->end * length_m / 2) / strut.upper;
  return strut;
}

double AxialForce(const Strut& strut, double mass_kg, const BodyState& state,
                  const std::vector<BodyForce>& forces) {
  const Vec3 along = Rotate(state.orientation, strut.along);
  const Vec3 middle_m = PlaceOf(strut.middle, state);
  double on_lower_n = 0, on_upper_n = 0;
  for (const BodyForce& force : forces) {
    if (force.body != strut.body) continue;
    const double ahead_m = Dot(force.point_m - middle_m, along);
    const double pull_n = Dot(force.force_n, along);
    // In the very middle a force belongs to both halves.
    const bool between = std::fabs(ahead_m) <= kRounding * strut.apart_m;
    const double share = between ? 0.5 : ahead_m > 0 ? 1 : 0;
    on_upper_n += share * pull_n;
    on_lower_n += (1 - share) * pull_n;
  }
  const Vec3& w = state.angular_velocity_rad_per_s;
  const double spin = Dot(w, along);
  return strut.lower * on_upper_n - strut.upper * on_lower_n +
         mass_kg * strut.lower * strut.upper * strut.apart_m * (Dot(w, w) - spin * spin);
}

}  // namespace taut::plant
