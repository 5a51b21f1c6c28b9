// Friction that depends on speed or direction, and custom friction laws (docs/theory/friction.md).
#include "sim/contacts/contact_friction.h"

#include <cmath>

#include "math/rotation.h"
#include "math/vec.h"
#include "sim/contacts/combine.h"
#include "sim/contacts/moving_pairs.h"
#include "sim/data/tables.h"
#include "taut/friction.h"

namespace taut::sim {
namespace {

double Dot3(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vec3 Vec(const double p[3]) { return {p[0], p[1], p[2]}; }
void Cross3(const double a[3], const double b[3], double out[3]) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}
void Tangential(const double v[3], const double n[3], double out[3]) {
  const double across = Dot3(v, n);
  for (int i = 0; i < 3; ++i) out[i] = v[i] - across * n[i];
}

struct Sides {
  const FrictionSide *a, *b;
};
/// Returns the two surfaces of a contact from its key.
Sides SidesOf(const View& m, double key) {
  const FrictionTable& t = *m.friction;
  const auto number = static_cast<std::uint32_t>(key);
  if (number < m.first_pair_id) {
    const auto planes = static_cast<std::uint32_t>(m.plane_count);
    const int plane = static_cast<int>(number % planes);
    return {&t.sides[t.shape_of_point[number / planes]], &t.sides[t.shape_count + plane]};
  }
  const ShapePairTable pair = PairOfKey(m, number);
  return {&t.sides[pair.a], &t.sides[pair.b]};
}

/// Coefficients of one surface at a sliding speed (eq. 1, 2).
struct Both {
  double at_rest, sliding;
};
Both AtSpeed(const FrictionSide& side, double speed) {
  if (!(side.inv_stribeck2 > 0)) return {side.at_rest, side.sliding};
  const double more = side.at_rest - side.sliding;
  const double mu =
      side.sliding + more / (1.0 + side.inv_stribeck2 * speed * speed) + side.viscous * speed;
  return {mu, mu};
}

/// Computes the forward direction of a surface in W. Returns false if it has none.
bool AxisOf(const FrictionSide& side, const double turn[9], bool turns, double out[3]) {
  for (int i = 0; i < 3; ++i) {
    out[i] = turns ? Dot3(turn + 3 * i, side.axis_P) : side.axis_P[i];
  }
  return side.directed;
}

/// Returns the friction factor of a surface along the unit vector `t`, for the sliding direction
/// `way` (eq. 3).
double Factor(const FrictionSide& side, const double axis[3], const double t[3],
              const double way[3], double sign) {
  if (!side.directed) return 1.0;
  const double ahead = sign * Dot3(way, axis) < 0 ? side.backward : side.forward;
  const double cosine = Dot3(t, axis), c2 = cosine * cosine;
  const double rest = c2 < 1.0 ? 1.0 - c2 : 0.0;
  return std::sqrt(ahead * ahead * c2 + side.sideways * side.sideways * rest);
}

/// Computes two unit tangents; the first is along the projection of the axis onto the surface.
void Tangents(const double axis[3], const double n[3], double t1[3], double t2[3]) {
  Tangential(axis, n, t1);
  double square = Dot3(t1, t1);
  if (!(square > 1e-12)) {  // The axis is normal to the surface, so all directions are sideways.
    const double other[3] = {std::fabs(n[0]) < 0.6 ? 1.0 : 0.0, std::fabs(n[0]) < 0.6 ? 0.0 : 1.0,
                             0.0};
    Tangential(other, n, t1);
    square = Dot3(t1, t1);
  }
  const double inverse = 1.0 / std::sqrt(square);
  for (int i = 0; i < 3; ++i) t1[i] *= inverse;
  Cross3(n, t1, t2);
}

}  // namespace

void FrictionOf(const View& m, SlidingContact& c) noexcept {
  const FrictionTable& t = *m.friction;
  const auto [a, b] = SidesOf(m, c.key);
  double slip[3], before[3];
  Tangential(c.slip, c.normal, slip);
  Tangential(c.before, c.normal, before);
  const double speed = std::sqrt(Dot3(slip, slip));
  const Both of_a = AtSpeed(*a, speed), of_b = AtSpeed(*b, speed);
  c.static_friction = Combine(t.combine, of_a.at_rest, of_b.at_rest);
  c.kinetic_friction = Combine(t.combine, of_a.sliding, of_b.sliding);
  c.directed = a->directed || b->directed;
  if (c.directed) {
    double axis_a[3], axis_b[3], t1[3], t2[3], way[3];
    const bool by_a = AxisOf(*a, c.turn_a, true, axis_a);
    AxisOf(*b, c.turn_b, c.b_moves, axis_b);
    Tangents(by_a ? axis_a : axis_b, c.normal, t1, t2);
    // Sliding direction. For a sticking contact, the direction opposite to the friction force, in
    // which it would slide.
    const double* const towards = Dot3(before, before) > kSlidingMPerS * kSlidingMPerS ? slip : way;
    if (towards == way) {
      Tangential(c.force, c.normal, way);
      for (double& x : way) x = -x;
      if (!(Dot3(way, way) > 0)) Tangential(c.free, c.normal, way);
    }
    const double a1 = Factor(*a, axis_a, t1, towards, 1), b1 = Factor(*b, axis_b, t1, towards, -1);
    const double a2 = Factor(*a, axis_a, t2, towards, 1), b2 = Factor(*b, axis_b, t2, towards, -1);
    const double at_rest[2] = {Combine(t.combine, a1 * of_a.at_rest, b1 * of_b.at_rest),
                               Combine(t.combine, a2 * of_a.at_rest, b2 * of_b.at_rest)};
    const double sliding[2] = {Combine(t.combine, a1 * of_a.sliding, b1 * of_b.sliding),
                               Combine(t.combine, a2 * of_a.sliding, b2 * of_b.sliding)};
    const int most = sliding[1] > sliding[0] ? 1 : 0;
    c.static_friction = at_rest[most];
    c.kinetic_friction = sliding[most];
    const double share = sliding[most] > 0 ? sliding[1 - most] / sliding[most] : 1.0;
    for (int i = 0; i < 3; ++i) {
      c.along[i] = (most == 0 ? 1.0 : share) * t1[i];
      c.across[i] = (most == 0 ? share : 1.0) * t2[i];
    }
  }
  if (t.law == nullptr) return;
  const double pressed = Dot3(c.force, c.normal);
  const FrictionContact asked{c.world,
                              c.time_s,
                              a->body,
                              b->body,
                              a->ref,
                              b->ref,
                              Vec(c.point),
                              Vec(c.normal),
                              Vec(slip),
                              pressed > 0 ? pressed : 0.0,
                              c.static_friction,
                              c.kinetic_friction};
  const double mu = t.law->Coefficient(asked);
  c.lost = !(mu - mu == 0);
  c.static_friction = c.kinetic_friction = mu > 0 && !c.lost ? mu : 0.0;
}

void LayOutFriction(Tables& t) {
  const ModelDef& def = t.def();
  using List = ShapeRef::List;
  const auto add = [&](const ShapeRef& ref, int table_body, const Material& m, Vec3 axis) {
    FrictionSide side;
    side.ref = ref;
    side.body = table_body == t.body_count ? kWorld : table_body;
    side.at_rest = m.static_friction;
    side.sliding = m.kinetic_friction;
    if (m.stribeck) {
      const double v = m.stribeck->speed_m_per_s;
      side.inv_stribeck2 = 1.0 / (v * v);
      side.viscous = m.stribeck->viscous_friction_s_per_m;
    }
    if (m.directions) {
      side.directed = true;
      side.forward = m.directions->forward;
      side.backward = m.directions->backward;
      side.sideways = m.directions->sideways;
      if (Dot(m.directions->axis, m.directions->axis) > 0) axis = m.directions->axis;
      axis = (1.0 / std::sqrt(Dot(axis, axis))) * axis;
      if (side.body != kWorld) {
        const double* const q = t.q_WP0.data() + 4 * static_cast<std::size_t>(side.body);
        axis = Rotate(Conjugate(Quat{q[0], q[1], q[2], q[3]}), axis);
      }
      side.axis_P[0] = axis.x, side.axis_P[1] = axis.y, side.axis_P[2] = axis.z;
    }
    t.friction_by_slip = t.friction_by_slip || m.stribeck || m.directions;
    t.friction_sides.push_back(side);
  };
  for (std::size_t i = 0; i < t.shapes.size(); ++i) {
    const ShapeRef ref = t.shape_refs[i];
    Vec3 along;
    if (ref.list == List::kCapsules) {
      const CapsuleDef& rod = def.capsules[static_cast<std::size_t>(ref.index)];
      along = rod.to_m - rod.from_m;
    }
    add(ref, t.shapes[i].body, t.shapes[i].material, along);
  }
  for (std::size_t i = 0; i < def.planes.size(); ++i) {
    add({List::kPlanes, static_cast<int>(i)}, t.body_count, def.planes[i].material, {});
  }
}

}  // namespace taut::sim
