/// Equations and residual of a stored problem (tests/solver/README.md, docs/theory/contact.md and
/// cables.md), computed from its numbers only, as a reference for the solver's bookkeeping.
#pragma once

#include <algorithm>

#include "tests/solver/problems.h"

namespace taut::test {

struct ProblemVelocity {
  Vec3 v, w;
};

inline Vec3 Times(const std::array<std::array<double, 3>, 3>& m, const Vec3& a) {
  return {m[0][0] * a.x + m[0][1] * a.y + m[0][2] * a.z,
          m[1][0] * a.x + m[1][1] * a.y + m[1][2] * a.z,
          m[2][0] * a.x + m[2][1] * a.y + m[2][2] * a.z};
}

/// One row of J: directions and levers on bodies.
using ProblemRow = std::vector<ProblemLink>;

/// Returns all rows: n, t1, t2 for each contact, then one for each cable.
inline std::vector<ProblemRow> AllRows(const ContactProblem& p) {
  std::vector<ProblemRow> rows;
  for (const ProblemContact& c : p.contacts) {
    const Vec3 directions[3] = {c.n, c.t1, c.t2};
    for (std::size_t r = 0; r < 3; ++r) {
      rows.push_back({{c.a, directions[r], c.lever_a[r]}});
      if (c.b >= 0) rows.back().push_back({c.b, -1.0 * directions[r], -1.0 * c.lever_b[r]});
    }
  }
  for (const ProblemCable& c : p.cables) rows.push_back(c.links);
  return rows;
}

/// Returns v_free + M^-1 J^T l.
inline std::vector<ProblemVelocity> VelocitiesOf(const ContactProblem& p,
                                                 const std::vector<double>& l) {
  std::vector<ProblemVelocity> out;
  for (const ProblemBody& b : p.bodies) out.push_back({b.free_v, b.free_w});
  const std::vector<ProblemRow> rows = AllRows(p);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const ProblemLink& link : rows[i]) {
      const auto body = static_cast<std::size_t>(link.body);
      const ProblemBody& b = p.bodies[body];
      out[body].v = out[body].v + (b.inverse_mass * l[i]) * link.pull;
      out[body].w = out[body].w + l[i] * Times(b.inverse_inertia, link.lever);
    }
  }
  return out;
}

/// Returns J v.
inline std::vector<double> RatesOf(const ContactProblem& p, const std::vector<ProblemVelocity>& v) {
  std::vector<double> out;
  for (const ProblemRow& row : AllRows(p)) {
    double u = 0;
    for (const ProblemLink& link : row) {
      const ProblemVelocity& of = v[static_cast<std::size_t>(link.body)];
      u += Dot(link.pull, of.v) + Dot(link.lever, of.w);
    }
    out.push_back(u);
  }
  return out;
}

/// Returns an entry of the Delassus operator J M^-1 J^T.
inline double InverseMass(const ContactProblem& p, const ProblemRow& x, const ProblemRow& y) {
  double sum = 0;
  for (const ProblemLink& a : x) {
    for (const ProblemLink& b : y) {
      if (a.body != b.body) continue;
      const ProblemBody& body = p.bodies[static_cast<std::size_t>(a.body)];
      sum += body.inverse_mass * Dot(a.pull, b.pull) +
             Dot(a.lever, Times(body.inverse_inertia, b.lever));
    }
  }
  return sum;
}

/// Returns the distance of u and l from all laws [m/s]: the error of an equation of velocities, or
/// the error of an equation of impulses times the row's inverse mass (for tangents, a bound of it).
inline double ResidualOf(const ContactProblem& p, const std::vector<double>& u,
                         const std::vector<double>& l) {
  const std::vector<ProblemRow> rows = AllRows(p);
  const auto mass = [&](std::size_t i, std::size_t j) { return InverseMass(p, rows[i], rows[j]); };
  double worst = 0;
  std::size_t i = 0;
  for (const ProblemContact& c : p.contacts) {
    const double wn = mass(i, i), off_n = u[i] + c.bias;
    const double wt =
        std::max(mass(i + 1, i + 1), mass(i + 2, i + 2)) + std::abs(mass(i + 1, i + 2));
    const double edge = c.mu * std::max(l[i], 0.0);
    const double y1 = l[i + 1] - u[i + 1] / wt, y2 = l[i + 2] - u[i + 2] / wt;
    const double length = std::hypot(y1, y2);
    if (l[i] - off_n / wn <= 0) {  // open
      worst =
          std::max({worst, wn * std::abs(l[i]), wt * std::abs(l[i + 1]), wt * std::abs(l[i + 2])});
    } else if (length <= edge) {  // sticking
      worst = std::max({worst, std::abs(off_n), std::abs(u[i + 1]), std::abs(u[i + 2])});
    } else {  // sliding
      worst = std::max({worst, std::abs(off_n), wt * std::abs(l[i + 1] - edge * y1 / length),
                        wt * std::abs(l[i + 2] - edge * y2 / length)});
    }
    i += 3;
  }
  for (const ProblemCable& c : p.cables) {
    const double a = mass(i, i), wish = std::clamp(c.base - c.gain * u[i], 0.0, c.upper);
    worst = std::max(worst, std::abs(wish - l[i]) * a / (1 + c.gain * a));
    ++i;
  }
  return worst;
}

/// Returns true if contacts only push, friction is in its cone, and cables are between slack and
/// limit, up to rounding.
inline bool IsAdmissible(const ContactProblem& p, const std::vector<double>& l) {
  std::size_t i = 0;
  for (const ProblemContact& c : p.contacts) {
    if (!(l[i] >= 0 && std::hypot(l[i + 1], l[i + 2]) <= c.mu * l[i] * (1 + 1e-14))) return false;
    i += 3;
  }
  for (const ProblemCable& c : p.cables) {
    if (!(l[i] >= 0 && l[i] <= c.upper)) return false;
    ++i;
  }
  return true;
}

}  // namespace taut::test
