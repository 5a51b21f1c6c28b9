/// Compilation of the cables of a model: path points, wheels, and spans separated by friction.

#include <algorithm>
#include <cmath>
#include <set>

#include "base/assert.h"
#include "math/cable_law.h"
#include "math/described_path.h"
#include "sim/data/tables.h"

namespace taut::sim {
namespace {

class CableCompiler {
 public:
  CableCompiler(Tables& t, const std::vector<Frame>& frames)
      : t_(t), frames_(frames), spots_of_(frames.size()) {}

  void Run() {
    for (const CableDef& c : t_.def().cables) {
      CableTable table;
      table.first_attachment = static_cast<int>(t_.attachments.size());
      table.clamped_damping = c.damping_law == DampingLaw::kClamped;
      const ActuatorDef& limit = c.actuator;
      table.actuator = {limit.kind,        limit.max_speed_m_per_s, limit.max_acceleration_m_per_s2,
                        limit.max_force_n, limit.min_rest_length_m, limit.min_length_m};
      table.inv_max_speed = 1.0 / c.actuator.max_speed_m_per_s;
      table.first_wheel = static_cast<int>(t_.wheels.size());
      for (std::size_t i = 0; i < c.attachments.size(); ++i) {
        const AttachmentDef& a = c.attachments[i];
        t_.attachments.push_back(Attach(a.body, a.position_m));
        t_.attachments.back().spot = Spot(t_.attachments.back());
        if (a.wheel) AddWheel(c, i, table);
      }
      table.attachment_count = static_cast<int>(t_.attachments.size()) - table.first_attachment;
      table.wheel_count = static_cast<int>(t_.wheels.size()) - table.first_wheel;
      t_.max_wheels = std::max(t_.max_wheels, table.wheel_count);
      AddSpans(c, table);
      AddTouch(c, table);
      const auto* const ends = &t_.attachments[static_cast<std::size_t>(table.first_attachment)];
      table.joins_two = table.attachment_count == 2 && table.touch < 0 &&
                        ends[0].body != ends[1].body && ends[0].body < t_.body_count &&
                        ends[1].body < t_.body_count;
      t_.max_attachments = std::max(t_.max_attachments, table.attachment_count);
      t_.cables.push_back(table);
      const double stretch = math::DescribedPath(c).length_m() - c.rest_length_m;
      t_.start_tension_n.push_back(
          std::max(math::CableLaw{c.stiffness_n_per_m}.Force(stretch), 0.0));
    }
  }

 private:
  AttachmentTable Attach(int body, const Vec3& p) const {
    AttachmentTable a;
    a.body = body == kWorld ? t_.body_count : body;
    ToBody(frames_[static_cast<std::size_t>(a.body)], p, a.p_P);
    return a;
  }

  /// Returns the number of the point of a body that all attachments at this place share.
  int Spot(const AttachmentTable& a) {
    std::vector<int>& here = spots_of_[static_cast<std::size_t>(a.body)];
    for (const int i : here) {
      if (std::equal(a.p_P, a.p_P + 3, t_.spots[static_cast<std::size_t>(i)].p_P)) return i;
    }
    here.push_back(static_cast<int>(t_.spots.size()));
    t_.spots.push_back(a);
    return here.back();
  }

  /// Adds the wheel of attachment `i`, which already exists, and its second path point.
  void AddWheel(const CableDef& cable, std::size_t i, const CableTable& table) {
    const AttachmentDef& a = cable.attachments[i];
    const AttachmentTable center = t_.attachments.back();
    WheelTable wheel;
    wheel.at = static_cast<int>(t_.attachments.size()) - 1 - table.first_attachment;
    wheel.center_spot = center.spot;
    wheel.axis_spot = Spot(Attach(a.body, a.position_m + a.wheel->axis));
    wheel.radius_m = a.wheel->radius_m;
    wheel.start_angle = math::StartAngle(cable, i);
    if (a.friction > 0) {
      wheel.mark_spot = Spot(Attach(a.body, a.position_m + Across(a.wheel->axis)));
    }
    t_.attachments.push_back(center);
    t_.wheels.push_back(wheel);
  }

  /// Returns a unit vector normal to `axis`.
  static Vec3 Across(const Vec3& axis) {
    const double x = std::fabs(axis.x), y = std::fabs(axis.y), z = std::fabs(axis.z);
    const Vec3 least = x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
    const Vec3 way = Cross(axis, least);
    return (1.0 / std::sqrt(Dot(way, way))) * way;
  }

  /// Adds the spans of a cable with friction, and the points where it slips.
  void AddSpans(const CableDef& cable, CableTable& table) {
    const auto slips = [](const AttachmentDef& a) { return a.friction > 0; };
    if (std::none_of(cable.attachments.begin(), cable.attachments.end(), slips)) return;
    math::DescribedPath path(cable);
    table.first_slip = static_cast<int>(t_.slips.size());
    table.first_span = t_.span_count;
    int wheel = 0;
    for (int i = 1; i + 1 < path.count(); ++i) {
      const AttachmentDef& a = cable.attachments[path.attachment(i)];
      const bool second = a.wheel && path.attachment(i) == path.attachment(i - 1);
      if (second) continue;
      if (a.friction > 0) {
        SlipTable slip;
        slip.at = i, slip.friction = a.friction;
        if (a.wheel) {
          slip.wheel = table.first_wheel + wheel;
          slip.start_place = MiddleOf(path.wheels()[static_cast<std::size_t>(wheel)],
                                      Across(a.wheel->axis), path.points());
        }
        t_.slips.push_back(slip);
      }
      wheel += a.wheel.has_value();
    }
    table.span_count = static_cast<int>(t_.slips.size()) - table.first_slip + 1;
    for (const double length_m : math::SpanLengths(cable)) {
      t_.span_rest_m.push_back(cable.rest_length_m * (length_m / path.length_m()));
    }
    t_.span_count += table.span_count;
    ++t_.chain_count;
    TAUT_ASSERT(static_cast<int>(t_.span_rest_m.size()) == t_.span_count);
  }

  void AddTouch(const CableDef& cable, CableTable& table) {
    if (cable.touches == CableTouches::kNone) return;
    table.touch = static_cast<int>(t_.touches.size());
    const bool terrain = cable.touches != CableTouches::kRods;
    t_.touches.push_back({static_cast<int>(t_.cables.size()), kMostBends * table.touch,
                          cable.radius_m, terrain, cable.touch_friction, 0, 0});
    if (cable.touch_friction > 0) AddOwnSpans(cable, table);
    t_.max_attachments = std::max(t_.max_attachments, 2 + 2 * kMostBends);
    t_.max_wheels = std::max(t_.max_wheels, kMostBends);
  }

  /// Allocates spans for a cable that may touch rods or terrain. The number of spans changes with
  /// the contacts of the cable; at the start, there is one span.
  void AddOwnSpans(const CableDef& cable, CableTable& table) {
    table.first_slip = static_cast<int>(t_.slips.size());
    table.first_span = t_.span_count;
    table.span_count = kMostBends + 1;
    SlipTable slip;
    slip.friction = cable.touch_friction;
    t_.slips.insert(t_.slips.end(), kMostBends, slip);
    t_.span_rest_m.push_back(cable.rest_length_m);
    t_.span_count += table.span_count;
    t_.span_rest_m.resize(static_cast<std::size_t>(t_.span_count));
    ++t_.chain_count;
  }

  Tables& t_;
  const std::vector<Frame>& frames_;
  std::vector<std::vector<int>> spots_of_;  ///< Per body and for the world.
};

}  // namespace

void LayOutTouchRods(Tables& t) {
  for (std::size_t c = 0; c < t.cables.size(); ++c) {
    const CableDef& def = t.def().cables[c];
    if (t.cables[c].touch < 0) continue;
    TouchTable& touch = t.touches[static_cast<std::size_t>(t.cables[c].touch)];
    touch.first_rod = static_cast<int>(t.touch_rods.size());
    const auto* const ends = &t.attachments[static_cast<std::size_t>(t.cables[c].first_attachment)];
    for (std::size_t i = 0; def.touches != CableTouches::kTerrain && i < t.shapes.size(); ++i) {
      const ShapeTable& shape = t.shapes[i];
      const RoundShape& round = shape.shape_P.round;
      if (shape.shape_P.kind != ShapeKind::kRound || !t.Moves(shape.body)) continue;
      TouchRodTable rod;
      rod.shape = static_cast<int>(i);
      rod.body = shape.body;
      rod.radius_m = round.radius_m + def.radius_m;
      for (int k = 0; k < 3; ++k) {
        rod.center_P[k] = 0.5 * (round.from[k] + round.to[k]);
        rod.axis_P[k] = 0.5 * (round.to[k] - round.from[k]);
        rod.half_m += rod.axis_P[k] * rod.axis_P[k];
      }
      rod.half_m = std::sqrt(rod.half_m);
      if (!(rod.half_m > 0)) continue;
      for (double& x : rod.axis_P) x /= rod.half_m;
      const auto ends_on = [&](const AttachmentTable& end) {
        return end.body == rod.body && MayReach(shape.shape_P, end.p_P, 0.0, def.radius_m);
      };
      if (!ends_on(ends[0]) && !ends_on(ends[1])) t.touch_rods.push_back(rod);
    }
    touch.rod_count = static_cast<int>(t.touch_rods.size()) - touch.first_rod;
  }
}

void LayOutChainLinks(Tables& t) {
  constexpr int kMostLinksOfSpan = 16;  // two links in each of eight lanes
  for (CableTable& cable : t.cables) {
    if (cable.span_count == 0) continue;
    cable.first_link = t.chain_link_count;
    cable.link_room = 2 * cable.attachment_count;
    if (cable.touch >= 0) {
      // Links of a span: at most two in each of the eight lanes, and at most one per body that the
      // cable can pull.
      const TouchTable& touch = t.touches[static_cast<std::size_t>(cable.touch)];
      std::set<int> bodies;
      for (int i = 0; i < touch.rod_count; ++i) {
        bodies.insert(t.touch_rods[static_cast<std::size_t>(touch.first_rod + i)].body);
      }
      const int most = std::min(static_cast<int>(bodies.size()) + 2, kMostLinksOfSpan);
      cable.link_room = cable.span_count * most;
    }
    t.chain_link_count += cable.link_room;
  }
}

void LayOutCables(Tables& tables, const std::vector<Frame>& frames) {
  CableCompiler(tables, frames).Run();
}

}  // namespace taut::sim

namespace taut {

bool HasFriction(const CableDef& cable) {
  const auto slips = [](const AttachmentDef& at) { return at.friction > 0; };
  return cable.touch_friction > 0 ||
         std::any_of(cable.attachments.begin(), cable.attachments.end(), slips);
}

}  // namespace taut
