#include "analysis/force_balance.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "base/brief.h"
#include "math/vec.h"

namespace taut::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Kind = HoldingUnknown::Kind;

/// Returns the model without unknown forces: cables with unknown tension get no tension, bars with
/// unknown force become distance joints.
ModelDef Freed(const ModelDef& def, bool known_tensions) {
  ModelDef freed = def;
  if (known_tensions) return freed;
  for (CableDef& cable : freed.cables) cable.rest_length_m = 2 * CableLength(cable) + 1;
  for (JointDef& joint : freed.joints) {
    if (IsBar(joint)) joint.stiffness = 0, joint.least = joint.most = std::nullopt;
  }
  return freed;
}

}  // namespace

Across AcrossOf(const Vec3& normal) {
  const Vec3 other = std::fabs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 s = other - Dot(other, normal) * normal;
  const Vec3 unit = (1 / Length(s)) * s;
  return {unit, Cross(normal, unit)};
}

ForceBalance::ForceBalance(const ModelDef& def, const LoadCaseSpec& loads,
                           const std::vector<TouchDef>& touches, bool known_tensions)
    : def_(def),
      freed_(Freed(def, known_tensions)),
      touches_(touches),
      structure_(
          freed_,
          [&] {
            LoadCaseSpec forces = loads;
            if (!known_tensions) forces.cables.clear(), forces.bars.clear();
            return forces;
          }(),
          false) {
  const Placement& at = structure_.start;
  reach_m_ = structure_.reach_m;
  for (const TouchDef& touch : touches) {
    for (const int body : {touch.body, touch.other}) {
      const int b = structure_.Moving(body);
      if (b < 0) continue;
      double& own = reach_m_[static_cast<std::size_t>(b)];
      own = std::max(own, Length(touch.point_m - at.center_m[static_cast<std::size_t>(b)]));
    }
  }
  VectorXd row_scale = VectorXd::Ones(structure_.motions());
  for (std::size_t b = 0; b < reach_m_.size(); ++b) {
    if (!(reach_m_[b] > 1e-8 * structure_.size_m)) reach_m_[b] = structure_.size_m;
    row_scale.segment<3>(6 * static_cast<Index>(b) + 3).setConstant(1 / reach_m_[b]);
  }
  std::vector<VectorXd> found;
  const auto add = [&](const HoldingUnknown& unknown, const VectorXd& gradient, bool unit) {
    VectorXd column = row_scale.cwiseProduct(gradient);
    unknowns.push_back(unknown);
    const double length = column.norm();
    if (unit && length > 0) unknowns.back().scale = 1 / length, column /= length;
    found.push_back(column);
  };
  for (std::size_t i = 0; i < structure_.cables.size(); ++i) {
    const Coordinate length = structure_.cables[i].path.At(at, false);
    cable_length_m.push_back(length.value);
    known_cable_n.push_back(structure_.Tension(structure_.cables[i], length.value));
    if (known_tensions) continue;
    VectorXd gradient = VectorXd::Zero(structure_.motions());
    analysis::Add(length, 1, 0, gradient, nullptr);
    add({Kind::kCable, i}, gradient, false);
  }
  for (std::size_t r = 0; r < structure_.rows.size(); ++r) {
    VectorXd gradient = VectorXd::Zero(structure_.motions());
    analysis::Add(structure_.RowAt(r, at), 1, 0, gradient, nullptr);
    add({Kind::kRow, r}, gradient, true);
  }
  for (std::size_t t = 0; t < touches.size(); ++t) {
    const TouchDef& touch = touches[t];
    const Across across = AcrossOf(touch.normal);
    const Vec3 directions[] = {touch.normal, across.s, across.t};
    touch_columns_.push_back(static_cast<Index>(found.size()));
    for (int part = 0; part < (touch.friction > 0 ? 3 : 1); ++part) {
      VectorXd gradient = VectorXd::Zero(structure_.motions());
      for (const int body : {touch.body, touch.other}) {
        const Anchor point = structure_.AnchorAt(body, touch.point_m);
        analysis::Add(PointAlong(point, directions[part], 0, at), body == touch.body ? -1 : 1, 0,
                      gradient, nullptr);
      }
      add({Kind::kTouch, t, part}, gradient, false);
    }
  }
  columns.resize(structure_.motions(), static_cast<Index>(found.size()));
  for (std::size_t i = 0; i < found.size(); ++i) columns.col(static_cast<Index>(i)) = found[i];
  structure_.Energy(at, load, nullptr);
  load = -row_scale.cwiseProduct(load);

  known_bar_n_.assign(def.joints.size(), 0.0);
  for (std::size_t j = 0; j < def.joints.size(); ++j) {
    const JointDef& joint = structure_.joints[j].def;
    if (!IsBar(joint)) continue;
    known_bar_n_[j] = joint.stiffness * (DistanceAt(structure_.joints[j], at).value - joint.rest);
  }
}

Vec3 ForceBalance::TouchForce(std::size_t touch, const VectorXd& x) const {
  const Vec3& normal = touches_[touch].normal;
  const Index first = TouchColumn(touch);
  Vec3 force = x[first] * normal;
  if (touches_[touch].friction > 0) {
    const Across across = AcrossOf(normal);
    force = force + x[first + 1] * across.s + x[first + 2] * across.t;
  }
  return force;
}

std::vector<JointLoad> ForceBalance::JointLoads(const VectorXd& x) const {
  const Placement& at = structure_.start;
  std::vector<JointLoad> loads(def_.joints.size());
  const auto add = [&](std::size_t joint, const Coordinate& c, double force) {
    const Wrench w = LoadOf(structure_.joints[joint], c, force, at);
    loads[joint] = {loads[joint].force_n + w.force, loads[joint].torque_n_m + w.torque};
  };
  for (std::size_t j = 0; j < loads.size(); ++j) {
    const PlacedJoint& joint = structure_.joints[j];
    if (joint.def.stiffness > 0) add(j, SpringEnergyAt(joint, at), -1);
  }
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    if (unknowns[i].kind != Kind::kRow) continue;
    const std::size_t row = unknowns[i].index;
    add(structure_.rows[row].joint, structure_.RowAt(row, at),
        -unknowns[i].scale * x[static_cast<Index>(i)]);
  }
  return loads;
}

std::vector<double> ForceBalance::BarForces(const VectorXd& x) const {
  std::vector<double> forces = known_bar_n_;
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    if (unknowns[i].kind != Kind::kRow) continue;
    const std::size_t joint = structure_.rows[unknowns[i].index].joint;
    if (IsBar(def_.joints[joint])) forces[joint] = unknowns[i].scale * x[static_cast<Index>(i)];
  }
  return forces;
}

std::vector<Unbalanced> ForceBalance::Left(const VectorXd& x) const {
  const VectorXd left = load - columns * x;
  std::vector<std::pair<double, Unbalanced>> found;
  for (std::size_t b = 0; b < structure_.bodies.size(); ++b) {
    const Index row = 6 * static_cast<Index>(b);
    const Vec3 force = To(left.segment<3>(row));
    const Vec3 torque = reach_m_[b] * To(left.segment<3>(row + 3));
    found.push_back({left.segment<6>(row).norm(), {structure_.bodies[b], force, torque}});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Unbalanced> out;
  for (const auto& [size, unbalanced] : found) {
    if (size > 1e-6 * LargestLoad()) out.push_back(unbalanced);
  }
  return out;
}

std::string ForceBalance::Words(const std::vector<Unbalanced>& left) const {
  std::string text;
  for (std::size_t i = 0; i < left.size() && i < 3; ++i) {
    text += (i > 0 ? ", " : "") + def_.bodies[static_cast<std::size_t>(left[i].body)].name +
            " by " + base::Brief(Length(left[i].force_n)) + " N and " +
            base::Brief(Length(left[i].torque_n_m)) + " N m";
  }
  if (left.size() > 3) text += " and " + std::to_string(left.size() - 3) + " more";
  return text;
}

double ForceBalance::LargestLoad() const {
  const double largest = load.size() > 0 ? load.lpNorm<Eigen::Infinity>() : 0.0;
  return largest > 0 ? largest : 1.0;
}

ForceBalance::Solutions ForceBalance::Solve() const {
  constexpr double kRank = 1e-9;
  Solutions all;
  const Index n = columns.cols();
  all.particular = VectorXd::Zero(n);
  all.free = MatrixXd::Identity(n, n);
  if (n > 0 && columns.rows() > 0) {
    // This decomposition replaces two SVDs of Eigen: divide and conquer frees memory twice if an
    // allocation fails; Jacobi needs seconds for hundreds of unknowns.
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> factors;
    factors.setThreshold(kRank);
    factors.compute(columns);
    const Index rank = factors.rank();
    // Assign new matrices: Eigen frees memory twice if resizing a filled matrix fails.
    all.particular = VectorXd(factors.solve(load));
    // The rows of Z below the rank span the null space of columns * P.
    const MatrixXd rows = factors.matrixZ().transpose().rightCols(n - rank);
    all.free = MatrixXd(factors.colsPermutation() * rows);
  }
  const VectorXd left = load - columns * all.particular;
  all.left_n = left.size() > 0 ? left.lpNorm<Eigen::Infinity>() : 0.0;
  return all;
}

}  // namespace taut::analysis
