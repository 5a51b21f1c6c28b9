#include "math/described_path.h"

namespace taut::math {

double StartAngle(const CableDef& cable, std::size_t i) {
  const AttachmentDef& at = cable.attachments[i];
  const Vec3 before = cable.attachments[i - 1].position_m - at.position_m;
  const Vec3 behind = cable.attachments[i + 1].position_m - at.position_m;
  const Vec3 across = Cross(at.wheel->axis, before);
  const Vec3 level = Cross(across, at.wheel->axis);
  const double principal = Atan2(Dot(across, behind), Dot(level, behind));
  const double whole = 2 * kPi * at.wheel->turns;
  if (at.wheel->counterclockwise) return (principal < 0 ? principal + 2 * kPi : principal) + whole;
  return (principal > 0 ? principal - 2 * kPi : principal) - whole;
}

DescribedPath::DescribedPath(const CableDef& cable) {
  for (std::size_t i = 0; i < cable.attachments.size(); ++i) {
    const AttachmentDef& at = cable.attachments[i];
    points_.push_back({at.position_m, {}, {}, {}});
    attachment_.push_back(i);
    if (!at.wheel) continue;
    wheels_.push_back({at.position_m, at.wheel->axis, at.wheel->radius_m, StartAngle(cable, i),
                       count() - 1, 0, 0, 0});
    points_.push_back(points_.back());
    attachment_.push_back(i);
  }
  const int wheel_count = static_cast<int>(wheels_.size());
  LayOnWheels(points_.data(), wheel_count, wheels_.data());
  length_m_ = MeasurePath(count(), points_.data(), wheel_count, wheels_.data()).l;
}

std::vector<double> SpanLengths(const CableDef& cable) {
  DescribedPath path(cable);
  std::vector<double> lengths{0.0};
  std::size_t wheel = 0;
  for (int i = 1; i < path.count(); ++i) {
    const PathPoint<Vec3>* const p = path.points();
    const bool slips = cable.attachments[path.attachment(i)].friction > 0;
    if (wheel < path.wheels().size() && i == path.wheels()[wheel].at + 1) {
      const double arc = path.wheels()[wheel++].arc;
      lengths.back() += slips ? 0.5 * arc : arc;
      if (slips) lengths.push_back(0.5 * arc);
      continue;
    }
    lengths.back() += Dot(p[i].u, p[i].p - p[i - 1].p);
    if (slips && !cable.attachments[path.attachment(i)].wheel) lengths.push_back(0.0);
  }
  return lengths;
}

}  // namespace taut::math
