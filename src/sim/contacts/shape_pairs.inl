/// Narrow phase of a pair of shapes in one lane: converts SIMD numbers for the scalar code of
/// shape_contacts.h.
#pragma once

#include "sim/contacts/joined_boxes.h"
#include "sim/data/rows.h"
#include "sim/geometry/swept_test.h"

namespace taut::sim {

/// Returns the pose of a body in one lane.
template <class W>
ShapePose LanePose(const View& m, const Rows<W>& s, const Scratch<W>& work, int body,
                   int lane) noexcept {
  const M3<W>& R = work.bodies[body].R;
  ShapePose pose{{R.r0.x[lane], R.r0.y[lane], R.r0.z[lane], R.r1.x[lane], R.r1.y[lane],
                  R.r1.z[lane], R.r2.x[lane], R.r2.y[lane], R.r2.z[lane]},
                 {0.0, 0.0, 0.0}};
  if (body < m.body_count) {
    pose.origin[0] = s.pos[body].x[lane];
    pose.origin[1] = s.pos[body].y[lane];
    pose.origin[2] = s.pos[body].z[lane];
  }
  return pose;
}

/// Finds the contact points of a pair with gaps below `margin`. `out` has kMaxPointsPerPair
/// entries. Returns the number of points.
template <class W>
int TouchLane(const View& m, const Rows<W>& s, const Scratch<W>& work, const ShapePairTable& pair,
              int lane, double margin, TouchPoint* out) noexcept {
  const ShapeTable &a = m.shapes[pair.a], &b = m.shapes[pair.b];
  return TouchShapes(a.shape_P, LanePose(m, s, work, a.body, lane), b.shape_P,
                     LanePose(m, s, work, b.body, lane), margin, out);
}

/// Returns a lower bound of the distance of two shapes.
template <class W>
double DistanceLane(const View& m, const Rows<W>& s, const Scratch<W>& work, int shape_a,
                    int shape_b, int lane, double enough_m = 1e300) noexcept {
  const ShapeTable &a = m.shapes[shape_a], &b = m.shapes[shape_b];
  return DistanceOfShapes(a.shape_P, LanePose(m, s, work, a.body, lane), b.shape_P,
                          LanePose(m, s, work, b.body, lane), enough_m);
}

/// TouchGroundLane, DistanceGroundLane: like TouchLane and DistanceLane, for a shape and a surface.
/// `kept`: cache of near parts, or null.
template <class W>
int TouchGroundLane(const View& m, const Rows<W>& s, const Scratch<W>& work,
                    const ShapePairTable& pair, int lane, double margin, NearParts* kept,
                    TouchPoint* out) noexcept {
  const ShapeTable& a = m.shapes[pair.a];
  if (a.shape_P.kind != ShapeKind::kRound) return TouchLane(m, s, work, pair, lane, margin, out);
  const RoundShape round = Moved(a.shape_P.round, LanePose(m, s, work, a.body, lane));
  return TouchGround(round, m.shapes[pair.b].shape_P.surface, margin, pair.elsewhere, kept, out);
}

template <class W>
double GroundDistanceLane(const View& m, const Rows<W>& s, const Scratch<W>& work,
                          const ShapePairTable& pair, int lane, double enough_m,
                          NearParts* kept) noexcept {
  const ShapeTable& a = m.shapes[pair.a];
  if (a.shape_P.kind != ShapeKind::kRound) {
    return DistanceLane(m, s, work, pair.a, pair.b, lane, enough_m);
  }
  const RoundShape round = Moved(a.shape_P.round, LanePose(m, s, work, a.body, lane));
  return DistanceToGround(round, m.shapes[pair.b].shape_P.surface, enough_m, kept);
}

/// Returns a shape of a pair with the motion of its body in the step.
template <class W>
MovingShape LaneMoving(const View& m, const Rows<W>& s, const Scratch<W>& work, int shape,
                       int lane) noexcept {
  const ShapeTable& table = m.shapes[shape];
  const int body = table.body;
  const V3<W>&v = work.bodies[body].v, &w = work.bodies[body].w;
  return {&table.shape_P,
          LanePose(m, s, work, body, lane),
          {v.x[lane], v.y[lane], v.z[lane]},
          {w.x[lane], w.y[lane], w.z[lane]},
          m.bound_m[body],
          table.shape_P.kind == ShapeKind::kSurface || table.IsJoined()};
}

/// Returns a bit mask of the features of a pair with contact forces in the previous step. `first`,
/// `count`: range of the memory of its contacts.
template <class W>
uint32_t PressingFeatures(const Rows<W>& s, uint32_t id, int first, int count, int lane) noexcept {
  uint32_t features = 0;
  for (int i = first; i < first + count; ++i) {
    const double feature = s.contact_key[i][lane] - id;
    if (!(feature >= 0 && feature < kMaxPointsPerPair)) continue;
    const V3<W>& f = s.contact_force[i];
    if (Norm1(f)[lane] > 0) features |= 1u << static_cast<int>(feature);
  }
  return features;
}

/// Removes contact points of shapes that only pass by each other (swept_test.h). Points with a
/// contact force in the previous step remain, because bodies at rest all fall equally until
/// contacts hold them. Returns the number of points.
template <class W>
int KeepTouching(const View& m, const Rows<W>& s, const Scratch<W>& work,
                 const ShapePairTable& pair, int lane, double step_s, int first, int memory,
                 NearParts* kept, TouchPoint* points, int count) noexcept {
  if (count == 0) return 0;
  MovingShape a = LaneMoving(m, s, work, pair.a, lane);
  const MovingShape b = LaneMoving(m, s, work, pair.b, lane);
  a.kept = kept;
  uint32_t closing = ClosingPoints(a, b, step_s, points, count);
  if (closing == 0) return count;
  if (m.shapes[pair.b].IsJoined()) {
    closing &= ~ArrivesBeside(a, m.shapes, pair.b, closing, points, count);
    if (closing == 0) return count;
  }
  const uint32_t pressing = PressingFeatures(s, pair.id, first, memory, lane);
  for (int i = 0; i < count; ++i) {
    if (pressing >> points[i].feature & 1u) closing &= ~(1u << i);
  }
  return closing == 0 ? count : KeepMeeting(a, b, step_s, closing, points, count);
}

}  // namespace taut::sim
