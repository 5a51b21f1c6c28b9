#include "description/gait/gait_toward_goal.h"

#include <cmath>

#include "math/vec.h"

namespace taut::description {
namespace {

/// Returns the directions of all bodies that are a single rod, in the described pose. Fixed rods
/// are excluded, since they do not rotate with the robot.
std::vector<ResolvedGait::Strut> StrutsOf(const ModelDef& def) {
  std::vector<int> rods(def.bodies.size());
  for (const CapsuleDef& rod : def.capsules) {
    if (rod.body != kWorld) ++rods[static_cast<std::size_t>(rod.body)];
  }
  std::vector<ResolvedGait::Strut> struts;
  for (const CapsuleDef& rod : def.capsules) {
    if (rod.body == kWorld || rods[static_cast<std::size_t>(rod.body)] != 1) continue;
    if (def.bodies[static_cast<std::size_t>(rod.body)].fixed) continue;
    const Vec3 along = rod.to_m - rod.from_m;
    const double length_m = std::sqrt(Dot(along, along));
    if (length_m > 0) struts.push_back({rod.body, (1 / length_m) * along});
  }
  return struts;
}

/// Returns how evenly directions are distributed in space, from 0 (in one plane) to 1: the
/// determinant of sum u u^T, divided by its largest possible value.
double Spread(const std::vector<ResolvedGait::Strut>& struts) {
  double xx = 0, yy = 0, zz = 0, xy = 0, yz = 0, xz = 0;
  for (const ResolvedGait::Strut& strut : struts) {
    const Vec3& u = strut.along;
    xx += u.x * u.x, yy += u.y * u.y, zz += u.z * u.z;
    xy += u.x * u.y, yz += u.y * u.z, xz += u.x * u.z;
  }
  const double third = static_cast<double>(struts.size()) / 3;
  return (xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz)) /
         (third * third * third);
}

/// With struts almost in one plane, the orientation of the robot is poorly determined.
constexpr double kLeastSpread = 1e-3;

}  // namespace

void Check(const MapReader&, TowardGoalGait&) {}

void CheckNumbers(const TowardGoalGait&, const SourceRef&, Diagnostics&) {}

void Resolve(const TowardGoalGait& gait, const RobotSpec& robot, ResolvedGait& resolved,
             Diagnostics& out) {
  const std::vector<int> cables = FindCables(gait.cables, "toward_goal", gait.at, robot, out);
  if (cables.empty()) return;
  const ModelDef& def = robot.def;
  std::vector<ResolvedGait::Strut> struts = StrutsOf(def);
  if (struts.size() < 3 || !(Spread(struts) > kLeastSpread)) {
    out.Error("gait.strut_directions", gait.at,
              "toward_goal: the " + std::to_string(struts.size()) + " struts of " + def.name +
                  " do not have three independent directions",
              "the rotation of the robot is computed from bodies that are a single rod");
    return;
  }
  std::vector<Vec3> middles;
  Vec3 center;
  for (const int cable : cables) {
    const CableDef& of = def.cables[static_cast<std::size_t>(cable)];
    middles.push_back(0.5 * (of.attachments.front().position_m + of.attachments.back().position_m));
    center = center + middles.back();
  }
  const auto count = static_cast<double>(cables.size());
  center = (1 / count) * center;
  double square_m2 = 0;
  for (const Vec3& middle : middles) square_m2 += Dot(middle - center, middle - center);
  const double radius_m = std::sqrt(square_m2 / count);
  if (!(radius_m > 0)) {
    out.Error("gait.cables_in_one_place", gait.at,
              "toward_goal: all selected cables have the same midpoint",
              "select cables on all sides of the robot");
    return;
  }
  resolved.cables = cables;
  resolved.struts = std::move(struts);
  for (const Vec3& middle : middles) {
    resolved.from_center.push_back((1 / radius_m) * (middle - center));
  }
}

}  // namespace taut::description
