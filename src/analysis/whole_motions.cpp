#include "analysis/whole_motions.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "analysis/svd.h"
#include "analysis/tangent.h"
#include "base/union_find.h"
#include "math/vec.h"

namespace taut::analysis {
namespace {

/// Returns the first moving body of a cable, or -1.
int MovingOf(const Structure& s, const CableDef& cable) {
  for (const AttachmentDef& at : cable.attachments) {
    if (s.Moving(at.body) >= 0) return s.Moving(at.body);
  }
  return -1;
}

/// Returns the part of `twists` that joints with the world permit beyond first order. If constraint
/// rows are dependent, a self-stress among them (`loads`) may resist at second order. Example: two
/// parallel guides resist the rotation of a rod between them.
Eigen::MatrixXd AllowedByJoints(const Structure& s, const Component& component,
                                const Eigen::MatrixXd& twists) {
  constexpr double kFirst = 1e-9, kSecond = 1e-6;
  const std::vector<Coordinate> held = RowsWithWorld(s, component);
  if (held.empty()) return twists;
  const Eigen::MatrixXd rows = SlopesAlong(held, s, component, Eigen::MatrixXd::Identity(6, 6));
  Eigen::MatrixXd first = twists * Nothing(rows * twists, kFirst);
  const Eigen::MatrixXd loads = Nothing(rows.transpose(), kFirst);
  if (first.cols() == 0 || loads.cols() == 0) return first;
  std::vector<Eigen::MatrixXd> second;
  for (const Coordinate& row : held) second.push_back(SecondAlong(row, s, component, first));
  Eigen::MatrixXd resisted = Eigen::MatrixXd::Zero(loads.cols() * first.cols(), first.cols());
  for (Eigen::Index state = 0; state < loads.cols(); ++state) {
    auto block = resisted.middleRows(state * first.cols(), first.cols());
    for (std::size_t r = 0; r < held.size(); ++r) {
      block += s.size_m * loads(static_cast<Eigen::Index>(r), state) * second[r];
    }
  }
  return first * Nothing(resisted, kSecond);
}

}  // namespace

bool Component::Has(int moving) const {
  return moving >= 0 &&
         std::find(bodies.begin(), bodies.end(), static_cast<std::size_t>(moving)) != bodies.end();
}

std::vector<Component> ComponentsOf(const ModelDef& def, const Structure& s) {
  base::UnionFind groups(s.bodies.size());
  const auto join = [&](int a, int b) {
    if (a >= 0 && b >= 0) groups.Join(a, b);
  };
  for (const CableDef& cable : def.cables) {
    for (const AttachmentDef& at : cable.attachments) {
      join(MovingOf(s, cable), s.Moving(at.body));
    }
  }
  for (const PlacedJoint& joint : s.joints) join(joint.a.body, joint.b.body);
  std::vector<Component> out;
  std::vector<std::size_t> number(s.bodies.size());
  for (std::size_t b = 0; b < s.bodies.size(); ++b) {
    const auto root = static_cast<std::size_t>(groups.Root(static_cast<int>(b)));
    if (root == b) number[b] = out.size(), out.emplace_back();
    out[number[root]].bodies.push_back(b);
  }
  for (Component& component : out) {
    for (const std::size_t b : component.bodies) {
      component.middle_m =
          component.middle_m +
          (1.0 / static_cast<double>(component.bodies.size())) * s.start.center_m[b];
    }
  }
  const auto of = [&](int moving) -> Component& {
    return out[number[static_cast<std::size_t>(groups.Root(moving))]];
  };
  for (const CableDef& cable : def.cables) {
    const int moving = MovingOf(s, cable);
    if (moving < 0) continue;
    for (const AttachmentDef& at : cable.attachments) {
      if (s.Moving(at.body) >= 0) continue;
      of(moving).held_points_m.push_back(at.position_m);
      if (at.wheel) of(moving).held_axes.push_back(at.wheel->axis);
    }
  }
  for (const PlacedJoint& joint : s.joints) {
    if ((joint.a.body < 0) == (joint.b.body < 0)) continue;
    const Anchor& in_world = joint.a.body < 0 ? joint.a : joint.b;
    Component& component = of(std::max(joint.a.body, joint.b.body));
    const bool distance = joint.def.kind == JointKind::kDistance;
    (distance ? component.held_points_m : component.joints_m).push_back(in_world.at_m);
  }
  return out;
}

Eigen::MatrixXd AnchorRows(const Structure& s, const Component& component) {
  const std::vector<Vec3>&points = component.held_points_m, &axes = component.held_axes;
  Eigen::MatrixXd rows =
      Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(points.size() + axes.size()), 6);
  Eigen::Index row = 0;
  for (const Vec3& point : points) {
    rows.block<3, 3>(row, 0) = Eigen::Matrix3d::Identity();
    rows.block<3, 3>(row, 3) = -CrossMatrix((1 / s.size_m) * (point - component.middle_m));
    row += 3;
  }
  for (const Vec3& axis : axes) {
    rows.block<3, 3>(row, 3) = CrossMatrix(axis);
    row += 3;
  }
  return rows;
}

std::vector<Coordinate> RowsWithWorld(const Structure& s, const Component& component) {
  std::vector<Coordinate> rows;
  for (std::size_t r = 0; r < s.rows.size(); ++r) {
    const PlacedJoint& joint = s.joints[s.rows[r].joint];
    const int moving = std::max(joint.a.body, joint.b.body);
    const bool with_world = (joint.a.body < 0) != (joint.b.body < 0);
    if (with_world && component.Has(moving)) rows.push_back(s.RowAt(r, s.start));
  }
  return rows;
}

Eigen::MatrixXd SlopesAlong(const std::vector<Coordinate>& coordinates, const Structure& s,
                            const Component& component, const Eigen::MatrixXd& twists) {
  const Eigen::MatrixXd motions = MotionsOf(s, component, twists);
  Eigen::MatrixXd slopes(static_cast<Eigen::Index>(coordinates.size()), twists.cols());
  for (std::size_t c = 0; c < coordinates.size(); ++c) {
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(s.motions());
    Add(coordinates[c], 1, 0, slope, nullptr);
    slopes.row(static_cast<Eigen::Index>(c)) = slope.transpose() * motions;
  }
  return slopes;
}

Eigen::MatrixXd SecondAlong(const Coordinate& c, const Structure& s, const Component& component,
                            const Eigen::MatrixXd& twists) {
  const Eigen::MatrixXd motions = MotionsOf(s, component, twists);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(s.motions());
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(s.motions(), s.motions());
  Add(c, 1, 0, gradient, &hessian);
  Eigen::MatrixXd second = motions.transpose() * hessian * motions;
  // Along exp(t w), the center of mass deviates from a straight line by w x (v + w x r) / 2.
  for (const std::size_t b : component.bodies) {
    const Eigen::Index at = 6 * static_cast<Eigen::Index>(b);
    const Vec3 slope = To(gradient.segment<3>(at));
    const auto move = [&](Eigen::Index i) { return To(motions.block<3, 1>(at, i)); };
    const auto turn = [&](Eigen::Index i) { return To(motions.block<3, 1>(at + 3, i)); };
    for (Eigen::Index i = 0; i < twists.cols(); ++i) {
      for (Eigen::Index j = 0; j < twists.cols(); ++j) {
        second(i, j) += 0.5 * Dot(slope, Cross(turn(i), move(j)) + Cross(turn(j), move(i)));
      }
    }
  }
  return second;
}

Eigen::MatrixXd TwistsOf(const Structure& s, const Component& component) {
  return AllowedByJoints(s, component, Nothing(AnchorRows(s, component), 1e-9));
}

Eigen::MatrixXd MotionsOf(const Structure& s, const Component& component,
                          const Eigen::MatrixXd& twists) {
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(s.motions(), twists.cols());
  const Eigen::MatrixXd turns = (1 / s.size_m) * twists.bottomRows(3);
  for (const std::size_t b : component.bodies) {
    const Eigen::Index at = 6 * static_cast<Eigen::Index>(b);
    motions.middleRows(at, 3) =
        twists.topRows(3) - CrossMatrix(s.start.center_m[b] - component.middle_m) * turns;
    motions.middleRows(at + 3, 3) = turns;
  }
  return motions;
}

Eigen::MatrixXd WholeMotions(const ModelDef& def, const Structure& s) {
  Eigen::MatrixXd all(s.motions(), 0);
  for (const Component& component : ComponentsOf(def, s)) {
    const Eigen::MatrixXd own = MotionsOf(s, component, TwistsOf(s, component));
    all.conservativeResize(Eigen::NoChange, all.cols() + own.cols());
    all.rightCols(own.cols()) = own;
  }
  return all;
}

Eigen::MatrixXd EffectivePart(const Eigen::MatrixXd& effective, const Eigen::MatrixXd& motions) {
  return effective *
         (effective.transpose() * effective).ldlt().solve(effective.transpose() * motions);
}

Eigen::MatrixXd Nothing(const Eigen::MatrixXd& rows, double limit) {
  if (rows.rows() == 0) return Eigen::MatrixXd::Identity(rows.cols(), rows.cols());
  if (rows.cols() == 0) return Eigen::MatrixXd(0, 0);
  const analysis::Svd svd(rows, Eigen::ComputeFullV);
  const Eigen::Index rank = analysis::RankAbove(svd.singularValues(), limit);
  return svd.matrixV().rightCols(rows.cols() - rank);
}

FreeMotions FreeMotionsOf(const ModelDef& def, const Structure& s, const Eigen::MatrixXd& stiffness,
                          const Eigen::MatrixXd& weight, const Eigen::MatrixXd& held) {
  const Eigen::MatrixXd effective = s.Effective(s.start, true);
  const Eigen::MatrixXd unheld =
      effective * Nothing(held.transpose() * effective, 1e-9 / std::max(1.0, s.size_m));
  FreeMotions out{unheld, 0};
  if (unheld.cols() == 0) return out;
  // Drop rotations that nothing resists from the rigid motions, too: a single point or collinear
  // points allow such rotations.
  const Eigen::MatrixXd rigid = SpanOf(EffectivePart(effective, WholeMotions(def, s)));
  if (rigid.cols() == 0) return out;
  const double most = (unheld.transpose() * stiffness * unheld).cwiseAbs().maxCoeff();
  // Without stiffness, `most` is the rounding error of the reactions.
  const bool resists = most > 1e-12 * stiffness.cwiseAbs().maxCoeff();
  // Exclude motions that the joints do not permit: `rigid` lacks the spins of rods. A spin would
  // show a stiffness against such motions, because the rows of a joint rotate with a body.
  Eigen::MatrixXd resisted(held.cols() + s.motions(), rigid.cols());
  resisted << held.transpose() * rigid,
      (resists ? 1 / most : 0.0) * (unheld * (unheld.transpose() * stiffness * rigid));
  const Eigen::MatrixXd whole = rigid * Nothing(resisted, 1e-11);
  out.rigid = whole.cols();
  if (out.rigid == 0) return out;
  // Orthogonal complement in `weight`: motions of `unheld` without momentum along `whole`.
  const Eigen::MatrixXd momenta = whole.transpose() * weight * unheld;
  const Eigen::MatrixXd rest = unheld * Nothing(momenta, 1e-12 * momenta.norm());
  out.basis.resize(s.motions(), whole.cols() + rest.cols());
  out.basis << whole, rest;
  return out;
}

}  // namespace taut::analysis
