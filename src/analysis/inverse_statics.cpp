// Inverse statics: forces of least cost that hold a pose (docs/theory/inverse_statics.md, section
// 2).
#include "taut/inverse_statics.h"

#include <Eigen/Core>
#include <cmath>

#include "analysis/force_balance.h"
#include "analysis/quadratic_program.h"
#include "math/cable_law.h"

namespace taut {
namespace {

using analysis::ForceBalance;
using analysis::ForceLimits;
using analysis::HoldingUnknown;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Number of planes per friction cone. With 32 inner planes, the usable friction is up to 0.5 % too
/// small.
constexpr int kPlanes = 32;
/// Tolerance of the balance, as a share of the largest load.
constexpr double kBalanced = 1e-9;

/// Returns the weight of T^2 in the objective.
double WeightOf(HoldingCost cost, double stiffness, double length) {
  switch (cost) {
    case HoldingCost::kTension:
      return 1;
    case HoldingCost::kEnergy:
      return 0.5 / stiffness;
    case HoldingCost::kForceDensity:
      break;
  }
  return 1 / (length * length);
}

class Holding {
 public:
  Holding(const ModelDef& def, const LoadCaseSpec& loads, const HoldingOptions& options)
      : def_(def), loads_(loads), options_(options), balance_(def, loads, options.touches, false) {
    LimitCables(balance_, options.bounds, limits_);
    LimitTouches(balance_, options.touches, analysis::EvenAngles(options.touches.size(), kPlanes),
                 analysis::ConeSide::kInner, limits_);
    weights_ = VectorXd::Zero(balance_.size());
    for (Index i = 0; i < balance_.size(); ++i) {
      const HoldingUnknown& unknown = balance_.unknowns[static_cast<std::size_t>(i)];
      if (unknown.kind != HoldingUnknown::Kind::kCable) continue;
      weights_[i] = WeightOf(options.minimise, def.cables[unknown.index].stiffness_n_per_m,
                             balance_.cable_length_m[unknown.index]);
    }
  }

  HoldingForces Run() {
    HoldingForces out;
    out.notes = analysis::WhatIsLeftOut(def_);
    VectorXd x;
    out.found = Least(x, out.why);
    if (!out.found) x = analysis::Nearest(balance_, limits_);
    Report(x, out);
    if (out.found) return out;
    out.left = balance_.Left(x);
    if (!out.left.empty()) {
      out.why = "no forces within their bounds balance the loads; out of balance: " +
                balance_.Words(out.left);
    }
    return out;
  }

 private:
  /// Solves the program for the coordinates y of the null space (eq. 2), in units of the largest
  /// load and the largest weight.
  bool Least(VectorXd& x, std::string& why) {
    const ForceBalance::Solutions all = balance_.Solve();
    const double load = balance_.LargestLoad();
    if (all.left_n > kBalanced * load) {
      why = "no forces balance the loads, even without bounds";
      return false;
    }
    const double heaviest = weights_.size() > 0 ? weights_.maxCoeff() : 0;
    const VectorXd weights = weights_ / (heaviest > 0 ? heaviest : 1);
    const VectorXd start = all.particular / load;
    analysis::QuadraticProgram program;
    program.hessian = all.free.transpose() * weights.asDiagonal() * all.free;
    program.gradient = all.free.transpose() * weights.cwiseProduct(start);
    if (limits_.rows.rows() > 0) {
      program.inequalities = limits_.rows * all.free;
      program.at_least = limits_.at_least / load - limits_.rows * start;
    }
    const analysis::QuadraticAnswer answer = analysis::Solve(program);
    if (answer.outcome == analysis::QuadraticOutcome::kSolved) {
      x = load * (start + all.free * answer.x);
      return true;
    }
    why = answer.outcome == analysis::QuadraticOutcome::kInfeasible
              ? "no forces within their bounds balance the loads"
              : "the search for forces did not converge";
    return false;
  }

  void Report(const VectorXd& x, HoldingForces& out) const {
    ReportCables(x, out);
    out.joint_loads = balance_.JointLoads(x);
    out.bar_force_n = balance_.BarForces(x);
    for (std::size_t j = 0; j < def_.joints.size(); ++j) {
      const JointDef& joint = def_.joints[j];
      const Vec3 d{joint.to_m.x - joint.from_m.x, joint.to_m.y - joint.from_m.y,
                   joint.to_m.z - joint.from_m.z};
      const double length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
      out.bar_rest_m.push_back(IsBar(joint) ? length - out.bar_force_n[j] / joint.stiffness : 0.0);
    }
    for (std::size_t t = 0; t < options_.touches.size(); ++t) {
      out.touch_force_n.push_back(balance_.TouchForce(t, x));
    }
    out.cost = weights_.dot(x.cwiseAbs2());
    const VectorXd left = balance_.load - balance_.columns * x;
    out.residual_n = left.size() > 0 ? left.lpNorm<Eigen::Infinity>() : 0.0;
  }

  void ReportCables(const VectorXd& x, HoldingForces& out) const {
    std::vector<double> warmth(def_.cables.size(), 0.0);
    for (const LoadCaseSpec::Lengthening& longer : loads_.cables) {
      warmth[static_cast<std::size_t>(longer.index)] += longer.by_m;
    }
    for (std::size_t i = 0; i < def_.cables.size(); ++i) {  // cable tensions are the first unknowns
      const CableDef& cable = def_.cables[i];
      const double tension = std::fmax(0.0, x[static_cast<Index>(i)]);
      const double length = balance_.cable_length_m[i];
      const double rest = length - math::CableLaw{cable.stiffness_n_per_m}.Stretch(tension);
      const double from = options_.calibration_rest_m.empty() ? cable.rest_length_m
                                                              : options_.calibration_rest_m[i];
      out.cable_tension_n.push_back(tension);
      out.cable_force_density_n_per_m.push_back(tension / length);
      out.rest_length_m.push_back(rest);
      out.command_m.push_back(rest - warmth[i] - from);
      const CableBounds bound = options_.bounds.empty() ? CableBounds{} : options_.bounds[i];
      const auto near = [&](double limit) {
        return std::isfinite(limit) &&
               std::fabs(tension - limit) <= 1e-9 * std::fmax(balance_.LargestLoad(), limit);
      };
      if (near(std::fmax(bound.at_least_n, bound.at_least_n_per_m * length)) ||
          near(std::fmin(bound.at_most_n, bound.at_most_n_per_m * length))) {
        out.at_bound.push_back(static_cast<int>(i));
      }
      if (!out.found) continue;
      const double least = std::fmax(0.0, cable.actuator.kind == ActuatorDef::Kind::kNone
                                              ? 0.0
                                              : cable.actuator.min_rest_length_m);
      if (rest <= least) {
        out.notes.push_back("cable " + cable.name + " would need a rest length of " +
                            std::to_string(rest) +
                            " m: it is too soft, or its actuator cannot wind that far");
      }
    }
  }

  const ModelDef& def_;
  const LoadCaseSpec& loads_;
  const HoldingOptions& options_;
  ForceBalance balance_;
  ForceLimits limits_;
  VectorXd weights_;
};

}  // namespace

HoldingForces FindHoldingForces(const ModelDef& def, const LoadCaseSpec& loads,
                                const HoldingOptions& options, Diagnostics& out) {
  const std::size_t before = out.items().size();
  analysis::CheckHolding(def, loads, options.touches, options.bounds, out);
  if (!options.calibration_rest_m.empty() &&
      options.calibration_rest_m.size() != def.cables.size()) {
    out.Error("inverse_statics.wrong_number_of_rest_lengths", {},
              "the calibration has " + std::to_string(options.calibration_rest_m.size()) +
                  " rest lengths for " + std::to_string(def.cables.size()) + " cables");
  }
  if (out.items().size() > before) {
    HoldingForces none;
    none.why = "the options are invalid";
    return none;
  }
  return Holding(def, loads, options).Run();
}

}  // namespace taut
