// States of self-stress, infinitesimal mechanisms and prestress stability of a structure
// (docs/theory/statics.md, section 2).
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "analysis/point_metric.h"
#include "analysis/quadratic_program.h"
#include "analysis/structure_members.h"
#include "analysis/whole_motions.h"
#include "math/vec.h"
#include "taut/analysis.h"

namespace taut {
namespace analysis {
namespace {

class Analysis {
 public:
  Analysis(const ModelDef& def, bool contact) : def_(def), s_(def, {}, contact) {}

  ForceAnalysis Run() {
    out_.left_out = s_.left_out;
    if (s_.bodies.empty()) return out_;
    members_ = MembersOf(def_, s_, kNearPlane * s_.size_m);
    for (const MemberTerm& term : members_) out_.members.push_back(term.member);
    effective_ = s_.Effective(s_.start, false);
    out_.unknowns = static_cast<int>(effective_.cols());
    out_.free_turns = s_.motions() - out_.unknowns;
    metric_ = PointMetric(def_, s_);

    const Eigen::MatrixXd full = FullMatrix();
    out_.matrix = PlainOf(effective_.transpose() * full);
    // Motions in `scaled` are all lengths, so the rank does not depend on the unit of length.
    const Eigen::MatrixXd scaled = s_.Effective(s_.start, true);
    const Split split = SplitOf(scaled.transpose() * full);
    out_.rank = split.rank;
    FindMotions(split, scaled);
    FindStates(split.null);
    FindStiffness();
    return out_;
  }

 private:
  static Eigen::Index Index(std::size_t i) { return static_cast<Eigen::Index>(i); }

  Eigen::MatrixXd FullMatrix() const {
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(s_.motions(), Index(members_.size()));
    for (std::size_t m = 0; m < members_.size(); ++m) {
      Eigen::VectorXd column = Eigen::VectorXd::Zero(s_.motions());
      Add(members_[m].at, 1, 0, column, nullptr);
      full.col(Index(m)) = column;
    }
    return full;
  }

  /// Computes the motions that change no member length: rigid motions and mechanisms. `split.left`
  /// contains them in the coordinates of `scaled`, which are all lengths.
  void FindMotions(const Split& split, const Eigen::MatrixXd& scaled) {
    // Rigid motions in the coordinates of `scaled`, which has orthogonal columns.
    const Eigen::MatrixXd to_scaled =
        (scaled.transpose() * scaled).diagonal().cwiseInverse().asDiagonal() * scaled.transpose();
    const Eigen::MatrixXd rigid = to_scaled * WholeMotions(def_, s_);
    const Parts parts = PartsOf(split.left, rigid);
    out_.rigid = static_cast<int>(parts.in.cols());
    rigid_ = scaled * parts.in;
    mechanisms_ = scaled * parts.across;
    for (Eigen::Index i = 0; i < mechanisms_.cols(); ++i) {
      out_.mechanisms.push_back(ShapeOf(def_, s_, mechanisms_.col(i)));
      out_.mechanisms.back().kind = Mode::Kind::kMechanism;
    }
  }

  /// Divides each force by the length of its member, if the member has a length.
  Eigen::VectorXd ByLength(const Eigen::VectorXd& forces) const {
    Eigen::VectorXd density = forces;
    for (std::size_t m = 0; m < members_.size(); ++m) {
      const double length = members_[m].member.length_m;
      if (length > 0) density[Index(m)] /= length;
    }
    return density;
  }

  /// Returns the self-stress of least norm with a force density of at least 1 N/m in every cable
  /// (eq. 7); empty if there is none.
  Eigen::VectorXd Feasible(const Eigen::MatrixXd& null) const {
    QuadraticProgram program;
    Eigen::MatrixXd densities(null.rows(), null.cols());
    for (Eigen::Index i = 0; i < null.cols(); ++i) densities.col(i) = ByLength(null.col(i));
    const Eigen::MatrixXd even = densities.transpose() * densities;
    program.hessian = even / even.diagonal().maxCoeff();
    program.gradient = Eigen::VectorXd::Zero(null.cols());
    std::vector<Eigen::Index> rows;
    for (std::size_t m = 0; m < members_.size(); ++m) {
      const StaticMember::Kind kind = members_[m].member.kind;
      if (kind == StaticMember::Kind::kCable || kind == StaticMember::Kind::kContact)
        rows.push_back(Index(m));
    }
    program.inequalities.resize(Index(rows.size()), null.cols());
    program.at_least.resize(Index(rows.size()));
    bool cables = false;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const bool cable =
          members_[static_cast<std::size_t>(rows[i])].member.kind == StaticMember::Kind::kCable;
      program.inequalities.row(Index(i)) = densities.row(rows[i]);
      program.at_least[Index(i)] = cable ? 1 : 0;
      cables = cables || cable;
    }
    if (!cables) return {};
    const QuadraticAnswer answer = Solve(program);
    if (answer.outcome != QuadraticOutcome::kSolved) return {};
    return null * answer.x;
  }

  void FindStates(const Eigen::MatrixXd& null) {
    classical_ = ClassicalOf(def_, s_, members_);
    if (classical_) out_.classical = classical_->count;
    if (null.cols() == 0) return;
    std::vector<Eigen::VectorXd> states;
    const Eigen::VectorXd feasible = Feasible(null);
    Eigen::MatrixXd rest = null;
    if (feasible.size() > 0) {
      states.push_back(feasible);
      rest = null * Nothing(feasible.transpose() * null, 1e-12 * feasible.norm());
    }
    for (Eigen::Index i = 0; i < rest.cols(); ++i) states.emplace_back(rest.col(i));
    for (const Eigen::VectorXd& state : states) AddState(state);
    if (feasible.size() > 0) {
      feasible_ = Eigen::Map<const Eigen::VectorXd>(out_.self_stress[0].force_n.data(),
                                                    Index(members_.size()));
    }
  }

  void AddState(Eigen::VectorXd state) {
    Eigen::VectorXd density = ByLength(state);
    double largest = 0, any = density.cwiseAbs().maxCoeff(), sum = 0;
    for (std::size_t m = 0; m < members_.size(); ++m) {
      if (members_[m].member.kind != StaticMember::Kind::kCable) continue;
      largest = std::max(largest, std::fabs(density[Index(m)]));
      sum += density[Index(m)];
    }
    if (largest < 1e-9 * any) largest = any;
    const double scale = (sum < 0 ? -1 : 1) / largest;
    state *= scale, density *= scale;
    SelfStress out;
    out.feasible = true;
    for (std::size_t m = 0; m < members_.size(); ++m) {
      const StaticMember& member = members_[m].member;
      const double force = state[Index(m)];
      out.force_n.push_back(force);
      out.density_n_per_m.push_back(member.length_m > 0 ? density[Index(m)] : 0);
      if (member.kind == StaticMember::Kind::kCable && !(density[Index(m)] > 1e-9))
        out.feasible = false;
      if (member.kind == StaticMember::Kind::kContact && force < -1e-9) out.feasible = false;
    }
    AddRods(state, out);
    out_.self_stress.push_back(out);
  }

  /// Adds the force densities of rods: they follow from the self-stress of the pin-jointed
  /// structure with the same forces in all other members.
  void AddRods(const Eigen::VectorXd& state, SelfStress& out) const {
    if (!classical_) return;
    const Eigen::MatrixXd& null = classical_->null;
    const Eigen::Index count = state.size();
    const Eigen::VectorXd share =
        null.topRows(count).completeOrthogonalDecomposition().solve(state);
    for (std::size_t r = 0; r < classical_->rod_length_m.size(); ++r) {
      out.rod_density_n_per_m.push_back(null.row(count + Index(r)).dot(share) /
                                        classical_->rod_length_m[r]);
    }
  }

  void FindStiffness() {
    if (feasible_.size() == 0 || mechanisms_.cols() == 0) return;
    Eigen::VectorXd unused = Eigen::VectorXd::Zero(s_.motions());
    Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(s_.motions(), s_.motions());
    for (std::size_t m = 0; m < members_.size(); ++m) {
      Add(members_[m].at, feasible_[Index(m)], 0, unused, &stiffness);
    }
    // Rigid parts of mechanisms are removed, since they do not deform the structure.
    const Eigen::VectorXd values = EigenvaluesOver(stiffness, metric_, AcrossRigid(mechanisms_));
    out_.mechanism_stiffness.assign(values.data(), values.data() + values.size());
  }

  /// Removes the rigid part of motions by orthogonal projection in the metric.
  Eigen::MatrixXd AcrossRigid(const Eigen::MatrixXd& motions) const {
    if (rigid_.cols() == 0 || motions.cols() == 0) return motions;
    const Eigen::MatrixXd weight = rigid_.transpose() * metric_ * rigid_;
    return motions - rigid_ * weight.ldlt().solve(rigid_.transpose() * metric_ * motions);
  }

  const ModelDef& def_;
  const Structure s_;
  std::vector<MemberTerm> members_;
  std::optional<Classical> classical_;
  Eigen::MatrixXd effective_, metric_, rigid_, mechanisms_;
  Eigen::VectorXd feasible_;
  ForceAnalysis out_;
};

}  // namespace
}  // namespace analysis

const char* NameOf(StaticMember::Kind kind) noexcept {
  switch (kind) {
    case StaticMember::Kind::kCable:
      return "cable";
    case StaticMember::Kind::kBar:
      return "bar";
    case StaticMember::Kind::kHeld:
      return "joint";
    case StaticMember::Kind::kContact:
      return "ground";
  }
  return "";
}

ForceAnalysis AnalyseForces(const ModelDef& def, bool contact) {
  return analysis::Analysis(def, contact).Run();
}

}  // namespace taut
