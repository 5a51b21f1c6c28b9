#include "description/model/follow_route.h"

#include <cmath>

#include "description/yaml/reader.h"
#include "math/described_path.h"
#include "math/elementary.h"

namespace taut::description {
namespace {

constexpr double kSameDirection = 1e-6;  ///< Directions count as parallel if the sine of their
                                         ///< angle is below this value, about the precision of
                                         ///< numbers in files.

/// Returns the point on a drum's rim at which the cable ends. The cable comes from `from`, touches
/// the rim tangentially and continues along it by `wound_rad`. `center`: center of the drum.
Vec3 RimPoint(const Vec3& center, const WheelDef& wheel, const Vec3& from, double wound_rad) {
  const Vec3 way = from - center;
  const Vec3 along = Dot(way, wheel.axis) * wheel.axis, out = way - along;
  const double distance = Length(out);
  const double turn =
      (wheel.counterclockwise ? 1 : -1) * (math::Acos(wheel.radius_m / distance) + wound_rad);
  const Vec3 x = (1.0 / distance) * out, y = Cross(wheel.axis, x);
  return center + along + wheel.radius_m * (math::Cos(turn) * x + math::Sin(turn) * y);
}

/// Returns the number of whole turns for which the angle of wrap at attachment `i` is nearest to
/// `angle_rad`.
int TurnsFor(const CableDef& cable, std::size_t i, double angle_rad) {
  const double least = std::fabs(math::StartAngle(cable, i));
  return static_cast<int>(std::lround((angle_rad - least) / (2 * kPi)));
}

class RouteFollower {
 public:
  RouteFollower(const PlacedPair& pair, const Assembly& assembly, CableDef& cable,
                OncePerPlace& complain)
      : pair_(pair), assembly_(assembly), cable_(cable), complain_(complain) {}

  void Run() {
    int spans = 1;
    bool good = true;
    for (std::size_t i = 0; i < pair_.route.size(); ++i) {
      spans += pair_.route[i].friction > 0;
      good = Element(i) && good;
    }
    if (spans > CableDef::kMostSpans) {
      complain_("route.too_much_friction", pair_.at,
                "the cable \"" + pair_.name + "\" has friction at more than " +
                    std::to_string(CableDef::kMostSpans - 1) + " elements of its route");
    }
    if (!good) return;
    // Start with the last end, so that indices of the first end remain valid.
    const std::size_t last = pair_.route.size() - 1;
    if (pair_.route[last].is_drum()) EndOnDrum(last, last - 1, last + 1);
    if (pair_.route[0].is_drum()) EndOnDrum(0, 1, 0);
  }

 private:
  /// Sets friction and wheel of element `i`. Returns false if the cable cannot run around the
  /// wheel.
  bool Element(std::size_t i) {
    const RouteText& element = pair_.route[i];
    AttachmentDef& at = cable_.attachments[i];
    at.friction = element.friction;
    if (!element.is_pulley() && !element.is_drum()) return true;
    WheelDef wheel;
    wheel.axis = element.axis;
    if (pair_.instance >= 0) {
      wheel.axis = Rotate(assembly_.instances[pair_.instance].q_WPart, element.axis);
    }
    wheel.radius_m = element.radius_m;
    wheel.counterclockwise = element.left;
    if (element.is_pulley() && element.turns < 1e6) wheel.turns = static_cast<int>(element.turns);
    bool good = std::isfinite(wheel.radius_m) && std::isfinite(wheel.axis.x) && wheel.radius_m > 0;
    at.wheel = wheel;
    if (!good) return false;
    for (const std::size_t k : {i - 1, i + 1}) {
      if (k >= pair_.route.size()) continue;
      const Vec3 way = cable_.attachments[k].position_m - at.position_m;
      const double beside = Length(Cross(wheel.axis, way));
      if (beside > wheel.radius_m || std::isnan(beside)) continue;
      const std::string name = assembly_.nodes[pair_.nodes[k]].name;
      const std::string what = element.is_drum() ? "drum" : "pulley";
      if (beside < 1e-9) {
        complain_("route.node_on_axis", element.at,
                  "the node \"" + name + "\" is on the axis of the " + what + " of the cable \"" +
                      pair_.name + "\"",
                  "choose an axis across the cable");
      } else {
        complain_("route.node_inside_wheel", element.at,
                  "the node \"" + name + "\" is inside the " + what + " of the cable \"" +
                      pair_.name + "\"",
                  "it is " + Shown(std::round(1e6 * beside) / 1e6) +
                      " m from the axis: choose a smaller radius_m");
      }
      good = false;
    }
    return good && HasASide(i);
  }

  /// Returns whether the wheel is on one side of the cable, left or right. Returns false if the
  /// axis is parallel to the line between the neighboring points. Wheels with whole turns always
  /// qualify.
  bool HasASide(std::size_t i) {
    const RouteText& element = pair_.route[i];
    if (i == 0 || i + 1 == pair_.route.size() || element.turns > 0) return true;
    for (const std::size_t k : {i - 1, i + 1}) {
      // If a neighbor is a wheel, its tangent point is not known yet.
      if (pair_.route[k].is_pulley() || pair_.route[k].is_drum()) return true;
    }
    const Vec3 from = cable_.attachments[i - 1].position_m;
    const Vec3 to = cable_.attachments[i + 1].position_m;
    const double across = Length(Cross(cable_.attachments[i].wheel->axis, to - from));
    if (!(across < kSameDirection * Length(to - from))) return true;
    complain_("route.axis_along_cable", element.at,
              "the axis of the pulley of the cable \"" + pair_.name +
                  "\" is parallel to the line from \"" + assembly_.nodes[pair_.nodes[i - 1]].name +
                  "\" to \"" + assembly_.nodes[pair_.nodes[i + 1]].name +
                  "\", so the wheel is on neither side of the cable",
              "choose an axis across the cable, or add whole `turns`");
    return false;
  }

  /// Inserts the attachment on the drum's rim at index `end`.
  void EndOnDrum(std::size_t drum, std::size_t next, std::size_t end) {
    const AttachmentDef at = cable_.attachments[drum];
    WheelDef wheel = *at.wheel;
    // Seen from the other end of the cable, the sense of rotation is opposite.
    const Vec3 from = cable_.attachments[next].position_m;
    const bool arrives = end > drum;
    if (!arrives) wheel.counterclockwise = !wheel.counterclockwise;
    const double wound = 2 * kPi * pair_.route[drum].turns;
    const Vec3 rim = RimPoint(at.position_m, wheel, from, wound);
    cable_.attachments.insert(cable_.attachments.begin() + static_cast<std::ptrdiff_t>(end),
                              {at.body, rim});
    const std::size_t here = arrives ? drum : drum + 1;
    const Vec3 way = from - at.position_m;
    const double straight = math::Acos(wheel.radius_m / Length(Cross(wheel.axis, way)));
    cable_.attachments[here].wheel->turns = TurnsFor(cable_, here, straight + wound);
  }

  const PlacedPair& pair_;
  const Assembly& assembly_;
  CableDef& cable_;
  OncePerPlace& complain_;
};

}  // namespace

void FollowRoute(const PlacedPair& pair, const Assembly& assembly, CableDef& cable,
                 OncePerPlace& complain) {
  RouteFollower(pair, assembly, cable, complain).Run();
}

}  // namespace taut::description
