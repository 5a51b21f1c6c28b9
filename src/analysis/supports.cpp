// Missing supports: free rigid motions, and load cases that act along them (docs/theory/statics.md,
// section 4).
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/structure_members.h"
#include "analysis/svd.h"
#include "analysis/whole_motions.h"
#include "base/brief.h"
#include "math/vec.h"
#include "taut/analysis.h"

namespace taut {
namespace analysis {
namespace {

using base::Brief;

constexpr double kSmall = 1e-9;

/// Formats a vector; components that are rounding errors relative to `size` become 0.
std::string Text(const Vec3& a, double size) {
  const auto part = [&](double x) { return Brief(std::fabs(x) < kSmall * size ? 0 : x); };
  return "(" + part(a.x) + ", " + part(a.y) + ", " + part(a.z) + ")";
}

/// Joins "x", "y", "z" as "x, y and z".
std::string Joined(const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) text += i + 1 == parts.size() ? " and " : ", ";
    text += parts[i];
  }
  return text;
}

/// Returns an orthonormal basis of the span of the columns that uses coordinate axes where
/// possible.
std::vector<Vec3> AxesIn(const Eigen::MatrixXd& span) {
  std::vector<Vec3> axes;
  Eigen::MatrixXd rest = span;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(i);
    if ((span.transpose() * unit).norm() < 1 - kSmall) continue;
    axes.push_back(To(unit));
    rest -= unit * (unit.transpose() * rest).eval();
  }
  const Eigen::Index left = span.cols() - static_cast<Eigen::Index>(axes.size());
  if (left <= 0) return axes;
  const analysis::Svd svd(rest, Eigen::ComputeThinU);
  for (Eigen::Index i = 0; i < left; ++i) {
    Eigen::Vector3d unit = svd.matrixU().col(i);
    Eigen::Index largest = 0;
    unit.cwiseAbs().maxCoeff(&largest);
    if (unit[largest] < 0) unit = -unit;
    axes.push_back(To(unit));
  }
  return axes;
}

std::string AxisName(const Vec3& axis) {
  const std::array<std::pair<double, const char*>, 3> parts{
      {{axis.x, "x"}, {axis.y, "y"}, {axis.z, "z"}}};
  for (const auto& [part, name] : parts) {
    if (part == 1) return name;
  }
  return Text(axis, 1);
}

/// Describes rigid motions in text.
class Words {
 public:
  Words(const Structure& s, const Component& component, const Eigen::MatrixXd& twists)
      : s_(s), component_(component), twists_(twists) {}

  std::vector<std::string> Run() {
    const Eigen::MatrixXd turns = twists_.bottomRows(3);
    const Eigen::MatrixXd still = twists_ * Nothing(turns, kSmall);
    std::vector<std::string> moves;
    for (const Vec3& axis : AxesIn(still.topRows(3))) moves.push_back(AxisName(axis));
    if (!moves.empty()) out_.push_back("translate along " + Joined(moves));
    const analysis::Svd svd(turns, Eigen::ComputeThinU);
    const Eigen::Index count = twists_.cols() - still.cols();
    for (const Vec3& axis : AxesIn(svd.matrixU().leftCols(count))) AddTurn(turns, axis);
    for (const auto& [line, axes] : lines_) out_.push_back("rotate about " + Joined(axes) + line);
    return out_;
  }

 private:
  void AddTurn(const Eigen::MatrixXd& turns, const Vec3& axis) {
    std::string line;
    if (const Vec3* const held = HeldPointOn(axis)) {
      line = " through " + Text(*held, s_.size_m);
    } else {
      const Eigen::VectorXd share = turns.completeOrthogonalDecomposition().solve(Of(axis));
      // Translation per radian of rotation. The rotational part of a twist contains the factor
      // `size_m`.
      const Vec3 slide = s_.size_m * To(twists_.topRows(3) * share);
      const double pitch = Dot(axis, slide);
      line = " through " + Text(component_.middle_m + Cross(axis, slide), s_.size_m);
      if (std::fabs(pitch) > 1e-6 * s_.size_m) {
        line += " while it translates along the axis by " + Brief(pitch) + " m/rad";
      }
    }
    const auto known = std::find_if(lines_.begin(), lines_.end(),
                                    [&](const auto& one) { return one.first == line; });
    if (known == lines_.end()) {
      lines_.push_back({line, {AxisName(axis)}});
    } else {
      known->second.push_back(AxisName(axis));
    }
  }

  /// Returns a fixed point of the component about which it can rotate freely along `axis`; null if
  /// there is no such point.
  const Vec3* HeldPointOn(const Vec3& axis) const {
    for (const auto* points : {&component_.held_points_m, &component_.joints_m}) {
      for (const Vec3& held : *points) {
        Eigen::VectorXd twist(6);
        twist << Of((1 / s_.size_m) * Cross(held - component_.middle_m, axis)), Of(axis);
        const Eigen::VectorXd rest = twist - twists_ * (twists_.transpose() * twist);
        if (rest.norm() < kSmall * twist.norm()) return &held;
      }
    }
    return nullptr;
  }

  const Structure& s_;
  const Component& component_;
  const Eigen::MatrixXd& twists_;
  std::vector<std::pair<std::string, std::vector<std::string>>> lines_;
  std::vector<std::string> out_;
};

/// Generalized force and stiffness of the loads along rigid motions. Includes weight and loads of
/// constant direction, joint springs, and reactions of joints with the world.
struct LoadWork {
  Eigen::VectorXd force;
  Eigen::MatrixXd stiffness;
  double scale_n = 0;  ///< Sum of the loads' magnitudes.
};

/// Computes the contribution of weight and loads.
LoadWork WorkOfLoads(const Structure& s, const Component& component,
                     const Eigen::MatrixXd& twists) {
  const Eigen::Index count = twists.cols();
  const Eigen::MatrixXd turns = (1 / s.size_m) * twists.bottomRows(3);
  LoadWork work{Eigen::VectorXd::Zero(count), Eigen::MatrixXd::Zero(count, count)};
  const auto add = [&](const Vec3& place, const Vec3& force) {
    const Eigen::MatrixXd moves =
        twists.topRows(3) - CrossMatrix(place - component.middle_m) * turns;
    work.force += moves.transpose() * Of(force);
    // Second derivative of a point's position along exp(t (v, w)): w x (v + w x r).
    for (Eigen::Index i = 0; i < count; ++i) {
      for (Eigen::Index j = 0; j < count; ++j) {
        const Vec3 bends =
            Cross(To(turns.col(i)), To(moves.col(j))) + Cross(To(turns.col(j)), To(moves.col(i)));
        work.stiffness(i, j) -= 0.5 * Dot(force, bends);
      }
    }
    work.scale_n += std::sqrt(Dot(force, force));
  };
  for (const std::size_t b : component.bodies) add(s.start.center_m[b], s.weight_n[b]);
  for (const Structure::Load& load : s.loads) {
    if (component.Has(load.point.body)) add(PlaceOf(load.point, s.start), load.force_n);
  }
  return work;
}

LoadWork WorkOf(const Structure& s, const Component& component, const Eigen::MatrixXd& twists) {
  LoadWork work = WorkOfLoads(s, component, twists);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(s.motions());
  Eigen::MatrixXd springs = Eigen::MatrixXd::Zero(s.motions(), s.motions());
  for (const PlacedJoint& joint : s.joints) {
    const bool mine = component.Has(std::max(joint.a.body, joint.b.body));
    if (!mine || joint.def.stiffness == 0 || IsBar(joint.def)) continue;
    Add(SpringEnergyAt(joint, s.start), 1, 0, gradient, &springs);
  }
  const Eigen::MatrixXd motions = MotionsOf(s, component, twists);
  work.force -= motions.transpose() * gradient;
  work.stiffness += motions.transpose() * springs * motions;

  // Along a twist, the constraints of sliding and rotating joints are violated at second order.
  // Their reaction forces do work there.
  const std::vector<Coordinate> held = RowsWithWorld(s, component);
  if (held.empty()) return work;
  const Eigen::MatrixXd all = Eigen::MatrixXd::Identity(6, 6);
  const Eigen::MatrixXd slopes = SlopesAlong(held, s, component, all);
  const Eigen::MatrixXd anchors = AnchorRows(s, component);
  Eigen::MatrixXd bearing(6, slopes.rows() + anchors.rows());
  bearing << slopes.transpose(), anchors.transpose();
  const Eigen::VectorXd forces =
      bearing.completeOrthogonalDecomposition().solve(WorkOfLoads(s, component, all).force);
  for (std::size_t r = 0; r < held.size(); ++r) {
    work.stiffness +=
        forces[static_cast<Eigen::Index>(r)] * SecondAlong(held[r], s, component, twists);
  }
  return work;
}

/// Effect of the loads along free motions of a component.
enum class Effect { kNone, kPushes, kTopples };

/// Returns whether a force acts along a motion that has no positive stiffness.
bool Pushes(const Eigen::VectorXd& force, const Eigen::MatrixXd& stiffness, double least_n,
            double least_n_per_m) {
  if (force.size() == 0) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness);
  for (Eigen::Index i = 0; i < force.size(); ++i) {
    const double along_n = solver.eigenvectors().col(i).dot(force);
    if (solver.eigenvalues()[i] <= least_n_per_m && std::fabs(along_n) > least_n) return true;
  }
  return false;
}

Effect EffectOf(const LoadWork& work, const Eigen::MatrixXd& twists, double size_m, bool held) {
  const double least_n = kSmall * work.scale_n, least_n_per_m = least_n / size_m;
  if (!(least_n > 0)) return Effect::kNone;
  // Check translations first, since with a net force the rotational stiffness depends on the
  // reference point.
  const Eigen::MatrixXd still = Nothing(twists.bottomRows(3), kSmall);
  const Eigen::MatrixXd springs = still.transpose() * work.stiffness * still;
  if (Pushes(still.transpose() * work.force, springs, least_n, least_n_per_m)) {
    return Effect::kPushes;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(work.stiffness);
  if (held && solver.eigenvalues()[0] < -least_n_per_m) return Effect::kTopples;
  return Pushes(work.force, work.stiffness, least_n, least_n_per_m) ? Effect::kPushes
                                                                    : Effect::kNone;
}

}  // namespace
}  // namespace analysis

SupportCheck CheckSupports(const ModelDef& def, const LoadCaseSpec& loads) {
  using namespace analysis;  // NOLINT(google-build-using-namespace): this function alone
  // Use the described pose: a support settlement moves the structure with the support.
  LoadCaseSpec dead = loads;
  dead.settlements.clear(), dead.cables.clear(), dead.bars.clear();
  const Structure s(def, dead, true);
  SupportCheck out;
  if (s.bodies.empty()) return out;
  std::vector<Coordinate> measured;
  for (const MemberTerm& term : MembersOf(def, s, kNearPlane * s.size_m)) {
    measured.push_back(term.at);
  }
  const Eigen::MatrixXd effective = s.Effective(s.start, true);
  const std::vector<Component> components = ComponentsOf(def, s);
  for (const Component& component : components) {
    Eigen::MatrixXd twists = TwistsOf(s, component);
    const Eigen::MatrixXd changes = SlopesAlong(measured, s, component, twists);
    twists = twists * Nothing(changes, kSmall);
    const Eigen::MatrixXd motions = EffectivePart(effective, MotionsOf(s, component, twists));
    if (twists.cols() == 0) continue;
    // Drop twists that only rotate points or rods about themselves.
    const analysis::Svd svd(motions, Eigen::ComputeFullV);
    const Eigen::Index rank = analysis::RankAbove(svd.singularValues(), kSmall);
    if (rank == 0) continue;
    twists = twists * svd.matrixV().leftCols(rank);
    const std::string part =
        components.size() == 1
            ? "the structure"
            : "the part with body \"" +
                  def.bodies[static_cast<std::size_t>(s.bodies[component.bodies[0]])].name + "\"";
    const std::string moves = part + " can still " + Joined(Words(s, component, twists).Run());
    out.free += static_cast<int>(rank);
    out.free_motions.push_back(moves);
    const bool ground = !s.touches.empty();  // ground contact may support the structure
    const Effect effect =
        EffectOf(WorkOf(s, component, twists), twists, s.size_m, component.IsHeld());
    if (ground || effect == Effect::kNone || !out.missing.empty()) continue;
    const bool topples = effect == Effect::kTopples;
    out.missing = moves + ", and the loads " + (topples ? "topple it" : "act along this motion");
    out.fix = "no member resists " + std::string(rank == 1 ? "this motion" : "these motions") +
              ": add anchors or supports that hold at least " + std::to_string(rank) +
              (rank == 1 ? " direction" : " directions") + " at nodes that move";
  }
  return out;
}

}  // namespace taut
