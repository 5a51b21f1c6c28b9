// Motions of kinematic bodies: tables of a model, and poses outside of steps.
#include "sim/batch/motion.h"

#include "sim/batch/batch_impl.h"
#include "sim/data/motion_at.h"
#include "sim/data/tables.h"

namespace taut::sim {
namespace {

struct OutsideOfSteps;
using One = simd::Wide<1, OutsideOfSteps>;

Vec3 Get(const V3<One>& a) { return {a.x[0], a.y[0], a.z[0]}; }
void Put(const Vec3& a, double* out) { out[0] = a.x, out[1] = a.y, out[2] = a.z; }

TimeLawTable LayOut(const TimeLaw& law, std::vector<MotionKnot>& knots) {
  TimeLawTable table;
  table.first_knot = static_cast<int>(knots.size());
  for (const auto& [t, v] : law.speed) {
    if (static_cast<int>(knots.size()) == table.first_knot && t > 0) knots.push_back({0, v, 0, 0});
    MotionKnot knot{t, v, 0, 0};
    if (static_cast<int>(knots.size()) > table.first_knot) {
      MotionKnot& last = knots.back();
      const double since = t - last.t;
      last.a = (v - last.v) / since;
      knot.x = last.x + since * (last.v + 0.5 * last.a * since);
    }
    knots.push_back(knot);
  }
  table.knot_count = static_cast<int>(knots.size()) - table.first_knot;
  table.amplitude = law.amplitude;
  table.turns_per_s = law.frequency_hz;
  table.phase_turns = law.phase_rad * (0.5 / simd::kPi);
  One sine, cosine;
  simd::SinCosOfTurns(One::Splat(table.phase_turns), sine, cosine);
  table.at_zero = law.amplitude * sine[0];
  return table;
}

}  // namespace

void LayOutMotions(Tables& t) {
  t.motion_of_body.assign(static_cast<std::size_t>(t.body_count), -1);
  for (const MotionDef& def : t.def().motions) {
    MotionTable table;
    table.body = def.body;
    Put(def.direction, table.direction), Put(def.axis, table.axis);
    Put(def.center_m, table.center);
    Put(t.def().bodies[static_cast<std::size_t>(def.body)].com_m - def.center_m, table.arm);
    table.slide = LayOut(def.slide, t.motion_knots);
    table.turn = LayOut(def.turn, t.motion_knots);
    t.motion_of_body[static_cast<std::size_t>(def.body)] = static_cast<int>(t.motions.size());
    t.motions.push_back(table);
  }
}

MotionSample SampleMotion(const View& m, int motion, double time_s) noexcept {
  const Motion<One> at = MotionAt(m, m.motions[motion], One::Splat(time_s));
  return {at.slide.x[0], at.slide.rate[0],
          at.turn.x[0],  at.turn.rate[0],
          Get(at.pos),   Get(at.v),
          Get(at.w),     {at.quat.w[0], at.quat.x[0], at.quat.y[0], at.quat.z[0]}};
}

}  // namespace taut::sim

namespace taut {

void WorldBatch::Impl::PlaceMotions(int world) noexcept {
  for (int i = 0; i < view.motion_count; ++i) {
    const int body = view.motions[i].body;
    const sim::MotionSample now = sim::SampleMotion(view, i, at(world, layout.time));
    set(world, layout.pos + 3 * body, now.position_m);
    set(world, layout.quat + 4 * body, now.orientation);
    set(world, layout.vel + 3 * body, now.velocity_m_per_s);
  }
  if (view.motion_count > 0) Moved(world);
}

MotionState WorldBatch::Motion(int world, int motion) const noexcept {
  const Impl& d = *impl_;
  d.CheckWorld(__func__, world);
  sim::CheckIndex(__func__, "motion", motion, d.view.motion_count);
  const sim::MotionSample now = sim::SampleMotion(d.view, motion, Time(world));
  return {now.slide_m,
          now.slide_rate,
          now.turn_rad,
          now.turn_rate,
          d.vec(world, d.layout.motion_force + 3 * motion),
          d.vec(world, d.layout.motion_torque + 3 * motion),
          d.at(world, d.layout.motion_work + motion)};
}

}  // namespace taut
