// Cable readings of a world: state, spans, path, bends.
#include <algorithm>

#include "math/cable_wheel.h"
#include "math/elementary.h"
#include "sim/batch/batch_impl.h"

namespace taut {

namespace {

/// Returns the rows with the readings of a cable.
CableReadings<int> RowsOf(const sim::Layout& l) {
  return {.rest_length_m = l.rest,
          .length_m = l.sense_length,
          .rate_m_per_s = l.sense_rate,
          .tension_n = l.sense_tension,
          .elastic_n = l.sense_elastic,
          .stiffness_n_per_m = l.stiffness};
}

}  // namespace

CableState WorldBatch::Cable(int world, int cable) const noexcept {
  const Impl& d = *impl_;
  d.CheckCable(__func__, world, cable);
  d.Sense(world);
  return MapReadings([&](int row) { return d.at(world, row + cable); }, RowsOf(d.layout));
}

int WorldBatch::CableSpans(int cable) const noexcept {
  const Impl& d = *impl_;
  d.CheckCable(__func__, 0, cable);
  return std::max(d.view.cables[cable].span_count, 1);
}

CableSpanState WorldBatch::CableSpan(int world, int cable, int span) const noexcept {
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

struct WorldBatch::Impl::LaidCable {
  std::vector<PathPoint<Vec3>> points;
  std::vector<int> bodies;  ///< Per point; the index of the world follows the last body.
  /// Per point: number of the span that ends at the point. The next span starts at the next point.
  std::vector<int> spans;
  std::vector<Wheel<Vec3>> wheels;
};

std::vector<double> WorldBatch::CableSpanTensions(int world, int cable) const {
  const Impl& d = *impl_;
  d.CheckCable(__func__, world, cable);
  const sim::CableTable& table = d.view.cables[cable];
  std::vector<double> tensions;
  if (table.touch < 0 || table.span_count == 0) {
    for (int i = 0; i < CableSpans(cable); ++i) {
      tensions.push_back(CableSpan(world, cable, i).tension_n);
    }
    return tensions;
  }
  // Bends that the cable has left do not separate spans.
  const Impl::LaidCable laid = d.Lay(world, cable);
  for (const Wheel<Vec3>& wheel : laid.wheels) {
    const int span = laid.spans[static_cast<std::size_t>(wheel.at)];
    tensions.push_back(CableSpan(world, cable, span).tension_n);
  }
  tensions.push_back(CableSpan(world, cable, laid.spans.back()).tension_n);
  return tensions;
}

double WorldBatch::WheelAngle(int world, int cable, int wheel) const noexcept {
  const Impl& d = *impl_;
  d.CheckCable(__func__, world, cable);
  const sim::CableTable& table = d.view.cables[cable];
  sim::CheckIndex(__func__, "wheel", wheel, table.wheel_count);
  return d.at(world, d.layout.wheel_angle + table.first_wheel + wheel);
}

std::vector<sim::WrapPointNumbers<double>> WorldBatch::Impl::Bends(int world, int cable) const {
  std::vector<sim::WrapPointNumbers<double>> bends;
  const int touch = view.cables[cable].touch;
  for (int k = 0; touch >= 0 && k < sim::kMostBends; ++k) {
    const int number = view.touches[touch].first_bend + k;
    bends.push_back(Struct<sim::WrapPointNumbers<double>>(world, layout.bend, number));
    if (bends.back().key == sim::kNoKey) return bends.pop_back(), bends;
  }
  return bends;
}

int WorldBatch::CableBends(int world, int cable) const {
  return static_cast<int>(CableBendPlaces(world, cable).size());
}

WorldBatch::Impl::LaidCable WorldBatch::Impl::Lay(int world, int cable) const {
  Sense(world);
  const sim::CableTable& table = view.cables[cable];
  const auto turned = [&](int body, const double* p) {
    const Vec3 in_P{p[0], p[1], p[2]};
    return body == view.body_count ? in_P : Rotate(quat(world, body), in_P);
  };
  const auto in_W = [&](int body, const double* p) {
    const Vec3 arm = turned(body, p);
    return body == view.body_count ? arm : vec(world, layout.pos + 3 * body) + arm;
  };
  const auto place = [&](const sim::AttachmentTable& at) { return in_W(at.body, at.p_P); };
  LaidCable laid;
  auto& [points, bodies, spans, wheels] = laid;
  int slip = table.first_slip;
  for (int i = 0; i < table.attachment_count; ++i) {
    const sim::AttachmentTable& at = view.attachments[table.first_attachment + i];
    points.push_back({place(at), {}, {}, {}});
    bodies.push_back(at.body);
    spans.push_back(slip - table.first_slip);
    const bool parts = table.touch < 0 && slip + 1 < table.first_slip + table.span_count;
    if (parts && i == view.slips[slip].at) ++slip;
  }
  std::vector<double> along;
  for (const sim::WrapPointNumbers<double>& bend : Bends(world, cable)) {
    const int number = static_cast<int>(wheels.size());
    const int first = 1 + 2 * number, body = static_cast<int>(bend.body);
    wheels.push_back({in_W(body, bend.center), turned(body, bend.axis), bend.radius, bend.angle,
                      first, 0, 0, 0});
    points.insert(points.begin() + first, 2, PathPoint<Vec3>{});
    bodies.insert(bodies.begin() + first, 2, body);
    spans.insert(spans.begin() + first, {number, number + 1});
    spans.back() = number + 1;
    along.push_back(table.span_count > 0 ? at(world, layout.slip_along + table.first_slip + number)
                                         : kNotHeld);
  }
  for (int k = 0; k < table.wheel_count; ++k) {
    const sim::WheelTable& wheel = view.wheels[table.first_wheel + k];
    const Vec3 center = place(view.spots[wheel.center_spot]);
    wheels.push_back({center, place(view.spots[wheel.axis_spot]) - center, wheel.radius_m,
                      at(world, layout.wheel_angle + table.first_wheel + k), wheel.at, 0, 0, 0});
  }
  const int wheel_count = static_cast<int>(wheels.size());
  const bool begun = table.touch >= 0 && wheel_count > 1;
  if (begun) {
    std::vector<double> half;
    for (const sim::WrapPointNumbers<double>& bend : Bends(world, cable)) half.push_back(bend.half);
    const std::vector<double> has(wheels.size(), 1.0);
    BeginOnWheels(points.data(), wheel_count, wheels.data(), half.data(), has.data());
  }
  LayOnWheels(points.data(), wheel_count, wheels.data(), along.empty() ? nullptr : along.data(),
              begun);
  // Bends that the cable has left are not part of its path.
  for (std::size_t k = wheels.size(); table.touch >= 0 && k-- > 0;) {
    if (wheels[k].theta > 0) continue;
    points.erase(points.begin() + wheels[k].at, points.begin() + wheels[k].at + 2);
    bodies.erase(bodies.begin() + wheels[k].at, bodies.begin() + wheels[k].at + 2);
    spans.erase(spans.begin() + wheels[k].at, spans.begin() + wheels[k].at + 2);
    for (std::size_t i = k + 1; i < wheels.size(); ++i) wheels[i].at -= 2;
    wheels.erase(wheels.begin() + static_cast<std::ptrdiff_t>(k));
  }
  return laid;
}

std::vector<CablePoint> WorldBatch::CablePath(int world, int cable) const {
  const Impl& d = *impl_;
  d.CheckCable(__func__, world, cable);
  const sim::CableTable& table = d.view.cables[cable];
  auto [points, bodies, spans, wheels] = d.Lay(world, cable);
  const int count = static_cast<int>(points.size());
  MeasurePath(count, points.data(), static_cast<int>(wheels.size()), wheels.data());
  std::vector<CablePoint> path;
  const auto tension = [&](int span) {
    return table.span_count > 0 ? CableSpan(world, cable, span).tension_n
                                : Cable(world, cable).tension_n;
  };
  for (int i = 0; i < count; ++i) {
    const int body = bodies[static_cast<std::size_t>(i)];
    CablePoint point{body == d.view.body_count ? kWorld : body, points[i].p, {}};
    if (i > 0) point.force_n = point.force_n - tension(spans[i]) * points[i].u;
    if (i + 1 < count) point.force_n = point.force_n + tension(spans[i + 1]) * points[i + 1].u;
    path.push_back(point);
  }
  return path;
}

std::vector<Vec3> WorldBatch::CableBendPlaces(int world, int cable) const {
  const Impl& d = *impl_;
  d.CheckCable(__func__, world, cable);
  std::vector<Vec3> places;
  if (d.view.cables[cable].touch < 0) return places;
  const Impl::LaidCable laid = d.Lay(world, cable);
  for (const Wheel<Vec3>& wheel : laid.wheels) {
    const Vec3 arrives = laid.points[static_cast<std::size_t>(wheel.at)].p - wheel.center;
    const Vec3 leaves = laid.points[static_cast<std::size_t>(wheel.at) + 1].p - wheel.center;
    const double z = Dot(arrives, wheel.axis);
    const Vec3 out = arrives - z * wheel.axis;
    const double half = (wheel.angle < 0 ? -0.5 : 0.5) * wheel.theta;
    places.push_back(wheel.center + 0.5 * (z + Dot(leaves, wheel.axis)) * wheel.axis +
                     math::Cos(half) * out + math::Sin(half) * Cross(wheel.axis, out));
  }
  return places;
}

double WorldBatch::CableWrap(int world, int cable) const {
  const Impl& d = *impl_;
  d.CheckCable(__func__, world, cable);
  double sum_rad = 0;
  for (const Wheel<Vec3>& wheel : d.Lay(world, cable).wheels) sum_rad += std::max(wheel.theta, 0.0);
  return sum_rad;
}

double WorldBatch::CableFrictionLoss(int world, int cable) const noexcept {
  const Impl& d = *impl_;
  d.CheckCable(__func__, world, cable);
  d.Sense(world);
  double sum_j = 0;
  for (int i = 0; i + 1 < d.view.cables[cable].span_count; ++i) {
    sum_j += d.at(world, d.layout.sense_slip_loss + d.view.cables[cable].first_slip + i);
  }
  return sum_j;
}

int WorldBatch::groups() const noexcept { return static_cast<int>(impl_->groups.size()); }

CableRows WorldBatch::Cables(int group) noexcept {
  const Impl& d = *impl_;
  sim::CheckIndex(__func__, "group", group, groups());
  const int first_world = group * d.lanes();
  d.Sense(first_world);
  // Without cables, the rows are empty and may start after the last row.
  const auto first = [&](int row) { return d.group(first_world).rows + row * d.lanes(); };
  return {MapReadings([&](int row) -> const double* { return first(row); }, RowsOf(d.layout)),
          d.lanes(), first_world, first(d.layout.target)};
}

}  // namespace taut
