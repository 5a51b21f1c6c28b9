/// Coupling of cables through bodies: the Delassus operator of their tensions. The coupling
/// determines which cables are too stiff for explicit forces (docs/theory/cables.md, eq. 7).

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "math/cable_wheel.h"
#include "math/vec.h"
#include "sim/data/tables.h"

namespace taut::sim {
namespace {

/// Force and torque on one body from a unit tension, at the start.
struct Pull {
  int body;
  Vec3 force, torque;  ///< The torque is in the principal frame.
};

Vec3 PointInWorld(const Tables& t, const AttachmentTable& a) {
  const Vec3 p{a.p_P[0], a.p_P[1], a.p_P[2]};
  if (a.body == t.body_count) return p;
  const double* q = t.q_WP0.data() + static_cast<std::size_t>(4 * a.body);
  return t.def().bodies[static_cast<std::size_t>(a.body)].com_m +
         Rotate({q[0], q[1], q[2], q[3]}, p);
}

bool IsOfWheel(const std::vector<Wheel<Vec3>>& wheels, int point) {
  return std::any_of(wheels.begin(), wheels.end(),
                     [&](const Wheel<Vec3>& w) { return point == w.at || point == w.at + 1; });
}

std::vector<Pull> PullsOf(const Tables& t, const CableTable& cable) {
  const AttachmentTable* const ends = t.attachments.data() + cable.first_attachment;
  const int count = cable.attachment_count;
  std::vector<PathPoint<Vec3>> path(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    path[static_cast<std::size_t>(i)].p = PointInWorld(t, ends[i]);
  }
  std::vector<Wheel<Vec3>> wheels;
  for (int k = 0; k < cable.wheel_count; ++k) {
    const WheelTable& w = t.wheels[static_cast<std::size_t>(cable.first_wheel + k)];
    const Vec3 center = PointInWorld(t, t.spots[static_cast<std::size_t>(w.center_spot)]);
    const Vec3 tip = PointInWorld(t, t.spots[static_cast<std::size_t>(w.axis_spot)]);
    wheels.push_back({center, tip - center, w.radius_m, w.start_angle, w.at, 0, 0, 0});
  }
  LayOnWheels(path.data(), cable.wheel_count, wheels.data());
  MeasurePath(count, path.data(), cable.wheel_count, wheels.data());
  std::vector<Pull> pulls;
  for (int i = 0; i < count; ++i) {
    if (ends[i].body == t.body_count) continue;
    const double* q = t.q_WP0.data() + static_cast<std::size_t>(4 * ends[i].body);
    const Quat to_P = Conjugate({q[0], q[1], q[2], q[3]});
    Vec3 arm{ends[i].p_P[0], ends[i].p_P[1], ends[i].p_P[2]};
    if (IsOfWheel(wheels, i)) {
      const Vec3 com = t.def().bodies[static_cast<std::size_t>(ends[i].body)].com_m;
      arm = Rotate(to_P, path[static_cast<std::size_t>(i)].p - com);
    }
    const Vec3 force = PullAt(count, path.data(), i);
    pulls.push_back({ends[i].body, force, Cross(arm, Rotate(to_P, force))});
  }
  return pulls;
}

/// Returns the change of the rate of cable `b` per impulse in cable `a` [1/kg].
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

/// Returns the largest possible coupling of a cable with itself through a rod that it may touch.
/// The worst case is a cable folded back at an end of the rod. Cable forces have no torque about
/// the rod's axis.
double RodCoupling(const Tables& t, const TouchTable& touch) {
  double most = 0;
  for (int i = touch.first_rod; i < touch.first_rod + touch.rod_count; ++i) {
    const TouchRodTable& rod = t.touch_rods[static_cast<std::size_t>(i)];
    const Vec3 center{rod.center_P[0], rod.center_P[1], rod.center_P[2]};
    const Vec3 axis{rod.axis_P[0], rod.axis_P[1], rod.axis_P[2]};
    for (const double half_m : {-rod.half_m, rod.half_m}) {
      for (const Vec3& force : {Vec3{2, 0, 0}, Vec3{0, 2, 0}, Vec3{0, 0, 2}}) {
        const Vec3 across = force - Dot(force, axis) * axis;
        const std::vector<Pull> pull{{rod.body, across, Cross(center + half_m * axis, across)}};
        most = std::max(most, Coupling(t, pull, pull));
      }
    }
  }
  return most;
}

/// Row of a symmetric matrix: columns in ascending order, with their entries.
using SparseRow = std::vector<std::pair<std::size_t, double>>;

/// Returns the largest eigenvalue of a symmetric positive semidefinite matrix, by power iteration.
double LargestEigenvalue(const std::vector<SparseRow>& matrix) {
  const std::size_t n = matrix.size();
  std::vector<double> x(n), y(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = 1.0 + 0.01 * static_cast<double>(i % 7);
  double eigenvalue = 0;
  for (int iteration = 0; iteration < 200; ++iteration) {
    double norm2 = 0;
    for (std::size_t i = 0; i < n; ++i) {
      y[i] = 0;
      for (const auto& [j, a] : matrix[i]) y[i] += a * x[j];
      norm2 += y[i] * y[i];
    }
    eigenvalue = std::sqrt(norm2);
    if (!(eigenvalue > 0)) return 0;
    for (std::size_t i = 0; i < n; ++i) x[i] = y[i] / eigenvalue;
  }
  return 1.05 * eigenvalue;  // power iteration converges from below
}

}  // namespace

void CoupleCables(Tables& tables) {
  const std::size_t n = tables.cables.size();
  std::vector<std::vector<Pull>> pulls;
  std::vector<std::vector<std::size_t>> cables_at(static_cast<std::size_t>(tables.body_count));
  for (std::size_t i = 0; i < n; ++i) {
    pulls.push_back(PullsOf(tables, tables.cables[i]));
    for (const Pull& pull : pulls[i]) {
      const auto body = static_cast<std::size_t>(pull.body);
      if (!tables.def().bodies[body].fixed) cables_at[body].push_back(i);
    }
  }
  std::vector<SparseRow> matrix(n);
  tables.coupling.assign(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<std::size_t> others;  // cables on a common body
    for (const Pull& pull : pulls[i]) {
      const auto& here = cables_at[static_cast<std::size_t>(pull.body)];
      others.insert(others.end(), here.begin(), here.end());
    }
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    for (const std::size_t j : others) {
      // (i, j) and (j, i) have the same bits, because the sum has the same order.
      const double a = Coupling(tables, pulls[std::min(i, j)], pulls[std::max(i, j)]);
      matrix[i].emplace_back(j, a);
      tables.coupling[i] += std::fabs(a);
    }
  }
  tables.largest_coupling = LargestEigenvalue(matrix);
  double by_rods = 0;
  for (const TouchTable& touch : tables.touches) {
    const double more = RodCoupling(tables, touch);
    tables.coupling[static_cast<std::size_t>(touch.cable)] += more;
    by_rods = std::max(by_rods, more);
  }
  tables.largest_coupling += by_rods;
}

}  // namespace taut::sim
