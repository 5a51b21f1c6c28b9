// What can be seen of a world's cables.
#include <algorithm>

#include "math/cable_wheel.h"
#include "sim/batch_impl.h"

namespace taut {

namespace {

/// The rows that hold what is read of a cable.
CableReadings<int> RowsOf(const sim::Layout& l) {
  return {.rest_length_m = l.rest,
          .length_m = l.sense_length,
          .rate_m_per_s = l.sense_rate,
          .tension_n = l.sense_tension,
          .elastic_n = l.sense_elastic,
          .stiffness_n_per_m = l.stiffness};
}

}  // namespace

CableState Batch::Cable(int world, int cable) const noexcept {
  const Impl& d = *impl_;
  d.CheckCable(__func__, world, cable);
  d.Sense(world);
  return MapReadings([&](int row) { return d.at(world, row + cable); }, RowsOf(d.layout));
}

int Batch::CableSpans(int cable) const noexcept {
  const Impl& d = *impl_;
  d.CheckCable(__func__, 0, cable);
  return std::max(d.view.cables[cable].span_count, 1);
}

CableSpanState Batch::CableSpan(int world, int cable, int span) const noexcept {
  const Impl& d = *impl_;
  d.CheckCable(__func__, world, cable);
  sim::CheckIndex(__func__, "span", span, CableSpans(cable));
  d.Sense(world);
  const sim::CableTable& table = d.view.cables[cable];
  if (table.span_count == 0) {
    const CableState all = Cable(world, cable);
    return {all.length_m, all.rest_length_m, all.tension_n};
  }
  const int row = table.first_span + span;
  return {d.at(world, d.layout.sense_span_length + row),
          d.at(world, d.layout.sense_span_rest + row), d.at(world, d.layout.span_tension + row)};
}

double Batch::WheelAngle(int world, int cable, int wheel) const noexcept {
  const Impl& d = *impl_;
  d.CheckCable(__func__, world, cable);
  const sim::CableTable& table = d.view.cables[cable];
  sim::CheckIndex(__func__, "wheel", wheel, table.wheel_count);
  return d.at(world, d.layout.wheel_angle + table.first_wheel + wheel);
}

std::vector<CablePoint> Batch::CablePath(int world, int cable) const {
  const Impl& d = *impl_;
  d.CheckCable(__func__, world, cable);
  d.Sense(world);
  const sim::CableTable& table = d.view.cables[cable];
  const auto place = [&](const sim::AttachmentTable& at) {
    const Vec3 p{at.p_P[0], at.p_P[1], at.p_P[2]};
    if (at.body == d.view.body_count) return p;
    return d.vec(world, d.layout.pos + 3 * at.body) + Rotate(d.quat(world, at.body), p);
  };
  std::vector<PathPoint<Vec3>> points;
  for (int i = 0; i < table.attachment_count; ++i) {
    points.push_back({place(d.view.attachments[table.first_attachment + i]), {}, {}, {}});
  }
  std::vector<Wheel<Vec3>> wheels;
  for (int k = 0; k < table.wheel_count; ++k) {
    const sim::WheelTable& wheel = d.view.wheels[table.first_wheel + k];
    const Vec3 center = place(d.view.spots[wheel.center_spot]);
    wheels.push_back({center, place(d.view.spots[wheel.axis_spot]) - center, wheel.radius_m,
                      WheelAngle(world, cable, k), wheel.at, 0, 0, 0});
  }
  LayOnWheels(points.data(), table.wheel_count, wheels.data());
  MeasurePath(table.attachment_count, points.data(), table.wheel_count, wheels.data());
  std::vector<CablePoint> path;
  int span = 0;
  const auto tension = [&] {
    return table.span_count > 0 ? CableSpan(world, cable, span).tension_n
                                : Cable(world, cable).tension_n;
  };
  for (int i = 0; i < table.attachment_count; ++i) {
    const int body = d.view.attachments[table.first_attachment + i].body;
    CablePoint point{body == d.view.body_count ? kWorld : body, points[i].p, {}};
    if (i > 0) point.force_n = point.force_n - tension() * points[i].u;
    const sim::SlipTable* const slip =
        span + 1 < table.span_count ? d.view.slips + table.first_slip + span : nullptr;
    if (slip != nullptr && i == slip->at) ++span;
    if (i + 1 < table.attachment_count) point.force_n = point.force_n + tension() * points[i + 1].u;
    path.push_back(point);
  }
  return path;
}

double Batch::CableFrictionLoss(int world, int cable) const noexcept {
  const Impl& d = *impl_;
  d.CheckCable(__func__, world, cable);
  d.Sense(world);
  double sum_j = 0;
  for (int i = 0; i + 1 < d.view.cables[cable].span_count; ++i) {
    sum_j += d.at(world, d.layout.sense_slip_loss + d.view.cables[cable].first_slip + i);
  }
  return sum_j;
}

int Batch::groups() const noexcept { return static_cast<int>(impl_->groups.size()); }

CableRows Batch::Cables(int group) noexcept {
  const Impl& d = *impl_;
  sim::CheckIndex(__func__, "group", group, groups());
  const int first_world = group * d.lanes();
  d.Sense(first_world);
  // Of a model without cables the rows are empty, and may be behind the last.
  const auto first = [&](int row) { return d.group(first_world).rows + row * d.lanes(); };
  return {MapReadings([&](int row) -> const double* { return first(row); }, RowsOf(d.layout)),
          d.lanes(), first_world, first(d.layout.target)};
}

}  // namespace taut
