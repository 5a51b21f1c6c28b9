// Between which limits forces lie that friction and redundant supports leave open
// (docs/theory/inverse_statics.md, section 4).
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "analysis/force_balance.h"
#include "analysis/quadratic_program.h"
#include "math/vec.h"
#include "taut/inverse_statics.h"

namespace taut {
namespace {

using analysis::ConeSide;
using analysis::ForceBalance;
using analysis::ForceLimits;
using analysis::HoldingUnknown;
using analysis::QuadraticOutcome;
using Eigen::Index;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kFirstPlanes = 8;
constexpr int kMostCuts = 40;
/// How far friction may be beyond its cone, as a share of the largest load.
constexpr double kOnCone = 1e-8;

class Intervals {
 public:
  Intervals(const ModelDef& def, const LoadCaseSpec& loads, const IntervalOptions& options)
      : def_(def),
        options_(options),
        balance_(def, loads, options.touches, options.known_tensions),
        all_(balance_.Solve()),
        load_(balance_.LargestLoad()),
        angles_(analysis::EvenAngles(options.touches.size(), kFirstPlanes)) {}

  ForceIntervals Run() {
    ForceIntervals out;
    out.notes = analysis::WhatIsLeftOut(def_);
    out.undetermined = static_cast<int>(all_.free.cols());
    if (!Feasible(out)) return out;
    out.found = true;
    for (std::size_t t = 0; t < options_.touches.size(); ++t) {
      out.touch.push_back(Of(VectorXd::Unit(balance_.size(), balance_.TouchColumn(t)), 0));
    }
    for (std::size_t i = 0; i < def_.cables.size(); ++i) {
      if (options_.known_tensions) {
        const double tension = balance_.known_cable_n[i];
        out.cable.push_back({tension, tension, 0});
      } else {
        out.cable.push_back(Of(VectorXd::Unit(balance_.size(), static_cast<Index>(i)), 0));
      }
    }
    Joints(out);
    return out;
  }

 private:
  using Angles = std::vector<std::vector<double>>;
  ForceLimits Limits(const Angles& angles, ConeSide side) const {
    ForceLimits limits;
    LimitCables(balance_, options_.bounds, limits);
    LimitTouches(balance_, options_.touches, angles, side, limits);
    return limits;
  }

  /// The least of goal . x, of forces in units of the largest load, within planes at the cones.
  analysis::QuadraticAnswer Least(const VectorXd& goal, const Angles& angles, ConeSide side) const {
    const ForceLimits limits = Limits(angles, side);
    analysis::QuadraticProgram program;
    const Index free = all_.free.cols();
    program.hessian = Eigen::MatrixXd::Zero(free, free);
    program.gradient = all_.free.transpose() * goal;
    if (program.gradient.norm() < 1e-12 * goal.norm()) program.gradient.setZero();
    if (limits.rows.rows() > 0) {
      program.inequalities = limits.rows * all_.free;
      // What balances to a tolerance only may miss a limit by as much.
      program.at_least = (limits.at_least - limits.rows * all_.particular) / load_ -
                         VectorXd::Constant(limits.at_least.size(), Slack());
    }
    return analysis::Solve(program);
  }
  double Slack() const { return 2 * all_.left_n / load_ + 1e-12; }
  VectorXd Forces(const VectorXd& y) const { return all_.particular + load_ * (all_.free * y); }

  /// Planes where these forces are beyond their cones, or wherever there is friction, if `all`.
  /// False: they are within, so that there is nothing to cut.
  bool Cut(const VectorXd& x, Angles& angles, bool all = false) const {
    bool cut = false;
    for (std::size_t t = 0; t < options_.touches.size(); ++t) {
      const double friction = options_.touches[t].friction;
      if (!(friction > 0)) continue;
      const Index first = balance_.TouchColumn(t);
      const double across = std::hypot(x[first + 1], x[first + 2]);
      if (across <= (all ? 0.0 : friction * x[first] + kOnCone * load_)) continue;
      double angle = std::atan2(x[first + 2], x[first + 1]);
      if (angle < 0) angle += 2 * std::acos(-1.0);
      angles[t].push_back(angle);
      cut = true;
    }
    return cut;
  }

  /// The least value of a force, -infinity if there is none; from outside and, `inner`, from inside
  /// the cones. Nothing: no forces hold.
  std::optional<double> LeastOf(const VectorXd& goal, double* inner) {
    double value = 0;
    VectorXd x = VectorXd::Zero(balance_.size());
    for (int round = 0; round < kMostCuts; ++round) {
      const analysis::QuadraticAnswer answer = Least(goal, angles_, ConeSide::kOuter);
      if (answer.outcome == QuadraticOutcome::kInfeasible) return std::nullopt;
      if (answer.outcome == QuadraticOutcome::kUnbounded) {
        value = -kInfinity;  // a ray beyond a cone is cut off like a force
        if (!Cut(all_.free * answer.ray * load_, angles_)) break;
        continue;
      }
      if (answer.outcome != QuadraticOutcome::kSolved) return -kInfinity;
      x = Forces(answer.x);
      value = goal.dot(x);
      if (!Cut(x, angles_)) break;
    }
    if (inner != nullptr) {
      *inner = value;
      if (std::isfinite(value)) {
        Angles angles = angles_;
        Cut(x, angles, true);  // the inner planes meet where the forces are
        const analysis::QuadraticAnswer answer = Least(goal, angles, ConeSide::kInner);
        *inner =
            answer.outcome == QuadraticOutcome::kSolved ? goal.dot(Forces(answer.x)) : kInfinity;
      }
    }
    return value;
  }

  ForceInterval Of(const VectorXd& goal, double known) {
    double inner_low = 0, inner_high = 0;
    ForceInterval interval;
    interval.low_n = known + LeastOf(goal, &inner_low).value_or(0);
    interval.high_n = known - LeastOf(-goal, &inner_high).value_or(0);
    if (std::isfinite(interval.low_n)) {
      interval.uncertain_n = std::max(0.0, known + inner_low - interval.low_n);
    }
    if (std::isfinite(interval.high_n)) {
      interval.uncertain_n = std::max(interval.uncertain_n, interval.high_n - known + inner_high);
    }
    return interval;
  }

  bool Feasible(ForceIntervals& out) {
    const bool balances = all_.left_n <= options_.tolerance * load_;
    if (balances && LeastOf(VectorXd::Zero(balance_.size()), nullptr)) return true;
    const VectorXd x = analysis::Nearest(balance_, Limits(angles_, ConeSide::kOuter));
    out.left = balance_.Left(x);
    out.why = out.left.empty()
                  ? "no forces within their bounds balance the loads"
                  : "no forces within their bounds balance " + balance_.Words(out.left);
    return false;
  }

  void Joints(ForceIntervals& out) {
    const std::size_t joints = def_.joints.size();
    // A joint's force is linear in x: its value without unknowns, and what each adds.
    const std::vector<JointLoad> known = balance_.JointLoads(VectorXd::Zero(balance_.size()));
    std::vector<VectorXd> x(joints, VectorXd::Zero(balance_.size())), y = x, z = x;
    for (Index i = 0; i < balance_.size(); ++i) {
      if (balance_.unknowns[static_cast<std::size_t>(i)].kind != HoldingUnknown::Kind::kRow)
        continue;
      const std::size_t j = balance_.JointOf(i);
      const Vec3 force =
          balance_.JointLoads(VectorXd::Unit(balance_.size(), i))[j].force_n - known[j].force_n;
      x[j][i] = force.x, y[j][i] = force.y, z[j][i] = force.z;
    }
    for (std::size_t j = 0; j < joints; ++j) {
      out.joint_x.push_back(Of(x[j], known[j].force_n.x));
      out.joint_y.push_back(Of(y[j], known[j].force_n.y));
      out.joint_z.push_back(Of(z[j], known[j].force_n.z));
    }
  }

  const ModelDef& def_;
  const IntervalOptions& options_;
  ForceBalance balance_;
  ForceBalance::Solutions all_;
  double load_;
  Angles angles_;
};

}  // namespace

ForceIntervals FindForceIntervals(const ModelDef& def, const LoadCaseSpec& loads,
                                  const IntervalOptions& options, Diagnostics& out) {
  const std::size_t before = out.items().size();
  analysis::CheckHolding(def, loads, options.touches, options.bounds, out);
  if (!(options.tolerance >= 0)) out.Error({}, "the tolerance must be a number of at least 0");
  if (out.items().size() > before) {
    ForceIntervals none;
    none.why = "the options are wrong";
    return none;
  }
  return Intervals(def, loads, options).Run();
}

}  // namespace taut
