// Search for an equilibrium: Newton's method in a trust region with an augmented Lagrangian, and
// dynamic relaxation (docs/theory/statics.md, section 4).
#include "analysis/minimum.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace taut::analysis {
namespace {

/// Augmented Lagrangian: the structure's energy plus springs for constraints. Shifting the springs
/// until the constraints hold yields the reactions (eq. 13).
class Augmented {
 public:
  Augmented(const Structure& structure, Reactions& holding)
      : s_(structure),
        holding_(holding),
        penalty_(kStiffer * structure.stiffness_n_per_m),
        reach2_(structure.size_m * structure.size_m) {}

  double Energy(const Placement& at, Eigen::VectorXd& gradient, Eigen::MatrixXd* hessian) const {
    double energy = s_.Energy(at, gradient, hessian);
    for (std::size_t r = 0; r < s_.rows.size(); ++r) {
      const Coordinate c = s_.RowAt(r, at);
      const double stiffness = StiffnessOf(r);
      const double force = holding_.rows[Index(r)] + stiffness * c.value;
      energy += (holding_.rows[Index(r)] + 0.5 * stiffness * c.value) * c.value;
      Add(c, force, stiffness, gradient, hessian);
    }
    for (std::size_t t = 0; t < s_.touches.size(); ++t) {
      const double held = holding_.touches[Index(t)];
      if (held == 0 && !MayTouch(t, at)) continue;
      const Coordinate c = s_.GapAt(t, at);
      const double push = std::fmax(0.0, held - penalty_ * c.value);
      energy += 0.5 * (push * push - held * held) / penalty_;
      if (push > 0) Add(c, -push, penalty_, gradient, hessian);
    }
    return energy;
  }

  /// Sets the reactions to the forces of the constraint springs. Returns the largest constraint
  /// violation [m] before this update.
  double Shift(const Placement& at) {
    double apart = 0;
    for (std::size_t r = 0; r < s_.rows.size(); ++r) {
      const Coordinate c = s_.RowAt(r, at);
      holding_.rows[Index(r)] += StiffnessOf(r) * c.value;
      apart = std::max(apart, std::fabs(c.value) * (Turns(r) ? s_.size_m : 1.0));
    }
    for (std::size_t t = 0; t < s_.touches.size(); ++t) {
      const double gap = s_.GapAt(t, at).value, held = holding_.touches[Index(t)];
      const double push = std::fmax(0.0, held - penalty_ * gap);
      apart = std::max(apart, std::fabs(push - held) / penalty_);
      holding_.touches[Index(t)] = push;
    }
    return apart;
  }

  /// Returns the force error of the stiffest springs due to the rounding of positions [N].
  double Rounding() const {
    constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
    const bool held = !s_.rows.empty() || !s_.touches.empty();
    return kEpsilon * s_.size_m * (held ? penalty_ : s_.stiffness_n_per_m);
  }

  double LargestForce() const {
    double largest = 0;
    for (std::size_t r = 0; r < s_.rows.size(); ++r) {
      const double force = std::fabs(holding_.rows[Index(r)]);
      largest = std::max(largest, Turns(r) ? force / s_.size_m : force);
    }
    if (holding_.touches.size() > 0) largest = std::max(largest, holding_.touches.maxCoeff());
    return largest;
  }

 private:
  static constexpr double kStiffer = 100;  ///< Penalty stiffness divided by the largest member
                                           ///< stiffness.
  static Eigen::Index Index(std::size_t i) { return static_cast<Eigen::Index>(i); }
  bool Turns(std::size_t row) const {
    const HeldRow r = s_.rows[row].row;
    return r == HeldRow::kSwing1 || r == HeldRow::kSwing2 || r == HeldRow::kTwist;
  }
  double StiffnessOf(std::size_t row) const { return Turns(row) ? penalty_ * reach2_ : penalty_; }
  bool MayTouch(std::size_t t, const Placement& at) const {
    const Structure::Touch& touch = s_.touches[t];
    return Of(touch.normal).dot(Of(PlaceOf(touch.point, at))) < touch.offset_m;
  }

  const Structure& s_;
  Reactions& holding_;
  double penalty_, reach2_;
};

/// Returns the largest tension, spring force, weight or load [N], the reference for residuals.
double LargestForce(const Structure& s, const Placement& at) {
  double largest = 0;
  for (const Structure::Cable& cable : s.cables) {
    largest = std::max(largest, s.Tension(cable, cable.path.At(at, false).value));
  }
  for (const PlacedJoint& joint : s.joints) {
    if (joint.def.stiffness == 0) continue;
    const Coordinate energy = SpringEnergyAt(joint, at);
    for (std::size_t i = 0; i < energy.bodies.size(); ++i) {
      largest = std::max(largest, energy.gradient.segment<3>(6 * static_cast<int>(i)).norm());
    }
  }
  for (const Vec3& weight : s.weight_n) largest = std::max(largest, Of(weight).norm());
  for (const Structure::Load& load : s.loads) largest = std::max(largest, Of(load.force_n).norm());
  return largest;
}

/// Trust-region step in the eigenvectors of the Hessian. The absolute values of eigenvalues are
/// used, so that the step decreases the energy along negative curvature, too (eq. 14).
struct Spectrum {
  Eigen::VectorXd values, slopes;
  Eigen::MatrixXd vectors;
  Eigen::VectorXd StepWithin(double radius, double noise_n) const {
    const double floor = 1e-13 * values.cwiseAbs().maxCoeff() + 1e-300;
    const auto step = [&](double more) {
      Eigen::VectorXd parts(values.size());
      for (Eigen::Index i = 0; i < values.size(); ++i) {
        const double stiff = std::fabs(values[i]);
        const bool nothing = stiff < 1e3 * floor && std::fabs(slopes[i]) < noise_n;
        parts[i] = nothing ? 0 : -slopes[i] / (std::max(stiff, floor) + more);
      }
      return parts;
    };
    Eigen::VectorXd parts = step(0);
    if (parts.norm() > radius) {
      double low = 0, high = slopes.norm() / radius + floor;
      for (int i = 0; i < 60; ++i) {
        const double middle = low > 0 ? std::sqrt(low * high) : 1e-12 * high;
        parts = step(middle);
        (parts.norm() > radius ? low : high) = middle;
        if (low > 0 && high < 1.01 * low) break;
      }
      parts = step(high);
    }
    return parts;
  }
};

/// Minimization of the energy with fixed reactions.
class Inner {
 public:
  Inner(const Structure& s, const Augmented& energy, const SearchLimits& limits, Search& search)
      : s_(s), energy_(energy), limits_(limits), search_(search), radius_(0.1 * s.size_m) {}

  /// Iterates until the residual is below `goal_n`, progress stops, or `most` linear systems were
  /// solved.
  void Run(double goal_n, int most) {
    most = std::min(limits_.most_iterations, search_.iterations + most);
    Eigen::VectorXd gradient;
    Eigen::MatrixXd hessian;
    double now = energy_.Energy(search_.at, gradient, &hessian);
    bool last = false;
    while (search_.iterations < most) {
      const Eigen::MatrixXd basis = s_.Effective(search_.at, true);
      const Eigen::VectorXd slope = basis.transpose() * gradient;
      search_.left_n = slope.size() == 0 ? 0 : slope.cwiseAbs().maxCoeff();
      if (search_.left_n <= kFine * goal_n || (search_.left_n <= goal_n && last)) return;
      // After convergence, one more step reduces the residual to the rounding error.
      last = search_.left_n <= goal_n;
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(basis.transpose() * hessian *
                                                                  basis);
      const Spectrum spectrum{solver.eigenvalues(), solver.eigenvectors().transpose() * slope,
                              solver.eigenvectors()};
      if (!Step(basis, spectrum, last ? kFine * goal_n : goal_n, last, now, gradient, hessian))
        return;
      if (Left()) return;
    }
  }

 private:
  static constexpr double kFine = 1e-3;
  bool Step(const Eigen::MatrixXd& basis, const Spectrum& spectrum, double goal_n, bool once,
            double& now, Eigen::VectorXd& gradient, Eigen::MatrixXd& hessian) {
    constexpr double kRounding = 1e-13;
    while (search_.iterations < limits_.most_iterations && radius_ > 1e-15 * s_.size_m) {
      ++search_.iterations;
      const Eigen::VectorXd parts = spectrum.StepWithin(radius_, goal_n);
      const double length = parts.norm();
      if (length == 0) return false;
      const double promised =
          -(spectrum.slopes.dot(parts) + 0.5 * parts.dot(spectrum.values.cwiseProduct(parts)));
      const Placement to = Moved(search_.at, basis * (spectrum.vectors * parts));
      Eigen::VectorXd gradient_to;
      Eigen::MatrixXd hessian_to;
      const double then = energy_.Energy(to, gradient_to, &hessian_to);
      // If the energies differ only by rounding, accept the step if it decreases the residual.
      const double noise =
          kRounding * (std::fabs(now) + std::fabs(then)) +
          kRounding * spectrum.values.cwiseAbs().maxCoeff() * s_.size_m * s_.size_m;
      const Eigen::VectorXd slope_to = s_.Effective(to, true).transpose() * gradient_to;
      const double left = slope_to.size() == 0 ? 0 : slope_to.cwiseAbs().maxCoeff();
      const bool fine = promised < noise || std::fabs(then - now) < noise;
      const double gain = fine ? (left < search_.left_n ? 1 : -1) : (now - then) / promised;
      if (gain > 0.75 && length > 0.8 * radius_) radius_ = std::min(2 * radius_, 4 * s_.size_m);
      if (gain < 0.25) radius_ = 0.25 * std::min(length, radius_);
      if (!(gain > 1e-4)) {
        if (once) return false;
        continue;
      }
      search_.at = to, now = then, gradient = gradient_to, hessian = hessian_to;
      search_.left_n = left;
      return true;
    }
    return false;
  }

  /// Returns whether a body has moved by more than 1000 times the structure's size.
  bool Left() {
    for (std::size_t b = 0; b < search_.at.center_m.size(); ++b) {
      const Vec3 way = search_.at.center_m[b] - s_.start.center_m[b];
      if (Dot(way, way) > 1e6 * s_.size_m * s_.size_m) search_.runs_away = true;
    }
    return search_.runs_away;
  }

  const Structure& s_;
  const Augmented& energy_;
  const SearchLimits& limits_;
  Search& search_;
  double radius_;
};

}  // namespace

void Minimise(const Structure& s, const SearchLimits& limits, Search& search) {
  constexpr int kMostInVain = 60;
  // Robots that roll or slide far converge faster if reactions are updated after at most 25 linear
  // systems.
  constexpr int kLong = 25;
  constexpr double kClosed = 1e-12;  ///< Tolerance of constraints, as a share of the structure's
                                     ///< size.
  Augmented energy(s, search.holding);
  search.balanced = search.runs_away = false;
  const bool held = !s.rows.empty() || !s.touches.empty();
  for (int in_vain = 0; in_vain < kMostInVain;) {
    const int before = search.iterations;
    search.largest_n = std::max({1.0, LargestForce(s, search.at), energy.LargestForce()});
    const double goal = limits.tolerance * search.largest_n;
    Inner inner(s, energy, limits, search);
    inner.Run(goal, held ? kLong : limits.most_iterations);
    if (search.runs_away) return;
    search.apart_m = energy.Shift(search.at);
    search.largest_n = std::max({1.0, LargestForce(s, search.at), energy.LargestForce()});
    // Steel bars under small loads cannot reach the tolerance: rounded positions change their
    // forces.
    const double least_n = std::max(limits.tolerance * search.largest_n, energy.Rounding());
    const bool at_rest = search.left_n <= least_n;
    search.balanced = at_rest && (!held || search.apart_m <= kClosed * s.size_m);
    if (search.balanced || search.iterations >= limits.most_iterations) return;
    if (!at_rest && !held) return;
    in_vain += search.iterations - before < kLong;
  }
}

void Relax(const Structure& s, int steps, Search& search) {
  Augmented energy(s, search.holding);
  // Includes the stiffness of the constraint springs; the time step is 1.
  const double stiffness = 400 * s.stiffness_n_per_m;
  Eigen::VectorXd gradient, velocity = Eigen::VectorXd::Zero(0);
  double before = 0;
  for (int step = 0; step < steps; ++step) {
    energy.Energy(search.at, gradient, nullptr);
    const Eigen::MatrixXd basis = s.Effective(search.at, true);
    const Eigen::VectorXd slope = basis.transpose() * gradient;
    if (velocity.size() == 0) velocity = Eigen::VectorXd::Zero(s.motions());
    velocity -= basis * slope / stiffness;
    const double kinetic = (basis.transpose() * velocity).squaredNorm();
    if (kinetic < before) velocity.setZero();
    before = kinetic < before ? 0 : kinetic;
    search.at = Moved(search.at, velocity);
    if (step % 50 == 49) energy.Shift(search.at);
  }
}

}  // namespace taut::analysis
