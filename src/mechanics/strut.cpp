#include "mechanics/strut.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>

#include "taut/shape_kinds.h"

namespace taut::mechanics {
namespace {

constexpr double kRounding = 1e-9;  ///< Relative rounding error of sums over a few solids.

Vec3 Times(const Inertia& i, const Vec3& v) {
  return {i.xx * v.x + i.xy * v.y + i.xz * v.z, i.xy * v.x + i.yy * v.y + i.yz * v.z,
          i.xz * v.x + i.yz * v.y + i.zz * v.z};
}

const CapsuleDef* OnlyCapsule(const ModelDef& def, int body) {
  const CapsuleDef* only = nullptr;
  for (const CapsuleDef& capsule : def.capsules) {
    if (capsule.body != body) continue;
    if (only != nullptr) return nullptr;
    only = &capsule;
  }
  return only;
}

/// Mass distribution of a rod, as fractions of the total mass.
struct Masses {
  double rod = 0, start = 0, end = 0;
};

/// Computes the mass distribution from its moments along the rod (eq. 5). Returns nothing if no
/// uniform rod with masses at its ends has these moments.
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
  // The moment is equal about every axis normal to the rod: (I - across) v = 0 for all of them.
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
      axial - masses.rod * m * r2 / 2;  // own moments of the end masses, if they are balls
  const bool lone = std::fabs(ends) < -kLeast;
  if (of_end_masses < -tiny || (lone && of_end_masses > tiny)) return std::nullopt;
  return masses;
}

}  // namespace

std::optional<Strut> StrutOf(const ModelDef& def, int body) {
  const BodyDef& whole = def.bodies[static_cast<std::size_t>(body)];
  const CapsuleDef* const rod = OnlyCapsule(def, body);
  if (whole.fixed || rod == nullptr) return std::nullopt;
  const double length_m = Length(rod->to_m - rod->from_m);
  const auto at_end = [&](const Vec3& point_m) {
    return std::min(Length(point_m - rod->from_m), Length(point_m - rod->to_m)) <=
           kRounding * length_m;
  };
  // A strut has only spheres at its ends besides the rod.
  bool other = false;
  EachShape(def, [&](const auto& shape) {
    using Shape = std::remove_cvref_t<decltype(shape)>;
    if constexpr (std::is_same_v<Shape, SphereDef>) {
      other |= shape.body == body && !at_end(shape.center_m);
    } else if constexpr (!std::is_same_v<Shape, CapsuleDef>) {
      other |= shape.body == body;
    }
  });
  if (other) return std::nullopt;
  const Vec3 along = (1 / length_m) * (rod->to_m - rod->from_m);
  const auto masses = MassesOf(whole, *rod, along, length_m);
  if (!masses) return std::nullopt;
  // A node between the ends may carry a point mass, unless the ends have no masses.
  const bool ends_only = std::all_of(def.nodes.begin(), def.nodes.end(), [&](const NodeDef& node) {
    return node.body != body || at_end(node.position_m);
  });
  if (!ends_only && std::max(masses->start, masses->end) > 10 * kRounding) return std::nullopt;
  Strut strut;
  strut.body = body;
  strut.middle_arm_m = 0.5 * (rod->from_m + rod->to_m) - whole.com_m;
  strut.along = along;
  strut.length_m = length_m;
  strut.rod = masses->rod;
  strut.at_start = masses->start;
  strut.at_end = masses->end;
  strut.lower = masses->rod / 2 + masses->start;
  strut.upper = masses->rod / 2 + masses->end;
  if (!(strut.lower > 0 && strut.upper > 0)) return std::nullopt;
  strut.apart_m = (masses->rod * length_m / 8 + masses->start * length_m / 2) / strut.lower +
                  (masses->rod * length_m / 8 + masses->end * length_m / 2) / strut.upper;
  return strut;
}

namespace {

/// Force on a strut: position along it from the middle, and axial component.
struct Pull {
  double at_m, force_n;
};

/// Axial force at cross sections of a strut (eq. 6).
class Cuts {
 public:
  Cuts(const Strut& strut, double mass_kg, double spin2, double on_all_n)
      : strut_(strut),
        spin_n_per_m_(mass_kg * spin2),
        on_all_n_(on_all_n),
        center_m_(0.5 * strut.length_m * (strut.at_end - strut.at_start)) {}

  /// Returns the force at `x_m` from the middle; `above_n`: sum of the forces beyond this point.
  double At(double x_m, double above_n) const {
    const double l = strut_.length_m;
    const double share = strut_.rod * (0.5 - x_m / l) + strut_.at_end;
    const double moment_m = strut_.rod * (l * l / 4 - x_m * x_m) / (2 * l) + strut_.at_end * l / 2;
    return above_n - share * on_all_n_ + spin_n_per_m_ * (moment_m - share * center_m_);
  }
  /// Returns the position of the maximum between two point forces, if there is one.
  double Crest() const { return center_m_ + on_all_n_ / spin_n_per_m_; }
  bool spins() const { return spin_n_per_m_ > 0; }

 private:
  const Strut& strut_;
  double spin_n_per_m_, on_all_n_, center_m_;
};

/// Returns the smallest and the largest force: on both sides of each point force, from end to
/// start, and at the maxima between them.
std::pair<double, double> LeastAndGreatest(const Cuts& cuts, double length_m,
                                           std::vector<Pull>& pulls) {
  std::sort(pulls.begin(), pulls.end(),
            [](const Pull& a, const Pull& b) { return a.at_m > b.at_m; });
  double least = std::numeric_limits<double>::infinity(), greatest = -least, above_n = 0;
  const auto look = [&](double x_m) {
    const double n = cuts.At(x_m, above_n);
    least = std::min(least, n);
    greatest = std::max(greatest, n);
  };
  const double end_m = 0.5 * length_m, same_m = kRounding * length_m;
  double from_m = end_m;
  std::size_t next = 0;
  while (true) {
    // Forces at or beyond an end act at the end. There is no cross section between coincident
    // forces.
    while (next < pulls.size() && pulls[next].at_m >= from_m - same_m) {
      above_n += pulls[next++].force_n;
    }
    double to_m = next < pulls.size() ? pulls[next].at_m : -end_m;
    if (to_m <= same_m - end_m) to_m = -end_m;
    look(from_m), look(to_m);
    if (cuts.spins() && cuts.Crest() > to_m && cuts.Crest() < from_m) look(cuts.Crest());
    if (to_m == -end_m) return {least, greatest};
    from_m = to_m;
  }
}

}  // namespace

AxialForce AxialForceOf(const Strut& strut, double mass_kg, const BodyMoment& moment,
                        const std::vector<BodyForce>& forces) {
  const Vec3 along = Rotate(moment.orientation, strut.along);
  const Vec3 middle_m = moment.position_m + Rotate(moment.orientation, strut.middle_arm_m);
  double on_lower_n = 0, on_upper_n = 0;
  std::vector<Pull> pulls;
  pulls.reserve(16);
  for (const BodyForce& force : forces) {
    if (force.body != strut.body) continue;
    const double ahead_m = Dot(force.point_m - middle_m, along);
    const double pull_n = Dot(force.force_n, along);
    // A force in the middle belongs to both halves.
    const bool between = std::fabs(ahead_m) <= kRounding * strut.apart_m;
    const double share = between ? 0.5 : ahead_m > 0 ? 1 : 0;
    on_upper_n += share * pull_n;
    on_lower_n += (1 - share) * pull_n;
    pulls.push_back({ahead_m, pull_n});
  }
  const Vec3& w = moment.angular_velocity_rad_per_s;
  const double spin = Dot(w, along), spin2 = Dot(w, w) - spin * spin;
  AxialForce axial;
  axial.middle_n = strut.lower * on_upper_n - strut.upper * on_lower_n +
                   mass_kg * strut.lower * strut.upper * strut.apart_m * spin2;
  const Cuts cuts(strut, mass_kg, spin2, on_lower_n + on_upper_n);
  std::tie(axial.least_n, axial.greatest_n) = LeastAndGreatest(cuts, strut.length_m, pulls);
  return axial;
}

Reaction ReactionOf(int body, const Vec3& origin_m, const Vec3& weight_n,
                    const std::vector<BodyForce>& forces) {
  Reaction held{body, -1.0 * weight_n, {}};
  for (const BodyForce& force : forces) {
    if (force.body != body) continue;
    held.force_n = held.force_n - force.force_n;
    held.torque_n_m = held.torque_n_m - Cross(force.point_m - origin_m, force.force_n);
    held.torque_n_m = held.torque_n_m - force.torque_n_m;
  }
  return held;
}

}  // namespace taut::mechanics
