// Rotation vectors of quaternions, and set points of experiments, for system identification.
#include <algorithm>
#include <cmath>

#include "identify/computed.h"

namespace taut::identify {

Vec3 TurnOf(const Quat& q) {
  const double sign = q.w < 0 ? -1.0 : 1.0;
  const double s = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
  const double angle_rad = 2.0 * std::atan2(s, sign * q.w);
  const double share = s > 1e-12 ? sign * angle_rad / s : sign * 2.0;  // the limit for small
                                                                       // rotations is 2
  return {share * q.x, share * q.y, share * q.z};
}

std::vector<double> SetPoints(const ExperimentSpec& experiment) {
  std::vector<double> times;
  const auto add = [&](const std::vector<std::pair<double, double>>& course) {
    for (std::size_t i = 1; i < course.size(); ++i) {
      if (course[i].second != course[i - 1].second) times.push_back(course[i].first);
    }
  };
  for (const ControllerSpec& controller : experiment.controllers) {
    for (const PositionProgram& program : controller.position) add(program.rest_length_m);
  }
  for (const PushSpec& push : experiment.pushes) add(push.force_n);
  std::sort(times.begin(), times.end());
  const auto same = [](double a, double b) { return b - a < 1e-9; };
  times.erase(std::unique(times.begin(), times.end(), same), times.end());
  return times;
}

}  // namespace taut::identify
