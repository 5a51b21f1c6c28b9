/// A pair of shapes in one lane: from wide numbers to the scalar code of shape_contacts.h.

namespace taut::sim {

/// Where the body of a shape is in one lane.
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

/// The points of a pair whose gap is below `margin`: how many `out` (kMaxPointsPerPair entries)
/// holds afterwards.
template <class W>
int TouchLane(const View& m, const Rows<W>& s, const Scratch<W>& work, const ShapePairTable& pair,
              int lane, double margin, TouchPoint* out) noexcept {
  const ShapeTable &a = m.shapes[pair.a], &b = m.shapes[pair.b];
  return TouchShapes(a.shape_P, LanePose(m, s, work, a.body, lane), b.shape_P,
                     LanePose(m, s, work, b.body, lane), margin, out);
}

/// A lower bound of the distance of a pair.
template <class W>
double DistanceLane(const View& m, const Rows<W>& s, const Scratch<W>& work,
                    const ShapePairTable& pair, int lane) noexcept {
  const ShapeTable &a = m.shapes[pair.a], &b = m.shapes[pair.b];
  return DistanceOfShapes(a.shape_P, LanePose(m, s, work, a.body, lane), b.shape_P,
                          LanePose(m, s, work, b.body, lane));
}

}  // namespace taut::sim
