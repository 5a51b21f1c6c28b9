/// How strongly cables act on each other through the bodies: decides which are too stiff for
/// explicit forces (docs/theory/cables.md, eq. 7).

#include <algorithm>
#include <cmath>

#include "math/vec.h"
#include "sim/tables.h"

namespace taut::sim {
namespace {

/// What a unit tension does to one body, at the start.
struct Pull {
  int body;
  Vec3 force, torque;  ///< Torque in the principal frame.
};

Vec3 PointInWorld(const Tables& t, const AttachmentTable& a) {
  const Vec3 p{a.p_P[0], a.p_P[1], a.p_P[2]};
  if (a.body == t.body_count) return p;
  const double* q = t.q_WP0.data() + static_cast<std::size_t>(4 * a.body);
  return t.def().bodies[static_cast<std::size_t>(a.body)].com_m +
         Rotate({q[0], q[1], q[2], q[3]}, p);
}

std::vector<Pull> PullsOf(const Tables& t, const CableTable& cable) {
  std::vector<Pull> pulls;
  const auto add = [&](const AttachmentTable& a, const Vec3& force) {
    if (a.body == t.body_count) return;
    const double* q = t.q_WP0.data() + static_cast<std::size_t>(4 * a.body);
    const Vec3 local = Rotate(Conjugate({q[0], q[1], q[2], q[3]}), force);
    pulls.push_back({a.body, force, Cross({a.p_P[0], a.p_P[1], a.p_P[2]}, local)});
  };
  for (int i = 1; i < cable.attachment_count; ++i) {
    const auto& from = t.attachments[static_cast<std::size_t>(cable.first_attachment + i - 1)];
    const auto& to = t.attachments[static_cast<std::size_t>(cable.first_attachment + i)];
    const Vec3 d = PointInWorld(t, to) - PointInWorld(t, from);
    const double length = std::sqrt(Dot(d, d));
    const Vec3 u = (length > 0 ? 1 / length : 0.0) * d;
    add(from, u);
    add(to, -1.0 * u);
  }
  return pulls;
}

/// Change of rate of cable `b` per impulse in cable `a` [1/kg].
double Coupling(const Tables& t, const std::vector<Pull>& a, const std::vector<Pull>& b) {
  double sum = 0;
  for (const Pull& p : a) {
    for (const Pull& q : b) {
      const BodyDef& body = t.def().bodies[static_cast<std::size_t>(p.body)];
      if (p.body != q.body || body.fixed) continue;
      const double* moments = t.inertia.data() + static_cast<std::size_t>(3 * p.body);
      sum += Dot(p.force, q.force) / body.mass_kg + p.torque.x * q.torque.x / moments[0] +
             p.torque.y * q.torque.y / moments[1] + p.torque.z * q.torque.z / moments[2];
    }
  }
  return sum;
}

/// The largest eigenvalue of a symmetric positive semidefinite matrix, by power iteration.
double LargestEigenvalue(const std::vector<double>& matrix, std::size_t n) {
  std::vector<double> x(n), y(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = 1.0 + 0.01 * static_cast<double>(i % 7);
  double eigenvalue = 0;
  for (int iteration = 0; iteration < 200; ++iteration) {
    double norm2 = 0;
    for (std::size_t i = 0; i < n; ++i) {
      y[i] = 0;
      for (std::size_t j = 0; j < n; ++j) y[i] += matrix[i * n + j] * x[j];
      norm2 += y[i] * y[i];
    }
    eigenvalue = std::sqrt(norm2);
    if (!(eigenvalue > 0)) return 0;
    for (std::size_t i = 0; i < n; ++i) x[i] = y[i] / eigenvalue;
  }
  return 1.05 * eigenvalue;  // power iteration comes from below
}

}  // namespace

void CoupleCables(Tables& tables) {
  const std::size_t n = tables.cables.size();
  std::vector<std::vector<Pull>> pulls;
  for (const CableTable& cable : tables.cables) pulls.push_back(PullsOf(tables, cable));
  std::vector<double> matrix(n * n);
  tables.coupling.assign(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i; j < n; ++j) {
      const double a = Coupling(tables, pulls[i], pulls[j]);
      matrix[i * n + j] = matrix[j * n + i] = a;
      tables.coupling[i] += std::fabs(a);
      if (j != i) tables.coupling[j] += std::fabs(a);
    }
  }
  tables.largest_coupling = LargestEigenvalue(matrix, n);
}

}  // namespace taut::sim
