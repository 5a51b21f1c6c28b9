// Joint loads at the start: forces and torques of all constrained directions (rows), from J M^-1
// J^T x = -J M^-1 f (docs/theory/joints.md, eq. 12).
#include <cmath>

#include "base/fixed.h"
#include "math/vec.h"
#include "mechanics/held_rows.h"
#include "taut/statics.h"

namespace taut {
namespace {

/// L D L^T factorization of a symmetric matrix with positive pivots, row by row; skips zeros.
class Factors {
 public:
  explicit Factors(std::size_t size) : size_(size), a_(size * size) {}
  double& At(std::size_t i, std::size_t j) { return a_[i * size_ + j]; }

  void Factor() {
    for (std::size_t k = 0; k < size_; ++k) {
      for (std::size_t i = k + 1; i < size_; ++i) {
        const double factor = At(i, k) / At(k, k);
        if (factor == 0) continue;
        for (std::size_t j = k + 1; j <= i; ++j) At(i, j) -= factor * At(j, k);
      }
      for (std::size_t i = k + 1; i < size_; ++i) At(i, k) /= At(k, k);
    }
  }
  void Solve(std::vector<double>& x) {
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t j = 0; j < i; ++j) x[i] -= At(i, j) * x[j];
    }
    for (std::size_t i = 0; i < size_; ++i) x[i] /= At(i, i);
    for (std::size_t i = size_; i-- > 0;) {
      for (std::size_t j = i + 1; j < size_; ++j) x[i] -= At(j, i) * x[j];
    }
  }

 private:
  std::size_t size_;
  std::vector<double> a_;
};

/// Returns the wrench of a joint about the center of mass of a body.
Wrench On(const BodyDef& body, const Wrench& w, const Vec3& point, double sign) {
  return {sign * w.force, sign * (w.torque + Cross(point - body.com_m, w.force))};
}

/// Returns the inverse inertia times a vector, I^-1 t.
Vec3 TurnBy(const Inertia& i, const Vec3& t) {
  const double l1 = i.xy / i.xx, l2 = i.xz / i.xx;
  const double d1 = i.yy - l1 * i.xy, m = i.yz - l2 * i.xy, l3 = m / d1;
  const double d2 = i.zz - l2 * i.xz - l3 * m;
  const double y = t.y - l1 * t.x, z = (t.z - l2 * t.x - l3 * y) / d2, turned = y / d1 - l3 * z;
  return {t.x / i.xx - l1 * turned - l2 * z, turned, z};
}

/// Returns the wrench of the springs of a joint on its body b in the described pose.
Wrench SpringOf(const JointDef& j) {
  if (j.stiffness == 0) return {};
  const Vec3 apart = j.to_m - j.from_m;
  const double shorter = j.turned.w < 0 ? -1 : 1, cosine = std::fabs(j.turned.w);
  const Vec3 half = shorter * Vec3{j.turned.x, j.turned.y, j.turned.z};  // sin(angle / 2) * axis
  if (j.kind == JointKind::kBall) {
    const double sine = std::sqrt(Dot(half, half));
    if (sine == 0) return {};
    return {{}, (-j.stiffness * 2 * std::atan2(sine, cosine) / sine) * half};
  }
  if (j.kind == JointKind::kHinge) {
    const double angle = 2 * std::atan2(Dot(j.axis, half), cosine);
    return {{}, (-j.stiffness * (angle - j.rest)) * j.axis};
  }
  if (j.kind == JointKind::kDistance) {
    const double length = std::sqrt(Dot(apart, apart));
    return {(-j.stiffness * (length - j.rest) / length) * apart, {}};
  }
  return {(-j.stiffness * (Dot(j.axis, apart) - j.rest)) * j.axis, {}};
}

class Reactions {
 public:
  explicit Reactions(const ModelDef& def) : def_(def), loads_(StartLoads(def)) {
    for (std::size_t j = 0; j < def.joints.size(); ++j) AddRows(def.joints[j], j);
  }
  std::size_t row_count() const { return rows_.size(); }

  std::vector<JointLoad> Run() {
    std::vector<JointLoad> out;
    for (const JointDef& j : def_.joints) {
      const Wrench spring = SpringOf(j);
      out.push_back({spring.force, spring.torque});
    }
    const std::vector<double> x = Solved(RightSide(out));
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      JointLoad& load = out[rows_[r].joint];
      load.force_n = load.force_n + x[r] * rows_[r].unit.force;
      load.torque_n_m = load.torque_n_m + x[r] * rows_[r].unit.torque;
    }
    return out;
  }

 private:
  /// Body affected by a row: the row's unit force on it, and the resulting acceleration.
  struct Link {
    int body;
    Wrench on, gives;
  };
  struct Row {
    std::size_t joint;
    Wrench unit;
    std::vector<Link> links;
  };

  void AddRows(const JointDef& j, std::size_t number) {
    for (const HeldRow row : HeldRowsOf(j)) AddRow(j, number, UnitOf(j, row));
  }
  void AddRow(const JointDef& j, std::size_t number, const Wrench& unit) {
    Row row{number, unit, {}};
    const auto link = [&](int body, double sign) {
      if (base::IsFixed(def_, body)) return;
      const BodyDef& b = Body(body);
      const Wrench on = On(b, unit, j.to_m, sign);
      row.links.push_back(
          {body, on, {(1 / b.mass_kg) * on.force, TurnBy(b.inertia_kg_m2, on.torque)}});
    };
    link(j.body_b, 1);
    link(j.body_a, -1);
    rows_.push_back(row);
  }
  const BodyDef& Body(int body) const { return def_.bodies[static_cast<std::size_t>(body)]; }

  static double Couple(const Row& a, const Row& b) {
    double sum = 0;
    for (const Link& x : a.links) {
      for (const Link& y : b.links) {
        if (x.body != y.body) continue;
        sum += Dot(x.on.force, y.gives.force) + Dot(x.on.torque, y.gives.torque);
      }
    }
    return sum;
  }

  /// Returns the accelerations along the rows under all known loads; the rows must cancel them.
  std::vector<double> RightSide(const std::vector<JointLoad>& springs) const {
    std::vector<Wrench> known(def_.bodies.size());
    for (std::size_t b = 0; b < known.size(); ++b) {
      known[b] = {loads_[b].cable_force_n + loads_[b].weight_n, loads_[b].cable_torque_n_m};
    }
    for (std::size_t j = 0; j < springs.size(); ++j) {
      const JointDef& joint = def_.joints[j];
      const auto add = [&](int body, double sign) {
        if (base::IsFixed(def_, body)) return;
        const Wrench on =
            On(Body(body), {springs[j].force_n, springs[j].torque_n_m}, joint.to_m, sign);
        Wrench& sum = known[static_cast<std::size_t>(body)];
        sum = {sum.force + on.force, sum.torque + on.torque};
      };
      add(joint.body_b, 1);
      add(joint.body_a, -1);
    }
    std::vector<double> b;
    for (const Row& row : rows_) {
      double sum = 0;
      for (const Link& link : row.links) {
        const Wrench& f = known[static_cast<std::size_t>(link.body)];
        sum -= Dot(link.gives.force, f.force) + Dot(link.gives.torque, f.torque);
      }
      b.push_back(sum);
    }
    return b;
  }

  /// Solves for the loads. Redundant rows share their load: each has a small compliance, a fraction
  /// of its inverse mass. Further passes remove the error caused by the compliance.
  std::vector<double> Solved(const std::vector<double>& b) const {
    constexpr double kCompliance = 1e-9;
    constexpr int kPasses = 4;
    const std::size_t n = rows_.size();
    Factors a(n), factors(n);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        factors.At(i, j) = a.At(i, j) = a.At(j, i) = Couple(rows_[i], rows_[j]);
      }
      factors.At(i, i) *= 1 + kCompliance;
    }
    factors.Factor();
    std::vector<double> x(n), left = b;
    for (int pass = 0; pass < kPasses; ++pass) {
      factors.Solve(left);
      for (std::size_t i = 0; i < n; ++i) x[i] += left[i];
      for (std::size_t i = 0; i < n; ++i) {
        left[i] = b[i];
        for (std::size_t j = 0; j < n; ++j) left[i] -= a.At(i, j) * x[j];
      }
    }
    return x;
  }

  const ModelDef& def_;
  std::vector<BodyLoad> loads_;
  std::vector<Row> rows_;
};

}  // namespace

std::vector<JointLoad> StartJointLoads(const ModelDef& def) {
  Reactions reactions(def);
  if (reactions.row_count() > kMostHeldDirections) return {};
  return reactions.Run();
}

std::vector<LeftLoad> LeftAtStart(const ModelDef& def, const std::vector<JointLoad>& joints) {
  std::vector<LeftLoad> left;
  for (const BodyLoad& load : StartLoads(def)) {
    left.push_back({load.cable_force_n + load.weight_n, load.cable_torque_n_m});
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const JointDef& joint = def.joints[j];
    const auto add = [&](int body, double sign) {
      if (body == kWorld) return;
      const std::size_t b = static_cast<std::size_t>(body);
      const Wrench on =
          On(def.bodies[b], {joints[j].force_n, joints[j].torque_n_m}, joint.to_m, sign);
      left[b] = {left[b].force_n + on.force, left[b].torque_n_m + on.torque};
    };
    add(joint.body_b, 1);
    add(joint.body_a, -1);
  }
  return left;
}

}  // namespace taut
