#include "analysis/structure_members.h"

#include <algorithm>
#include <cmath>

#include "analysis/svd.h"
#include "math/vec.h"

namespace taut::analysis {
namespace {

/// Divides a cable at attachments with friction and returns each part as a separate cable. Wheels
/// with friction do not divide the cable, since the division of the arc is unknown here.
std::vector<CableDef> SpansOf(const CableDef& cable) {
  std::vector<CableDef> spans;
  CableDef span = cable;
  span.attachments.clear();
  for (std::size_t i = 0; i < cable.attachments.size(); ++i) {
    const AttachmentDef& at = cable.attachments[i];
    span.attachments.push_back(at);
    const bool last = i + 1 == cable.attachments.size();
    if (!last && !(at.friction > 0 && !at.wheel)) continue;
    spans.push_back(span);
    span.attachments = {at};
  }
  return spans;
}

/// Changes the sign of the derivatives, so that positive contact forces push (open the gap).
Coordinate Opposite(Coordinate c) {
  c.gradient = -c.gradient;
  c.hessian = -c.hessian;
  return c;
}

}  // namespace

std::vector<MemberTerm> MembersOf(const ModelDef& def, const Structure& s, double near_m) {
  using Kind = StaticMember::Kind;
  const Reactions holding = ReactionsAsDescribed(s, near_m);
  std::vector<MemberTerm> out;
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    const double tension = s.Tension(s.cables[c], s.cables[c].path.At(s.start, false).value);
    int part = 0;
    for (const CableDef& span : SpansOf(def.cables[c])) {
      std::vector<Anchor> anchors;
      for (const AttachmentDef& at : span.attachments) {
        anchors.push_back(s.AnchorAt(at.body, at.position_m));
      }
      const Coordinate length = CableCoordinate(span, anchors).At(s.start, true);
      out.push_back({{Kind::kCable, static_cast<int>(c), part++, length.value, tension}, length});
    }
  }
  for (std::size_t j = 0; j < s.joints.size(); ++j) {
    if (!IsBar(s.joints[j].def)) continue;
    const Coordinate length = DistanceAt(s.joints[j], s.start);
    const double force = s.joints[j].def.stiffness * (length.value - s.joints[j].def.rest);
    out.push_back({{Kind::kBar, static_cast<int>(j), 0, length.value, force}, length});
  }
  int part = 0;
  for (std::size_t r = 0; r < s.rows.size(); ++r) {
    part = r > 0 && s.rows[r].joint == s.rows[r - 1].joint ? part + 1 : 0;
    out.push_back({{Kind::kHeld, static_cast<int>(s.rows[r].joint), part, 0,
                    holding.rows[static_cast<Eigen::Index>(r)]},
                   s.RowAt(r, s.start)});
  }
  for (std::size_t t = 0; t < s.touches.size(); ++t) {
    const Coordinate gap = s.GapAt(t, s.start);
    if (std::fabs(gap.value) > near_m) continue;
    const int body = s.bodies[static_cast<std::size_t>(s.touches[t].point.body)];
    out.push_back({{Kind::kContact, s.touches[t].plane, body, 0,
                    holding.touches[static_cast<Eigen::Index>(t)]},
                   Opposite(gap)});
  }
  return out;
}

std::vector<Anchor> PlacesOf(const ModelDef& def, const Structure& s) {
  std::vector<Anchor> places;
  const auto add = [&](const Anchor& at) {
    if (at.body < 0) return;
    const bool known = std::any_of(places.begin(), places.end(), [&](const Anchor& place) {
      const Vec3 apart = place.at_m - at.at_m;
      return place.body == at.body && Dot(apart, apart) < 1e-18 * s.size_m * s.size_m;
    });
    if (!known) places.push_back(at);
  };
  for (const CableDef& cable : def.cables) {
    for (const AttachmentDef& at : cable.attachments) add(s.AnchorAt(at.body, at.position_m));
  }
  for (const PlacedJoint& joint : s.joints) add(joint.a), add(joint.b);
  for (const Structure::Load& load : s.loads) add(load.point);
  return places;
}

Split SplitOf(const Eigen::MatrixXd& matrix) {
  constexpr double kSmall = 1e-9;
  Split out;
  const Eigen::Index rows = matrix.rows(), columns = matrix.cols();
  if (rows == 0 || columns == 0) {
    out.null = Eigen::MatrixXd::Identity(columns, columns);
    out.left = Eigen::MatrixXd::Identity(rows, rows);
    return out;
  }
  const analysis::Svd svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::VectorXd& values = svd.singularValues();
  const Eigen::Index rank = analysis::RankAbove(values, kSmall * values[0]);
  out.rank.rank = static_cast<int>(rank);
  if (rank > 0) out.rank.smallest_kept = values[rank - 1];
  if (rank < values.size()) out.rank.largest_dropped = values[rank];
  out.null = svd.matrixV().rightCols(columns - rank);
  out.left = svd.matrixU().rightCols(rows - rank);
  return out;
}

Parts PartsOf(const Eigen::MatrixXd& space, const Eigen::MatrixXd& part) {
  const Eigen::MatrixXd span = SpanOf(part);
  if (space.cols() == 0 || span.cols() == 0) return {space.leftCols(0), space};
  const analysis::Svd svd(space.transpose() * span, Eigen::ComputeFullU);
  // Singular values are cosines of the principal angles; 1 means a common direction.
  const Eigen::Index in = analysis::RankAbove(svd.singularValues(), 1 - 1e-9);
  const Eigen::MatrixXd turned = space * svd.matrixU();
  return {turned.leftCols(in), turned.rightCols(space.cols() - in)};
}

}  // namespace taut::analysis
