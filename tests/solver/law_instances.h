/// Random contacts and cables between two bodies, and their laws as stated in theory.
#pragma once

#include <vector>

#include "math/vec.h"
#include "tests/solver/law_checks.h"
#include "tests/solver/law_lanes.h"

namespace taut::test {

inline Vec3 RandomVector(math::Random& random) {
  const double x = random.Normal(), y = random.Normal();
  return {x, y, random.Normal()};
}
inline Vec3 Unit(const Vec3& v) { return (1 / std::sqrt(Dot(v, v))) * v; }

/// Appends an inverse mass and an inverse inertia of order 1, both positive definite.
inline void AddMasses(math::Random& random, std::vector<double>& out) {
  out.push_back(random.Uniform(0.3, 3));
  const Vec3 a = RandomVector(random), b = RandomVector(random), c = RandomVector(random);
  const auto entry = [&](double Vec3::*i, double Vec3::*j) {
    return (i == j ? 0.1 : 0.0) + 0.3 * (a.*i * (a.*j) + b.*i * (b.*j) + c.*i * (c.*j));
  };
  out.insert(out.end(),
             {entry(&Vec3::x, &Vec3::x), entry(&Vec3::y, &Vec3::y), entry(&Vec3::z, &Vec3::z),
              entry(&Vec3::x, &Vec3::y), entry(&Vec3::x, &Vec3::z), entry(&Vec3::y, &Vec3::z)});
}
inline void AddVector(const Vec3& v, std::vector<double>& out) {
  out.insert(out.end(), {v.x, v.y, v.z});
}

/// Returns the numbers of a contact in the format of ReadContact.
inline std::vector<double> RandomContactNumbers(math::Random& random, double max_mu) {
  std::vector<double> out = {1, random.Uniform(0.1, max_mu)};
  for (const double x : RandomRows<3>(random, 0.5)) out.push_back(x);
  for (const double x : RandomRows<3>(random)) out.push_back(x);
  const Vec3 n = Unit(RandomVector(random)), t1 = Unit(Cross(n, RandomVector(random)));
  for (const double sign : {1.0, -1.0}) {
    AddMasses(random, out);
    for (const Vec3& d : {n, t1, Cross(n, t1)}) AddVector(sign * d, out);
    for (const double x : RandomRows<3>(random)) out.push_back(x);
  }
  return out;
}
/// Returns the numbers of a cable's law, the first ones of the format of ReadCable. Half of the
/// cables have no damper, and half no limit.
inline std::vector<double> RandomLawNumbers(math::Random& random) {
  const double start = random.Uniform(-1, 1), end = random.Uniform(-1, 1);
  const double spring = random.Uniform(0.1, 1), damper = random.Uniform(-1, 1);
  const double winding = random.Uniform(-0.3, 0.3), upper = random.Uniform(-1, 1);
  return {1, start, end, spring, std::max(damper, 0.0), winding, upper > 0.2 ? upper : 1e300, 0};
}
/// Appends the two bodies of a cable, the other numbers of the format of ReadCable.
inline void AddCableBodies(math::Random& random, std::vector<double>& out) {
  for (int i = 0; i < 2; ++i) {
    AddMasses(random, out);
    AddVector(Unit(RandomVector(random)), out);
    for (const double x : RandomRows<3>(random)) out.push_back(x);
  }
}
/// Returns the numbers of a cable in the format of ReadCable.
inline std::vector<double> RandomCableNumbers(math::Random& random) {
  std::vector<double> out = RandomLawNumbers(random);
  AddCableBodies(random, out);
  return out;
}

inline Contact2 RandomContact(math::Random& random, bool one_direction, double max_mu = 1.5) {
  const std::vector<double> numbers = RandomContactNumbers(random, max_mu);
  LaneReader<Num> in{numbers.data(), 0};
  return ReadContact(in, one_direction, random.Uniform() < 0.5 ? 1 : 2);
}
/// A cable with the memory of its links.
struct OwnedCable {
  sim::Link<Num, 1> links[2];
  Cable law;
  explicit OwnedCable(const std::vector<double>& numbers) {
    LaneReader<Num> in{numbers.data(), 0};
    law = ReadCable(in, links);
  }
  explicit OwnedCable(math::Random& random) : OwnedCable(RandomCableNumbers(random)) {}
  OwnedCable(const OwnedCable&) = delete;
};
/// Returns a cable without bodies from the numbers of its law.
inline Cable LawOf(const std::vector<double>& numbers) {
  const auto number = [&numbers](std::size_t i) { return Num::Splat(numbers[i]); };
  Cable law;
  law.SetLaw(number(1), number(2), number(3), number(4), number(5));
  law.upper = number(6);
  return law;
}

/// Returns the difference of the velocities from their targets, which is zero in (C1) and (C2).
inline Rows<3> Excess(const Contact2& c, const Rows<3>& u) {
  return {u[0] + c.bias[0][0], u[1] + c.bias[1][0], u[2] + c.bias[2][0]};
}

/// Violation of (C1), (C2) of docs/theory/contact.md. With one direction of friction the second
/// tangent has no impulse, and its velocity is free.
inline double Violation(const Contact2& c, const Rows<3>& u, const Rows<3>& l) {
  const Rows<3> v = Excess(c, u);
  const double mu = c.mu[0], v2 = c.one_direction ? 0 : v[2];
  const double speed = std::hypot(v[1], v2);
  return std::max({-l[0], -v[0], std::min(std::abs(l[0]), std::abs(v[0])),
                   std::hypot(l[1], l[2]) - mu * l[0],
                   std::hypot(speed * l[1] + mu * l[0] * v[1], speed * l[2] + mu * l[0] * v2),
                   c.one_direction ? std::abs(l[2]) : 0});
}

/// Alart's and Curnier's function, eq. 14-16, of the trial impulses l about `center`:
///   w (l - P(l - u/w - e (l - center))),  P: onto ln >= 0, onto the disc of radius mu ln
inline Rows<3> NewtonFunction(const Contact2& c, const Rows<3>& u, const Rows<3>& l,
                              const Rows<3>& center, double e) {
  const Rows<3> v = Excess(c, u);
  const double w[3] = {c.wnn[0], c.wt[0], c.wt[0]};
  Rows<3> y;
  for (std::size_t r = 0; r < 3; ++r) y[r] = l[r] - v[r] / w[r] - e * (l[r] - center[r]);
  if (c.one_direction) y[2] = 0;
  if (y[0] <= 0) return {w[0] * l[0], w[1] * l[1], w[2] * l[2]};
  const double radius = c.mu[0] * std::max(l[0], 0.0), length = std::hypot(y[1], y[2]);
  const double shrink = length > radius ? radius / length : 1;
  return {w[0] * (l[0] - y[0]), w[1] * (l[1] - shrink * y[1]), w[2] * (l[2] - shrink * y[2])};
}

/// Returns twice the stretch at the step's end, divided by the step.
inline double EndOf(const Cable& c, const Rows<1>& u) { return c.end[0] - u[0]; }

/// Returns the impulse of eq. 8 and 9 of docs/theory/cables.md, without limits: change of the
/// spring's energy per change of the stretch, plus the damper while stretched, whose rate includes
/// the change of length and the winding of the rest length.
inline double Wish(const Cable& c, const Rows<1>& u) {
  const double z = EndOf(c, u), z0 = c.start[0], way = z - z0;
  const double p = std::max(z, 0.0), p0 = std::max(z0, 0.0);
  return (c.spring[0] * (p * p - p0 * p0) + c.damper[0] * (p - p0) * (way + c.winding[0])) / way;
}
/// -d Wish / du, by the quotient rule.
inline double SlopeOfWish(const Cable& c, const Rows<1>& u) {
  const double z = EndOf(c, u), z0 = c.start[0], way = z - z0, far = way + c.winding[0];
  const double gone = std::max(z, 0.0) - std::max(z0, 0.0);
  const double taut = z > 0 ? 2 * c.spring[0] * z + c.damper[0] * far : 0;
  return (taut + c.damper[0] * gone - Wish(c, u)) / way;
}

inline double Violation(const Cable& c, const Rows<1>& u, const Rows<1>& l) {
  return std::abs(l[0] - std::clamp(Wish(c, u), 0.0, c.upper[0]));
}

/// The error of the impulse times the change of velocity per impulse of a single cable that is taut
/// at both ends.
inline Rows<1> NewtonFunction(const Cable& c, const Rows<1>& u, const Rows<1>& l, const Rows<1>&,
                              double) {
  const double a = InverseMassOf(c)[0][0];
  return {a / (1 + c.gain[0] * a) * (l[0] - std::clamp(Wish(c, u), 0.0, c.upper[0]))};
}

}  // namespace taut::test
