// Arc-length continuation of equilibria (docs/theory/statics.md, section 8): predictor along the
// tangent of the path, corrector by Newton's method on a plane normal to it.
#include "taut/load_path.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "analysis/load_share.h"
#include "analysis/structure.h"

namespace taut {
namespace analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kResidual = 1e-9;  ///< Allowed residual, relative to the largest force.
constexpr double kApart = 1e-11;    ///< Allowed constraint violation, share of the size.
constexpr double kLongest = 0.03;   ///< Largest displacement of a step, share of the size.
constexpr double kMostLoad = 0.1;   ///< Largest change of the load factor, share of its end.
constexpr double kSharpest = 0.9;   ///< Least cosine between successive tangents.
constexpr double kShortest = 1e-7;  ///< Least step relative to the first one.
constexpr double kUnstable = 1e-9;  ///< Share of the largest stiffness that counts as negative.
constexpr int kMostCorrections = 12, kMostHalvings = 40, kMostEvents = 60;

/// Point of the path in the unknowns of the solver.
struct State {
  Placement at;
  VectorXd rows;  ///< Reactions of the joints' constraints.
  double factor = 0;
};

/// Tangent of the path, or a change along it; motions with six entries per body.
struct Change {
  VectorXd motions;
  VectorXd rows;
  double factor = 0;
};

class Path {
 public:
  Path(const ModelDef& def, const LoadCaseSpec& loads, const LoadPathOptions& options)
      : def_(def), loads_(loads), options_(options) {}

  LoadPath Run() {
    const std::optional<State> first = Start();
    if (!first) return std::move(out_);
    State now = *first;
    Change along{VectorXd::Zero(Motions()), VectorXd::Zero(now.rows.size()), 1};
    along = TangentAt(now, along, true);
    // Both parts of the arc length are alike at first.
    length_m_ = std::max(along.motions.norm(), 1e-6 * size_m_);
    Normalize(along);
    out_.points.push_back(PointAt(now));
    const double first_step = 0.05;
    double step = first_step;
    for (int count = 0; count < options_.most_steps; ++count) {
      step = std::min(step, kLongest * size_m_ / std::max(along.motions.norm(), 1e-300));
      step = std::min(step,
                      kMostLoad * options_.to_factor / std::max(std::fabs(along.factor), 1e-300));
      std::optional<std::pair<State, Change>> next;
      while (!(next = Advance(now, along, step)) && step > kShortest * first_step) step *= 0.5;
      if (!next) {
        out_.why = "no equilibrium follows: the step of the path became too short";
        return std::move(out_);
      }
      AddEvents(now, along, step, *next);
      if (std::fabs(next->first.factor) >= options_.to_factor) return End(now, next->first);
      std::tie(now, along) = *next;
      out_.points.push_back(PointAt(now));
      if (LargestMove(def_, out_.points.back().pose).distance_m >
          options_.most_displacement * size_m_) {
        out_.why = "a node has moved farther than the limit of the path";
        return std::move(out_);
      }
      step *= 1.5;
    }
    out_.why = "the path has reached its maximum number of steps";
    return std::move(out_);
  }

 private:
  Index Motions() const { return motions_; }

  Structure At(double factor) const { return Structure(def_, ShareOf(loads_, factor), false); }

  /// Residuals and their derivatives at a state.
  struct Linear {
    MatrixXd basis;  ///< Effective motions.
    VectorXd unbalanced, apart, unbalanced_per_factor, apart_per_factor;
    MatrixXd stiffness, held;
    double largest_n = 1;
  };

  Linear LinearAt(const State& state) const {
    Linear linear;
    const Structure s = At(state.factor);
    linear.basis = s.Effective(state.at, true);
    VectorXd gradient;
    MatrixXd hessian;
    Residual(s, state, gradient, linear.apart, &hessian, &linear.held);
    linear.unbalanced = linear.basis.transpose() * gradient;
    linear.stiffness = linear.basis.transpose() * hessian * linear.basis;
    linear.held = linear.held * linear.basis;
    const double by = 1e-5 * std::max(1.0, std::fabs(state.factor));
    VectorXd after, before, apart_after, apart_before;
    Residual(At(state.factor + by), state, after, apart_after, nullptr, nullptr);
    Residual(At(state.factor - by), state, before, apart_before, nullptr, nullptr);
    linear.unbalanced_per_factor = linear.basis.transpose() * (after - before) / (2 * by);
    linear.apart_per_factor = (apart_after - apart_before) / (2 * by);
    for (const Structure::Cable& cable : s.cables) {
      linear.largest_n =
          std::max(linear.largest_n, s.Tension(cable, cable.path.At(state.at, false).value));
    }
    for (const Vec3& weight : s.weight_n)
      linear.largest_n = std::max(linear.largest_n, Of(weight).norm());
    for (const Structure::Load& load : s.loads) {
      linear.largest_n = std::max(linear.largest_n, Of(load.force_n).norm());
    }
    if (state.rows.size() > 0) {
      linear.largest_n = std::max(linear.largest_n, state.rows.cwiseAbs().maxCoeff());
    }
    return linear;
  }

  static void Residual(const Structure& s, const State& state, VectorXd& gradient, VectorXd& apart,
                       MatrixXd* hessian, MatrixXd* held) {
    s.Energy(state.at, gradient, hessian);
    s.AddReactions(state.at, {state.rows, VectorXd::Zero(0)}, gradient, hessian);
    const auto rows = static_cast<Index>(s.rows.size());
    apart.resize(rows);
    if (held != nullptr) *held = MatrixXd::Zero(rows, s.motions());
    for (Index r = 0; r < rows; ++r) {
      const Coordinate c = s.RowAt(static_cast<std::size_t>(r), state.at);
      apart[r] = c.value;
      for (std::size_t b = 0; held != nullptr && b < c.bodies.size(); ++b) {
        held->row(r).segment<6>(6 * c.bodies[b]) +=
            c.gradient.segment<6>(6 * static_cast<Index>(b)).transpose();
      }
    }
  }

  /// Solves the linear system of equilibrium, bordered by the condition that the change has the
  /// product `advance` with `along`. Motions without stiffness do not change.
  Change Solve(const Linear& linear, const Change& along, double advance, bool homogeneous,
               bool by_factor) const {
    const Index n = linear.basis.cols(), m = linear.held.rows();
    MatrixXd matrix = MatrixXd::Zero(n + m + 1, n + m + 1);
    VectorXd right = VectorXd::Zero(n + m + 1);
    const double k = stiffness_n_per_m_, force = k * length_m_;  // scales of rows and columns
    matrix.topLeftCorner(n, n) = linear.stiffness / k;
    matrix.block(0, n, n, m) = linear.held.transpose();
    matrix.block(n, 0, m, n) = linear.held;
    matrix.block(0, n + m, n, 1) = linear.unbalanced_per_factor * options_.to_factor / force;
    matrix.block(n, n + m, m, 1) = linear.apart_per_factor * options_.to_factor / length_m_;
    if (!by_factor) {
      matrix.block(n + m, 0, 1, n) = (along.motions.transpose() * linear.basis) / length_m_;
    }
    matrix(n + m, n + m) = by_factor ? 1 : along.factor / options_.to_factor;
    if (!homogeneous) {
      right.head(n) = -linear.unbalanced / force;
      right.segment(n, m) = -linear.apart / length_m_;
    }
    right[n + m] = advance;
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver;
    solver.setThreshold(1e-12);
    solver.compute(matrix);
    const VectorXd x = solver.solve(right);
    return {linear.basis * x.head(n) * length_m_, x.segment(n, m) * force,
            x[n + m] * options_.to_factor};
  }

  Change TangentAt(const State& state, const Change& along, bool by_factor) const {
    Change tangent = Solve(LinearAt(state), along, 1, true, by_factor);
    if (!by_factor) Normalize(tangent);
    return tangent;
  }

  double Product(const Change& a, const Change& b) const {
    return a.motions.dot(b.motions) / (length_m_ * length_m_) +
           a.factor * b.factor / (options_.to_factor * options_.to_factor);
  }
  void Normalize(Change& change) const {
    const double size = std::sqrt(Product(change, change));
    change.motions /= size, change.rows /= size, change.factor /= size;
  }

  static void Move(State& state, const Change& change, double by) {
    state.at = Moved(state.at, by * change.motions);
    state.rows += by * change.rows;
    state.factor += by * change.factor;
  }

  /// Solves the equilibrium on the plane normal to `along`, or at the state's load factor.
  bool Correct(State& state, const Change& along, bool by_factor) const {
    double before = HUGE_VAL;
    for (int i = 0; i < kMostCorrections; ++i) {
      const Linear linear = LinearAt(state);
      const double left =
          linear.unbalanced.size() > 0 ? linear.unbalanced.cwiseAbs().maxCoeff() : 0;
      const double apart = linear.apart.size() > 0 ? linear.apart.cwiseAbs().maxCoeff() : 0;
      const double rounding = 1e-15 * size_m_ * stiffness_n_per_m_;
      if (left <= std::max(kResidual * linear.largest_n, rounding) && apart <= kApart * size_m_) {
        return true;
      }
      if (!std::isfinite(left) || left > 1e6 * before) return false;
      before = std::max(left, kResidual * linear.largest_n);
      const Change change = Solve(linear, along, 0, false, by_factor);
      if (!(change.motions.cwiseAbs().maxCoeff() < size_m_)) return false;
      Move(state, change, 1);
    }
    return false;
  }

  std::optional<State> Start() {
    const Structure s = At(0);
    motions_ = s.motions();
    size_m_ = s.size_m, stiffness_n_per_m_ = std::max(s.stiffness_n_per_m, 1e-9);
    length_m_ = size_m_;
    out_.left_out = s.left_out;
    if (s.bodies.empty()) {
      out_.why = "no body can move";
      return std::nullopt;
    }
    EquilibriumOptions options;
    options.contact = false;
    const LoadCaseSpec nothing = ShareOf(loads_, 0);
    const Equilibrium unloaded = FindEquilibrium(def_, nothing, options);
    if (!unloaded.found) {
      out_.why = "no equilibrium at load factor 0: " + unloaded.why;
      return std::nullopt;
    }
    State state{s.start, VectorXd::Zero(static_cast<Index>(s.rows.size())), 0};
    for (std::size_t b = 0; b < s.bodies.size(); ++b) {
      const BodyState& body = unloaded.pose.bodies[static_cast<std::size_t>(s.bodies[b])];
      state.at.center_m[b] = body.position_m, state.at.turn[b] = body.orientation;
    }
    if (!Correct(state, {}, true)) {
      out_.why = "no equilibrium at load factor 0";
      return std::nullopt;
    }
    return state;
  }

  std::optional<std::pair<State, Change>> Advance(const State& from, const Change& along,
                                                  double step) const {
    State state = from;
    Move(state, along, step);
    if (!Correct(state, along, false)) return std::nullopt;
    Change tangent = TangentAt(state, along, false);
    if (!(Product(tangent, along) > kSharpest) && step > 1e-3 * 0.05) return std::nullopt;
    return std::pair(std::move(state), std::move(tangent));
  }

  LoadedPoint PointAt(const State& state) const {
    LoadedPoint point;
    const Structure s = At(state.factor);
    point.load_factor = state.factor;
    for (const BodyDef& body : def_.bodies) point.pose.bodies.push_back({body.com_m, {}, {}, {}});
    for (std::size_t b = 0; b < s.bodies.size(); ++b) {
      BodyState& body = point.pose.bodies[static_cast<std::size_t>(s.bodies[b])];
      body.position_m = state.at.center_m[b], body.orientation = state.at.turn[b];
    }
    for (const Structure::Cable& cable : s.cables) {
      point.pose.rest_lengths_m.push_back(cable.rest_m);
      point.cable_tension_n.push_back(s.Tension(cable, cable.path.At(state.at, false).value));
    }
    for (const PlacedJoint& joint : s.joints) {
      point.bar_force_n.push_back(IsBar(joint.def)
                                      ? joint.def.stiffness *
                                            (DistanceAt(joint, state.at).value - joint.def.rest)
                                      : 0);
    }
    const Structure whole = At(1);
    double work = 0, sum_n = 0;
    for (const Structure::Load& load : whole.loads) {
      const Vec3 way = PlaceOf(load.point, state.at) - PlaceOf(load.point, whole.start);
      work += Dot(load.force_n, way);
      sum_n += Of(load.force_n).norm();
    }
    point.displacement_m = sum_n > 0 ? work / sum_n : 0;
    point.stable = IsStable(LinearAt(state));
    return point;
  }

  static bool IsStable(const Linear& linear) {
    MatrixXd motions = MatrixXd::Identity(linear.basis.cols(), linear.basis.cols());
    if (linear.held.rows() > 0) {
      const Eigen::JacobiSVD<MatrixXd> svd(linear.held, Eigen::ComputeFullV);
      Index rank = 0;
      while (rank < svd.singularValues().size() &&
             svd.singularValues()[rank] > 1e-9 * svd.singularValues()[0]) {
        ++rank;
      }
      motions = svd.matrixV().rightCols(linear.basis.cols() - rank);
    }
    if (motions.cols() == 0) return true;
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(
        motions.transpose() * linear.stiffness * motions, Eigen::EigenvaluesOnly);
    return solver.eigenvalues()[0] >= -kUnstable * linear.stiffness.cwiseAbs().maxCoeff();
  }

  std::vector<bool> Slack(const State& state) const {
    std::vector<bool> slack;
    const Structure s = At(state.factor);
    for (const Structure::Cable& cable : s.cables) {
      slack.push_back(!(s.Tension(cable, cable.path.At(state.at, false).value) > 0));
    }
    return slack;
  }

  /// Inserts the points of a step at which the load factor turns back or cables change, found by
  /// bisection of the step.
  void AddEvents(const State& from, const Change& along, double step,
                 const std::pair<State, Change>& to) {
    struct Event {
      double step;
      LoadedPoint point;
    };
    std::vector<Event> events;
    const auto find = [&](const auto& has_changed) -> std::optional<Event> {
      if (++events_ > kMostEvents) return std::nullopt;
      double low = 0, high = step;
      State best = to.first;
      for (int i = 0; i < kMostHalvings && high - low > 1e-9 * step; ++i) {
        const double middle = 0.5 * (low + high);
        const auto there = Advance(from, along, middle);
        if (!there) break;
        if (has_changed(*there)) {
          high = middle, best = there->first;
        } else {
          low = middle;
        }
      }
      return Event{high, PointAt(best)};
    };
    if (along.factor * to.second.factor < 0) {
      auto event = find([&](const std::pair<State, Change>& there) {
        return along.factor * there.second.factor < 0;
      });
      if (event) {
        event->point.limit = true;
        events.push_back(std::move(*event));
      }
    }
    const std::vector<bool> before = Slack(from), after = Slack(to.first);
    for (std::size_t c = 0; c < before.size(); ++c) {
      if (before[c] == after[c]) continue;
      auto event = find(
          [&](const std::pair<State, Change>& there) { return Slack(there.first)[c] == after[c]; });
      if (!event) continue;
      (after[c] ? event->point.went_slack : event->point.went_taut).push_back(static_cast<int>(c));
      events.push_back(std::move(*event));
    }
    std::sort(events.begin(), events.end(),
              [](const Event& a, const Event& b) { return a.step < b.step; });
    for (Event& event : events) out_.points.push_back(std::move(event.point));
  }

  /// Adds the equilibrium at the last load factor, between two points of the path.
  LoadPath End(const State& before, const State& after) {
    const double last = after.factor > 0 ? options_.to_factor : -options_.to_factor;
    State state = after;
    state.factor = last;
    if (!Correct(state, {}, true)) {
      state = before;
      state.factor = last;
      if (!Correct(state, {}, true)) state = after;
    }
    out_.points.push_back(PointAt(state));
    return std::move(out_);
  }

  const ModelDef& def_;
  const LoadCaseSpec& loads_;
  const LoadPathOptions& options_;
  Index motions_ = 0;
  double size_m_ = 1, stiffness_n_per_m_ = 1;
  double length_m_ = 1;  ///< Scale of motions in the arc length.
  int events_ = 0;
  LoadPath out_;
};

}  // namespace
}  // namespace analysis

LoadPath FollowLoads(const ModelDef& def, const LoadCaseSpec& loads,
                     const LoadPathOptions& options) {
  return analysis::Path(def, loads, options).Run();
}

}  // namespace taut
