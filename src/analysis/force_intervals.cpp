// Bounds of forces that are indeterminate because of friction or redundant supports, by linear
// programs with cutting planes (docs/theory/inverse_statics.md, section 4).
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "analysis/force_balance.h"
#include "analysis/quadratic_program.h"
#include "base/fixed.h"
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
/// Tolerance of the friction cone, as a share of the largest load.
constexpr double kOnCone = 1e-8;

class Intervals {
 public:
  /// `largest_n`: reference force for tolerances [N]. The largest load is used if it is larger.
  Intervals(const ModelDef& def, const LoadCaseSpec& loads, const IntervalOptions& options,
            double largest_n)
      : def_(def),
        options_(options),
        balance_(def, loads, options.touches, options.known_tensions),
        all_(balance_.Solve()),
        load_(std::max(largest_n, balance_.LargestLoad())),
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

  /// Minimizes goal . x within the planes of the friction cones. Forces are in units of the largest
  /// load.
  analysis::QuadraticAnswer Least(const VectorXd& goal, const Angles& angles, ConeSide side) const {
    const ForceLimits limits = Limits(angles, side);
    analysis::QuadraticProgram program;
    const Index free = all_.free.cols();
    program.hessian = Eigen::MatrixXd::Zero(free, free);
    program.gradient = all_.free.transpose() * goal;
    if (program.gradient.norm() < 1e-12 * goal.norm()) program.gradient.setZero();
    if (limits.rows.rows() > 0) {
      program.inequalities = limits.rows * all_.free;
      // Tolerance of the limits: the residual of the balance plus rounding.
      program.at_least = (limits.at_least - limits.rows * all_.particular) / load_ -
                         VectorXd::Constant(limits.at_least.size(), Slack());
    }
    return analysis::Solve(program);
  }
  double Slack() const { return 2 * all_.left_n / load_ + 1e-12; }
  VectorXd Forces(const VectorXd& y) const { return all_.particular + load_ * (all_.free * y); }

  /// Adds cutting planes at contacts whose friction exceeds its cone. If `all`, adds them at all
  /// contacts with a friction force. Returns false if no plane was added.
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

  /// Returns the least value of a force for the outer cones, -infinity if unbounded, or nothing if
  /// the loads cannot be balanced. `inner` receives the least value for the inner cones.
  std::optional<double> LeastOf(const VectorXd& goal, double* inner) {
    double value = 0;
    VectorXd x = VectorXd::Zero(balance_.size());
    for (int round = 0; round < kMostCuts; ++round) {
      const analysis::QuadraticAnswer answer = Least(goal, angles_, ConeSide::kOuter);
      if (answer.outcome == QuadraticOutcome::kInfeasible) return std::nullopt;
      if (answer.outcome == QuadraticOutcome::kUnbounded) {
        value = -kInfinity;  // also add planes for a ray that leaves a cone
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
        Cut(x, angles, true);  // adds edges of the inner cones at these forces
        const analysis::QuadraticAnswer answer = Least(goal, angles, ConeSide::kInner);
        *inner =
            answer.outcome == QuadraticOutcome::kSolved ? goal.dot(Forces(answer.x)) : kInfinity;
      }
    }
    return value;
  }

  ForceInterval Of(const VectorXd& goal, double known) {
    if ((all_.free.transpose() * goal).norm() <= 1e-12 * goal.norm()) {
      const double force_n = known + goal.dot(all_.particular);
      return {force_n, force_n, 0};
    }
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
                  : "no forces within their bounds balance the loads; out of balance: " +
                        balance_.Words(out.left);
    return false;
  }

  void Joints(ForceIntervals& out) {
    const std::size_t joints = def_.joints.size();
    // A joint's force is linear in x: constant part, plus a contribution of each unknown.
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

/// Islands: sets of bodies connected by unknown forces. Stores for each body the first body of its
/// island; -1 for static bodies.
class Islands {
 public:
  Islands(const ModelDef& def, const IntervalOptions& options) {
    for (std::size_t b = 0; b < def.bodies.size(); ++b) {
      first_.push_back(base::IsFixed(def, static_cast<int>(b)) ? -1 : static_cast<int>(b));
    }
    for (const JointDef& joint : def.joints) Join(joint.body_a, joint.body_b);
    for (const TouchDef& touch : options.touches) Join(touch.body, touch.other);
    for (const CableDef& cable : def.cables) {
      for (const AttachmentDef& at : cable.attachments) {
        if (!options.known_tensions) Join(cable.attachments.front().body, at.body);
      }
    }
  }
  /// Returns the first body of each island.
  std::vector<int> All() const {
    std::vector<int> all;
    for (std::size_t b = 0; b < first_.size(); ++b) {
      if (Of(static_cast<int>(b)) == static_cast<int>(b)) all.push_back(static_cast<int>(b));
    }
    return all;
  }
  int Of(int body) const {
    while (body >= 0 && first_[static_cast<std::size_t>(body)] != body) {
      body = first_[static_cast<std::size_t>(body)];
    }
    return body;
  }

 private:
  void Join(int a, int b) {
    a = Of(a), b = Of(b);
    if (a >= 0 && b >= 0) first_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  std::vector<int> first_;
};

/// Returns the largest known force [N], the reference for rounding errors of the residual.
double LargestForce(const ModelDef& def, const LoadCaseSpec& loads) {
  double largest_n = 0;
  const auto note = [&](double force_n) { largest_n = std::max(largest_n, std::fabs(force_n)); };
  const double gravity =
      loads.GravityFactor() * std::sqrt(Dot(def.gravity_m_per_s2, def.gravity_m_per_s2));
  for (const BodyDef& body : def.bodies) {
    if (!body.fixed) note(body.mass_kg * gravity);
  }
  for (const CableDef& cable : def.cables) note(CableTension(cable));
  for (const LoadCaseSpec::NodeForce& load : loads.forces) {
    note(std::sqrt(Dot(load.force_n, load.force_n)));
  }
  return largest_n;
}

/// Solves one island at a time with all other bodies fixed, since the cost of a program grows
/// faster than its size.
class InParts {
 public:
  InParts(const ModelDef& def, const LoadCaseSpec& loads, const IntervalOptions& options)
      : def_(def),
        loads_(loads),
        options_(options),
        islands_(def, options),
        largest_n_(LargestForce(def, loads)) {}

  ForceIntervals Run() {
    const std::vector<int> all = islands_.All();
    if (all.size() < 2) return Intervals(def_, loads_, options_, largest_n_).Run();
    ForceIntervals out;
    out.notes = analysis::WhatIsLeftOut(def_);
    out.found = true;
    out.touch.resize(options_.touches.size());
    out.joint_x.resize(def_.joints.size());
    out.joint_y = out.joint_z = out.joint_x;
    for (const int island : all) Add(island, out);
    if (out.found) return out;
    ForceIntervals none;
    none.notes = out.notes, none.why = out.why, none.left = out.left;
    none.undetermined = out.undetermined;
    return none;
  }

 private:
  void Add(int island, ForceIntervals& out) const {
    ModelDef def = def_;
    for (std::size_t b = 0; b < def.bodies.size(); ++b) {
      if (islands_.Of(static_cast<int>(b)) != island) def.bodies[b].fixed = true;
    }
    IntervalOptions options = options_;
    options.touches.clear();
    std::vector<std::size_t> touches, joints;
    for (std::size_t t = 0; t < options_.touches.size(); ++t) {
      const TouchDef& touch = options_.touches[t];
      if (islands_.Of(touch.body) != island && islands_.Of(touch.other) != island) continue;
      touches.push_back(t), options.touches.push_back(touch);
    }
    LoadCaseSpec loads = loads_;
    def.joints.clear(), loads.bars.clear();
    for (std::size_t j = 0; j < def_.joints.size(); ++j) {
      const JointDef& joint = def_.joints[j];
      if (islands_.Of(joint.body_a) != island && islands_.Of(joint.body_b) != island) continue;
      for (LoadCaseSpec::Lengthening longer : loads_.bars) {
        if (longer.index != static_cast<int>(j)) continue;
        longer.index = static_cast<int>(joints.size());
        loads.bars.push_back(longer);
      }
      joints.push_back(j), def.joints.push_back(joint);
    }
    const ForceIntervals one = Intervals(def, loads, options, largest_n_).Run();
    out.undetermined += one.undetermined;
    out.left.insert(out.left.end(), one.left.begin(), one.left.end());
    if (!one.found) {
      if (out.found) out.why = one.why;
      out.found = false;
      return;
    }
    out.cable = one.cable;  // known tensions
    for (std::size_t i = 0; i < touches.size(); ++i) out.touch[touches[i]] = one.touch[i];
    for (std::size_t i = 0; i < joints.size(); ++i) {
      out.joint_x[joints[i]] = one.joint_x[i];
      out.joint_y[joints[i]] = one.joint_y[i];
      out.joint_z[joints[i]] = one.joint_z[i];
    }
  }

  const ModelDef& def_;
  const LoadCaseSpec& loads_;
  const IntervalOptions& options_;
  Islands islands_;
  double largest_n_;
};

}  // namespace

ForceIntervals FindForceIntervals(const ModelDef& def, const LoadCaseSpec& loads,
                                  const IntervalOptions& options, Diagnostics& out) {
  const std::size_t before = out.items().size();
  analysis::CheckHolding(def, loads, options.touches, options.bounds, out);
  if (!(options.tolerance >= 0))
    out.Error("force_intervals.bad_tolerance", {}, "the tolerance must be a number of at least 0");
  if (out.items().size() > before) {
    ForceIntervals none;
    none.why = "the options are invalid";
    return none;
  }
  return InParts(def, loads, options).Run();
}

}  // namespace taut
