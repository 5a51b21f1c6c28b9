// Form finding of nets by the force density method (docs/theory/inverse_statics.md, section 5).
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "analysis/svd.h"
#include "taut/form_finding.h"

namespace taut {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

bool IsFixed(const FormNet& net, std::size_t node) { return !net.fixed.empty() && net.fixed[node]; }

bool Check(const FormNet& net, Diagnostics& out) {
  const std::size_t before = out.items().size();
  const int nodes = static_cast<int>(net.nodes_m.size());
  if (!net.fixed.empty() && net.fixed.size() != net.nodes_m.size()) {
    out.Error("net.supports_unknown", {},
              "the net has " + std::to_string(net.fixed.size()) + " flags of fixed nodes for " +
                  std::to_string(nodes) + " nodes");
  }
  for (std::size_t m = 0; m < net.members.size(); ++m) {
    const auto& [a, b] = net.members[m];
    if (a < 0 || b < 0 || a >= nodes || b >= nodes || a == b) {
      out.Error("net.member_outside", {},
                "member " + std::to_string(m) + " does not connect two nodes of the net");
    }
  }
  return out.items().size() == before;
}

/// Returns the force density matrix: sum over the members of q (e_a - e_b) (e_a - e_b)'.
MatrixXd DensityMatrix(const FormNet& net, const std::vector<double>& q) {
  const Index n = static_cast<Index>(net.nodes_m.size());
  MatrixXd d = MatrixXd::Zero(n, n);
  for (std::size_t m = 0; m < net.members.size(); ++m) {
    const auto& [a, b] = net.members[m];
    d(a, a) += q[m], d(b, b) += q[m];
    d(a, b) -= q[m], d(b, a) -= q[m];
  }
  return d;
}

MatrixXd Places(const FormNet& net) {
  MatrixXd x(static_cast<Index>(net.nodes_m.size()), 3);
  for (std::size_t i = 0; i < net.nodes_m.size(); ++i) {
    x.row(static_cast<Index>(i)) << net.nodes_m[i].x, net.nodes_m[i].y, net.nodes_m[i].z;
  }
  return x;
}

std::vector<Vec3> ToPlaces(const MatrixXd& x) {
  std::vector<Vec3> places;
  for (Index i = 0; i < x.rows(); ++i) places.push_back({x(i, 0), x(i, 1), x(i, 2)});
  return places;
}

/// Form finding without fixed nodes. Minimizes |D(a) X| alternately over the force densities a of
/// the groups (|a| = 1) and over the coordinates X (orthonormal and orthogonal to (1, ..., 1)).
class FreeSearch {
 public:
  FreeSearch(const FormNet& net, const std::vector<int>& group, int groups)
      : net_(net), group_(group), groups_(groups) {}

  FreeForm Run() {
    FreeForm form;
    const Index n = static_cast<Index>(net_.nodes_m.size());
    MatrixXd start = Places(net_);
    const Eigen::RowVector3d middle = start.colwise().mean();
    start.rowwise() -= middle;
    // Basis of the orthogonal complement of (1, ..., 1).
    const MatrixXd across =
        MatrixXd(Eigen::HouseholderQR<MatrixXd>(MatrixXd::Ones(n, 1)).householderQ())
            .rightCols(n - 1);
    const Eigen::ColPivHouseholderQR<MatrixXd> spanned(start);
    if (n < 5 || spanned.rank() < 3) {
      form.why = "the net needs at least five nodes, not all in one plane";
      return form;
    }
    MatrixXd x = MatrixXd(spanned.householderQ()).leftCols(3);
    VectorXd a;
    double left = 0, before = 0;
    for (int round = 0; round < kMostRounds; ++round) {
      a = Densities(x);
      const Eigen::SelfAdjointEigenSolver<MatrixXd> modes(across.transpose() * Matrix(a) * across);
      const std::vector<Index> least = LeastThree(modes.eigenvalues());
      for (int c = 0; c < 3; ++c) {
        x.col(c) = across * modes.eigenvectors().col(least[static_cast<std::size_t>(c)]);
      }
      before = left;
      left = std::fabs(modes.eigenvalues()[least[2]]);
      if (left < kBalanced || (round > 50 && left > 0.999999 * before)) break;
    }
    return Report(a, left, start, middle);
  }

 private:
  static constexpr int kMostRounds = 20000;
  static constexpr double kBalanced = 1e-13, kZero = 1e-9;

  MatrixXd Matrix(const VectorXd& a) const {
    std::vector<double> q;
    for (const int g : group_) q.push_back(a[g]);
    return DensityMatrix(net_, q);
  }

  /// Returns the force densities with the least imbalance for nodes at x. Member m contributes the
  /// force a (x_a - x_b).
  VectorXd Densities(const MatrixXd& x) const {
    const Index n = x.rows();
    MatrixXd forces = MatrixXd::Zero(3 * n, groups_);
    for (std::size_t m = 0; m < net_.members.size(); ++m) {
      const auto& [i, j] = net_.members[m];
      for (int c = 0; c < 3; ++c) {
        const double apart = x(i, c) - x(j, c);
        forces(c * n + i, group_[m]) += apart;
        forces(c * n + j, group_[m]) -= apart;
      }
    }
    const analysis::Svd svd(forces, Eigen::ComputeThinV);
    return svd.matrixV().col(groups_ - 1);
  }

  static std::vector<Index> LeastThree(const VectorXd& values) {
    std::vector<Index> order;
    for (Index i = 0; i < values.size(); ++i) order.push_back(i);
    std::stable_sort(order.begin(), order.end(),
                     [&](Index i, Index j) { return std::fabs(values[i]) < std::fabs(values[j]); });
    order.resize(3);
    return order;
  }

  FreeForm Report(VectorXd a, double left, const MatrixXd& start,
                  const Eigen::RowVector3d& middle) const {
    FreeForm form;
    if (std::fabs(a[0]) < kZero) {
      form.why = "the members of the first group carry no force";
      return form;
    }
    a /= Matrix(a).trace() < 0 ? -std::fabs(a[0]) : std::fabs(a[0]);  // sign: tensions are positive
    const Eigen::SelfAdjointEigenSolver<MatrixXd> modes(Matrix(a));
    const VectorXd& values = modes.eigenvalues();
    const double largest = values.cwiseAbs().maxCoeff();
    MatrixXd x = MatrixXd::Zero(start.rows(), 3);
    int zero = 0;
    for (Index i = 0; i < values.size(); ++i) {
      if (std::fabs(values[i]) > kZero * largest) continue;
      const VectorXd v = modes.eigenvectors().col(i);
      x += v * (v.transpose() * start);
      ++zero;
    }
    form.group_force_density_n_per_m.assign(a.data(), a.data() + a.size());
    if (zero < 4) {
      form.why =
          "no force densities of the groups are in equilibrium near this form: the relative "
          "residual is " +
          std::to_string(left);
      return form;
    }
    double most = 0;
    for (std::size_t m = 0; m < net_.members.size(); ++m) {
      const auto& [i, j] = net_.members[m];
      most = std::max(most, std::fabs(a[group_[m]]) * (x.row(i) - x.row(j)).norm());
    }
    form.residual = (Matrix(a) * x).rowwise().norm().maxCoeff() / most;
    form.super_stable = zero == 4 && values.minCoeff() > -kZero * largest;
    form.found = true;
    form.nodes_m = ToPlaces(x.rowwise() + middle);
    return form;
  }

  const FormNet& net_;
  const std::vector<int>& group_;
  int groups_;
};

}  // namespace

std::optional<std::vector<Vec3>> FindNetForm(const FormNet& net,
                                             const std::vector<double>& force_density_n_per_m,
                                             const std::vector<Vec3>& loads_n, Diagnostics& out) {
  if (!Check(net, out)) return std::nullopt;
  const std::size_t before = out.items().size();
  if (force_density_n_per_m.size() != net.members.size()) {
    out.Error("net.wrong_number_of_densities", {},
              "there are " + std::to_string(force_density_n_per_m.size()) +
                  " force densities for " + std::to_string(net.members.size()) + " members");
  }
  if (!loads_n.empty() && loads_n.size() != net.nodes_m.size()) {
    out.Error("net.wrong_number_of_loads", {},
              "there are " + std::to_string(loads_n.size()) + " loads for " +
                  std::to_string(net.nodes_m.size()) + " nodes");
  }
  std::vector<Index> free, fixed;
  for (std::size_t i = 0; i < net.nodes_m.size(); ++i) {
    (IsFixed(net, i) ? fixed : free).push_back(static_cast<Index>(i));
  }
  if (fixed.empty()) out.Error("net.no_fixed_node", {}, "no node of the net is fixed");
  if (out.items().size() > before) return std::nullopt;
  if (free.empty()) return net.nodes_m;

  const MatrixXd d = DensityMatrix(net, force_density_n_per_m);
  MatrixXd x = Places(net);
  MatrixXd right = MatrixXd::Zero(x.rows(), 3);
  for (std::size_t i = 0; i < loads_n.size(); ++i) {
    right.row(static_cast<Index>(i)) << loads_n[i].x, loads_n[i].y, loads_n[i].z;
  }
  const MatrixXd known = right(free, Eigen::all) - d(free, fixed) * x(fixed, Eigen::all);
  const Eigen::FullPivLU<MatrixXd> factors(MatrixXd(d(free, free)));
  if (!factors.isInvertible()) {
    out.Error("net.not_held", {}, "the force densities do not determine the position of every node",
              "connect every node to a fixed one; tensions and compressions must not cancel");
    return std::nullopt;
  }
  x(free, Eigen::all) = factors.solve(known);
  return ToPlaces(x);
}

FreeForm FindFreeForm(const FormNet& net, const std::vector<int>& group, Diagnostics& out) {
  FreeForm none;
  none.why = "the net is invalid";
  if (!Check(net, out)) return none;
  const std::size_t before = out.items().size();
  if (group.size() != net.members.size()) {
    out.Error("net.wrong_number_of_groups", {},
              "`group` has " + std::to_string(group.size()) + " entries for " +
                  std::to_string(net.members.size()) + " members",
              "give the group of each member");
  }
  if (std::find(net.fixed.begin(), net.fixed.end(), true) != net.fixed.end()) {
    out.Error("net.has_fixed_nodes", {}, "FindFreeForm does not support nets with fixed nodes",
              "call FindNetForm");
  }
  int groups = 0;
  for (const int g : group) groups = std::max(groups, g + 1);
  std::vector<bool> has(static_cast<std::size_t>(groups), false);
  for (const int g : group) {
    if (g >= 0) has[static_cast<std::size_t>(g)] = true;
  }
  const bool negative = std::any_of(group.begin(), group.end(), [](int g) { return g < 0; });
  if (negative || groups == 0 || std::find(has.begin(), has.end(), false) != has.end()) {
    out.Error("net.bad_groups", {},
              "groups must be numbered from 0, each with at least one member");
  }
  if (out.items().size() > before) return none;
  return FreeSearch(net, group, groups).Run();
}

}  // namespace taut
