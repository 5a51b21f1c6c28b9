/// Integration schemes of cables, for comparison: masses that hang below each other on cables, in
/// one dimension. taut uses none of these; its two schemes are measured in its core
/// (work_precision.cpp). The figure is docs/theory/work_precision.md.
///
///   s_c       stretch of cable c [m]: x_c - x_c-1, downward, from where all cables are just taut
///   r_c       its rate [m/s]
///   theta     weight of the end of the step in a mean of start and end: 1 implicit Euler,
///             1/2 implicit midpoint
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace taut::test {

inline constexpr double kGravity = 9.81;

/// Equal masses, equal cables; cable c holds mass c below mass c - 1, cable 0 hangs from the world.
struct Hanging {
  int masses = 1;
  double mass_kg = 0.1, stiffness_n_per_m = 400, damping_n_s_per_m = 0;
  double weight_n(int cable) const { return (masses - cable) * mass_kg * kGravity; }
};

struct HangingState {
  std::vector<double> x_m, v_m_per_s, tension_n;
};

/// One scheme: steps a state by h and counts its work in visits to a cable: an evaluation of its
/// force, the assembly of its row, or one relaxation of its row in a sweep.
class CableScheme {
 public:
  CableScheme(std::string name, double theta, int substeps, int max_sweeps)
      : name_(std::move(name)), theta_(theta), substeps_(substeps), max_sweeps_(max_sweeps) {}

  const std::string& name() const { return name_; }
  long visits() const { return visits_; }

  void Step(const Hanging& robot, HangingState& s, double h) {
    for (int i = 0; i < substeps_; ++i) {
      if (theta_ > 0) {
        Implicit(robot, s, h / substeps_);
      } else {
        Explicit(robot, s, h / substeps_);
      }
    }
  }

 private:
  static double Difference(const std::vector<double>& of, std::size_t cable) {
    return of[cable] - (cable > 0 ? of[cable - 1] : 0.0);
  }

  /// Semi-implicit (symplectic) Euler: v' = v + h f(x, v), x' = x + h v'.
  void Explicit(const Hanging& robot, HangingState& s, double h) {
    const std::size_t n = s.x_m.size();
    for (std::size_t c = 0; c < n; ++c) {
      const double stretch = Difference(s.x_m, c), rate = Difference(s.v_m_per_s, c);
      const double force = robot.stiffness_n_per_m * stretch + robot.damping_n_s_per_m * rate;
      s.tension_n[c] = stretch > 0 ? std::max(force, 0.0) : 0.0;
      ++visits_;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double below = i + 1 < n ? s.tension_n[i + 1] : 0.0;
      s.v_m_per_s[i] += h * (kGravity + (below - s.tension_n[i]) / robot.mass_kg);
      s.x_m[i] += h * s.v_m_per_s[i];
    }
  }

  /// Tensions as compliant rows of a solver, with Gauss-Seidel sweeps until they converge:
  ///   T = k s + (theta h k + b) (theta r' + (1 - theta) r) >= 0,
  ///   x' = x + h (theta v' + (1 - theta) v)
  void Implicit(const Hanging& robot, HangingState& s, double h) {
    const std::size_t n = s.x_m.size();
    const std::vector<double> before = s.v_m_per_s;
    const double slope = theta_ * h * robot.stiffness_n_per_m + robot.damping_n_s_per_m;
    std::vector<double> base(n), impulse(n);
    for (std::size_t c = 0; c < n; ++c) {
      base[c] = robot.stiffness_n_per_m * Difference(s.x_m, c) +
                (1 - theta_) * slope * Difference(before, c);
      impulse[c] = h * s.tension_n[c];  // warm start
      ++visits_;
    }
    for (std::size_t i = 0; i < n; ++i) {
      s.v_m_per_s[i] +=
          h * kGravity + ((i + 1 < n ? impulse[i + 1] : 0.0) - impulse[i]) / robot.mass_kg;
    }
    for (int sweep = 0; sweep < max_sweeps_; ++sweep) {
      double change = 0;
      for (std::size_t c = 0; c < n; ++c) {
        const double effect = (c > 0 ? 2 : 1) / robot.mass_kg;
        const double wish = h * (base[c] + theta_ * slope * Difference(s.v_m_per_s, c));
        const double d =
            std::max(impulse[c] + (wish - impulse[c]) / (1 + h * theta_ * slope * effect), 0.0) -
            impulse[c];
        impulse[c] += d;
        s.v_m_per_s[c] -= d / robot.mass_kg;
        if (c > 0) s.v_m_per_s[c - 1] += d / robot.mass_kg;
        change = std::max(change, std::fabs(d) * effect);
        ++visits_;
      }
      if (change <= 1e-10) break;
    }
    for (std::size_t i = 0; i < n; ++i) {
      s.tension_n[i] = impulse[i] / h;
      s.x_m[i] += h * (theta_ * s.v_m_per_s[i] + (1 - theta_) * before[i]);
    }
  }

  std::string name_;
  double theta_;
  int substeps_, max_sweeps_;
  long visits_ = 0;
};

inline std::vector<CableScheme> CableSchemes() {
  return {
      {"symplectic Euler", 0, 1, 0},
      {"symplectic Euler, 8 substeps", 0, 8, 0},
      {"implicit Euler rows", 1, 1, 1000},
      {"implicit Euler rows, 8 substeps of one sweep", 1, 8, 1},
      {"theta = 0.6 rows", 0.6, 1, 1000},
      {"implicit midpoint rows", 0.5, 1, 1000},
  };
}

}  // namespace taut::test
