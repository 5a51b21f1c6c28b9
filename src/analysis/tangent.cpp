// Tangent stiffness and mass matrix of a structure (docs/theory/statics.md, section 3).
#include "analysis/tangent.h"

#include "analysis/structure_members.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "analysis/svd.h"
#include "math/vec.h"

namespace taut {
namespace analysis {
namespace {

Eigen::VectorXd Full(const Structure& s, const Coordinate& c) {
  Eigen::VectorXd full = Eigen::VectorXd::Zero(s.motions());
  Add(c, 1, 0, full, nullptr);
  return full;
}

Eigen::Index Index(std::size_t i) { return static_cast<Eigen::Index>(i); }

}  // namespace

Reactions ReactionsAsDescribed(const Structure& s, double near_m) {
  Eigen::VectorXd gradient;
  s.Energy(s.start, gradient, nullptr);
  const Eigen::MatrixXd basis = s.Effective(s.start, true);
  std::vector<Eigen::VectorXd> columns;
  for (std::size_t r = 0; r < s.rows.size(); ++r) {
    columns.push_back(basis.transpose() * Full(s, s.RowAt(r, s.start)));
  }
  std::vector<std::size_t> bearing;
  for (std::size_t t = 0; t < s.touches.size(); ++t) {
    if (std::fabs(s.GapAt(t, s.start).value) <= near_m) bearing.push_back(t);
  }
  Reactions out{Eigen::VectorXd::Zero(Index(s.rows.size())),
                Eigen::VectorXd::Zero(Index(s.touches.size()))};
  while (true) {
    const Eigen::Index count = Index(columns.size() + bearing.size());
    if (count == 0) return out;
    Eigen::MatrixXd all(basis.cols(), count);
    for (std::size_t i = 0; i < columns.size(); ++i) all.col(Index(i)) = columns[i];
    for (std::size_t i = 0; i < bearing.size(); ++i) {
      all.col(Index(columns.size() + i)) =
          -(basis.transpose() * Full(s, s.GapAt(bearing[i], s.start)));
    }
    const Eigen::VectorXd forces =
        all.completeOrthogonalDecomposition().solve(-(basis.transpose() * gradient));
    std::size_t worst = bearing.size();
    for (std::size_t i = 0; i < bearing.size(); ++i) {
      const double push = forces[Index(columns.size() + i)];
      if (push < 0 && (worst == bearing.size() || push < forces[Index(columns.size() + worst)])) {
        worst = i;
      }
    }
    if (worst < bearing.size()) {
      bearing.erase(bearing.begin() + static_cast<std::ptrdiff_t>(worst));
      continue;
    }
    out.rows = forces.head(Index(columns.size()));
    for (std::size_t i = 0; i < bearing.size(); ++i) {
      out.touches[Index(bearing[i])] = forces[Index(columns.size() + i)];
    }
    return out;
  }
}

HeldStiffness StiffnessAsDescribed(const Structure& s) {
  HeldStiffness out{ReactionsAsDescribed(s, kNearPlane * s.size_m), {}};
  Eigen::VectorXd gradient;
  s.Energy(s.start, gradient, &out.stiffness);
  s.AddReactions(s.start, out.holding, gradient, &out.stiffness);
  return out;
}

Eigen::MatrixXd SpanOf(const Eigen::MatrixXd& columns) {
  constexpr double kSmallShare = 1e-9;
  if (columns.cols() == 0 || columns.rows() == 0) return Eigen::MatrixXd(columns.rows(), 0);
  const analysis::Svd svd(columns, Eigen::ComputeThinU);
  const Eigen::VectorXd& values = svd.singularValues();
  return svd.matrixU().leftCols(analysis::RankAbove(values, kSmallShare * values[0]));
}

Eigen::MatrixXd HeldDirections(const Structure& s, const Reactions& holding) {
  std::vector<Eigen::VectorXd> columns;
  for (std::size_t r = 0; r < s.rows.size(); ++r) {
    columns.push_back(Full(s, s.RowAt(r, s.start)));
  }
  for (std::size_t t = 0; t < s.touches.size(); ++t) {
    if (holding.touches[Index(t)] > 0) columns.push_back(Full(s, s.GapAt(t, s.start)));
  }
  Eigen::MatrixXd all(s.motions(), Index(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) all.col(Index(i)) = columns[i];
  return SpanOf(all);
}

Eigen::MatrixXd GeometricStiffness(const Structure& s, const Reactions& holding) {
  Eigen::VectorXd unused = Eigen::VectorXd::Zero(s.motions());
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(s.motions(), s.motions());
  for (const Structure::Cable& cable : s.cables) {
    const Coordinate length = cable.path.At(s.start, true);
    Add(length, s.Tension(cable, length.value), 0, unused, &stiffness);
  }
  for (const PlacedJoint& joint : s.joints) {
    if (!IsBar(joint.def)) continue;
    const Coordinate length = DistanceAt(joint, s.start);
    Add(length, joint.def.stiffness * (length.value - joint.def.rest), 0, unused, &stiffness);
  }
  for (const Structure::Load& load : s.loads) {
    Add(PointAlong(load.point, load.force_n, 0, s.start), -1, 0, unused, &stiffness);
  }
  s.AddReactions(s.start, holding, unused, &stiffness);
  return stiffness;
}

Eigen::MatrixXd MovesOf(const Structure& s, const Anchor& point) {
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(3, s.motions());
  if (point.body < 0) return m;
  m.block<3, 3>(0, 6 * point.body) = Eigen::Matrix3d::Identity();
  m.block<3, 3>(0, 6 * point.body + 3) = -CrossMatrix(ArmOf(point, s.start));
  return m;
}

namespace {

/// Eq. 12: removes half of a bar's mass from the body at each end and adds its consistent mass
/// along the spans.
void Spread(const Structure& s, double mass_kg, const std::vector<Anchor>& points,
            Eigen::MatrixXd& mass) {
  std::vector<Eigen::MatrixXd> moves;
  std::vector<double> lengths;
  double whole = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    moves.push_back(MovesOf(s, points[i]));
    if (i == 0) continue;
    const Vec3 way = PlaceOf(points[i], s.start) - PlaceOf(points[i - 1], s.start);
    lengths.push_back(std::sqrt(Dot(way, way)));
    whole += lengths.back();
  }
  if (!(whole > 0)) return;
  for (const Eigen::MatrixXd* end : {&moves.front(), &moves.back()}) {
    mass -= 0.5 * mass_kg * end->transpose() * *end;
  }
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const double share = mass_kg * lengths[i] / whole;
    const Eigen::MatrixXd &a = moves[i], &b = moves[i + 1];
    const Eigen::MatrixXd cross = a.transpose() * b;
    mass += share / 3 * (a.transpose() * a + b.transpose() * b) +
            share / 6 * (cross + cross.transpose());
  }
}

}  // namespace

Eigen::MatrixXd MassMatrix(const ModelDef& def, const Structure& s) {
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(s.motions(), s.motions());
  for (std::size_t b = 0; b < s.bodies.size(); ++b) {
    const BodyDef& body = def.bodies[static_cast<std::size_t>(s.bodies[b])];
    const Inertia& i = body.inertia_kg_m2;
    const Eigen::Index at = 6 * Index(b);
    mass.block<3, 3>(at, at) = body.mass_kg * Eigen::Matrix3d::Identity();
    mass.block<3, 3>(at + 3, at + 3) << i.xx, i.xy, i.xz, i.xy, i.yy, i.yz, i.xz, i.yz, i.zz;
  }
  const auto spread = [](const MemberDef& m) {
    return m.mass == MemberMass::kConsistent && m.mass_kg > 0;
  };
  for (const CableDef& cable : def.cables) {
    if (!spread(cable.member)) continue;
    std::vector<Anchor> points;
    for (const AttachmentDef& at : cable.attachments) {
      points.push_back(s.AnchorAt(at.body, at.position_m));
    }
    Spread(s, cable.member.mass_kg, points, mass);
  }
  for (const PlacedJoint& joint : s.joints) {
    if (IsBar(joint.def) && spread(joint.def.member)) {
      Spread(s, joint.def.member.mass_kg, {joint.a, joint.b}, mass);
    }
  }
  return mass;
}

Matrix PlainOf(const Eigen::MatrixXd& m) {
  Matrix out(static_cast<int>(m.rows()), static_cast<int>(m.cols()));
  for (int r = 0; r < out.rows; ++r) {
    for (int c = 0; c < out.columns; ++c) out(r, c) = m(r, c);
  }
  return out;
}

Eigen::MatrixXd EigenOf(const Matrix& m) {
  Eigen::MatrixXd out(m.rows, m.columns);
  for (int r = 0; r < m.rows; ++r) {
    for (int c = 0; c < m.columns; ++c) out(r, c) = m(r, c);
  }
  return out;
}

}  // namespace analysis

Tangent FindTangent(const ModelDef& def, const LoadCaseSpec& loads) {
  using namespace analysis;  // NOLINT(google-build-using-namespace): this function alone
  const Structure s(def, loads, true);
  const auto [holding, stiffness] = StiffnessAsDescribed(s);
  Tangent out;
  out.bodies = s.bodies;
  out.left_out = s.left_out;
  const Eigen::MatrixXd effective = s.Effective(s.start, false);
  out.stiffness = PlainOf(stiffness);
  out.geometric = PlainOf(GeometricStiffness(s, holding));
  out.mass = PlainOf(MassMatrix(def, s));
  out.held = PlainOf(HeldDirections(s, holding).transpose());
  out.effective = PlainOf(effective);
  out.free_turns = s.motions() - static_cast<int>(effective.cols());
  for (std::size_t c = 0; c < s.cables.size(); ++c) {
    const Structure::Cable& cable = s.cables[c];
    if (s.Tension(cable, cable.path.At(s.start, false).value) == 0) {
      out.slack_cables.push_back(static_cast<int>(c));
    }
  }
  return out;
}

}  // namespace taut
