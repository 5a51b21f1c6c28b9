#include "linear/linear_equilibrium.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/vec.h"
#include "plant/find_start.h"
#include "plant/loop.h"
#include "sim/contacts/moving_pairs.h"

namespace taut::linear {
namespace {

constexpr double kAtRestMPerS = 1e-9;

/// Returns the experiment without its time-dependent parts. `remarks` receives a list of these
/// parts.
ExperimentSpec Unmoved(const ExperimentSpec& experiment, std::vector<std::string>& remarks) {
  ExperimentSpec e = experiment;
  if (!e.pushes.empty() || !e.drags.empty()) remarks.push_back("pushes and drags are left out");
  if (e.sensors) remarks.push_back("sensors are exact");
  e.pushes.clear(), e.drags.clear();
  e.sensors.reset();
  e.goal.reset();
  e.start_noise = {};
  for (ControllerSpec& c : e.controllers) {
    if (GaitInputOf(c) == nullptr) continue;
    remarks.push_back("controller " + c.name + ": its gait is left out");
    c.velocity_input.reset(), c.rest_length_input.reset();
  }
  return e;
}

/// Collects the cables under impedance control and the steps of one control period. Returns false
/// and sets `why` if the controllers have different periods or phases.
bool DescribeTick(const ExperimentSpec& e, Rest& rest) {
  double period_s = 0;
  for (const ControllerSpec& c : e.controllers) {
    if (!c.impedance) continue;
    if (period_s > 0 && std::fabs(c.clock.period_s - period_s) > 1e-12) {
      rest.why = "the controllers have different periods";
      rest.hint = "give all controllers the same period";
      return false;
    }
    period_s = c.clock.period_s;
    if (c.clock.phase_s != 0) {
      rest.why =
          "controller " + c.name + " does not begin at 0, but all ticks must be on one clock";
      rest.hint = "set its phase_s to 0";
      return false;
    }
    const ImpedanceSpec& spec = *c.impedance;
    control::ImpedanceLaw law;
    law.by_pid = spec.conversion == TensionConversion::kPid;
    law.differenced_rate = spec.differenced_rate;
    law.first_tick = false;
    law.proportional = spec.pid.proportional_m_per_s_n;
    law.integral = spec.pid.integral_m_per_s2_n;
    law.derivative = spec.pid.derivative_m_per_n;
    law.period_s = period_s;
    for (const ImpedanceGains& gains : spec.cables) {
      rest.driven.push_back({gains.cable, law, gains, c.name});
    }
  }
  if (period_s == 0) {
    rest.step_s = {e.step_s};
    return true;
  }
  // The number of steps follows the rule of simulations (plant/schedule.h).
  const double count = std::max(1.0, std::ceil(period_s / e.step_s - 1e-6));
  double step_s = period_s / count;
  if (std::fabs(step_s - e.step_s) < 1e-9 * e.step_s) step_s = e.step_s;
  rest.step_s.assign(static_cast<std::size_t>(count), step_s);
  return true;
}

double GreatestSpeed(const WorldBatch& batch) {
  double greatest = 0;
  const auto note = [&greatest](const Vec3& v) {
    greatest = std::max(greatest, std::sqrt(Dot(v, v)));
  };
  for (std::size_t n = 0; n < batch.model().def().nodes.size(); ++n) {
    note(batch.NodeVelocity(0, static_cast<int>(n)));
  }
  for (std::size_t b = 0; b < batch.model().def().bodies.size(); ++b) {
    note(batch.Body(0, static_cast<int>(b)).velocity_m_per_s);
  }
  return greatest;
}

double LastPoint(const ExperimentSpec& e) {
  double last_s = 0;
  for (const ControllerSpec& c : e.controllers) {
    for (const PositionProgram& p : c.position) {
      if (!p.rest_length_m.empty()) last_s = std::max(last_s, p.rest_length_m.back().first);
    }
  }
  return last_s;
}

/// Simulates whole ticks with the controllers until the robot has been at rest for kStillTicks.
bool RunToRest(const ExperimentSpec& e, const LinearOptions& options, Rest& rest) {
  constexpr int kStillTicks = 20;
  const auto plant = PlantOf(*rest.batch);
  plant::Loop loop(e, *plant);
  const double from_s = LastPoint(e);
  int still = 0;
  for (std::int64_t tick = 0; still < kStillTicks; ++tick) {
    if (options.go_on && tick % 64 == 0 && !options.go_on()) {
      rest.why = "the computation was interrupted";
      return false;
    }
    for (std::size_t i = 0; i < rest.step_s.size(); ++i) loop.Step();
    if (!loop.IsRunning()) {
      rest.why = "the simulation fails before the robot is at rest";
      rest.hint = "`taut run` reports the time and the cause";
      return false;
    }
    const bool rests = loop.time_s() > from_s && GreatestSpeed(*rest.batch) < kAtRestMPerS;
    still = rests ? still + 1 : 0;
    if (loop.time_s() > from_s + options.most_s) {
      rest.why =
          fmt::format("the robot does not come to rest within {:g} s: its speed is then {:.2g} m/s",
                      options.most_s, GreatestSpeed(*rest.batch));
      rest.hint =
          "if it trembles, reduce the velocity gain, the period or the step; if it swings, "
          "increase damping";
      return false;
    }
  }
  return true;
}

/// Sets rest lengths to the last values of their programs.
void WindToTheEnd(const ExperimentSpec& e, WorldBatch& batch) {
  for (const ControllerSpec& c : e.controllers) {
    for (const PositionProgram& p : c.position) {
      if (p.rest_length_m.empty()) continue;
      batch.SetRestLength(0, p.cable, p.rest_length_m.back().second);
      batch.SetRestLengthTarget(0, p.cable, p.rest_length_m.back().second);
    }
  }
}

void Place(const Pose& pose, WorldBatch& batch) {
  for (std::size_t b = 0; b < pose.bodies.size(); ++b) {
    BodyState state = pose.bodies[b];
    state.velocity_m_per_s = state.angular_velocity_rad_per_s = {};
    batch.SetBodyState(0, static_cast<int>(b), state);
  }
  for (std::size_t c = 0; c < pose.rest_lengths_m.size(); ++c) {
    batch.SetRestLength(0, static_cast<int>(c), pose.rest_lengths_m[c]);
    batch.SetRestLengthTarget(0, static_cast<int>(c), pose.rest_lengths_m[c]);
  }
}

/// Rejects cables at the limit between taut and slack, where the two one-sided derivatives differ.
bool CheckKinks(Rest& rest) {
  constexpr double kShare = 1e-7;
  const std::vector<CableDef>& cables = rest.model->def().cables;
  for (std::size_t c = 0; c < cables.size(); ++c) {
    const CableState state = rest.batch->Cable(0, static_cast<int>(c));
    const double stretch_m = state.length_m - state.rest_length_m;
    if (std::fabs(stretch_m) < kShare * state.length_m) {
      rest.why = "cable " + cables[c].name + " is at the limit between taut and slack";
      rest.hint = "decrease its rest length to make it taut, or increase it to make it slack";
      return false;
    }
    if (stretch_m < 0) rest.remarks.push_back("cable " + cables[c].name + " is slack");
  }
  return true;
}

/// Returns the friction coefficient of a contact in the last step, by the contact's key
/// (sim/data/tables.h).
double FrictionOf(const sim::View& m, double key, bool slides) {
  const auto id = static_cast<std::uint32_t>(key);
  if (id < m.first_pair_id) {
    const sim::PointTable& point = m.points[static_cast<int>(id) / m.plane_count];
    const int plane = static_cast<int>(id) % m.plane_count;
    return (slides ? point.kinetic_friction : point.static_friction)[plane];
  }
  const sim::ShapePairTable pair = sim::PairOfKey(m, id);
  return slides ? pair.kinetic_friction : pair.static_friction;
}

/// Rejects contacts that slip or are about to slip, because the step has no derivative there.
bool CheckContacts(Rest& rest) {
  constexpr double kShare = 1e-3;
  const BatchInside::Impl& inside = BatchInside::Of(*rest.batch);
  const std::vector<ContactState> contacts = rest.batch->Contacts(0);
  const double scale = rest.batch->GetParameter(0, Parameter::kFrictionScale, 0);
  bool good = true;
  std::size_t number = 0;
  inside.ForEachContact(0, [&](int i) {
    const ContactState& c = contacts[number++];
    const double key = inside.at(0, inside.layout.contact_key + i);
    const bool slides = inside.at(0, inside.layout.contact_slip + i) > 0;
    const double most = scale * FrictionOf(inside.view, key, slides) * Dot(c.force_n, c.normal);
    const Vec3 along = c.force_n - Dot(c.force_n, c.normal) * c.normal;
    if (!good || Dot(c.force_n, c.force_n) == 0 || most == 0) return;
    if (std::sqrt(Dot(along, along)) < (1 - kShare) * most) return;
    const std::vector<BodyDef>& bodies = rest.model->def().bodies;
    rest.why = "body " + bodies[static_cast<std::size_t>(c.body_a)].name +
               " is at the limit of slipping: its friction force is the largest possible";
    rest.hint =
        "increase the friction of the body or the ground, or change the start, so that it sticks";
    good = false;
  });
  return good;
}

}  // namespace

Rest FindRest(const ExperimentSpec& experiment, const LinearOptions& options, Diagnostics& out) {
  Rest rest;
  const ExperimentSpec e = Unmoved(experiment, rest.remarks);
  if (!e.robot.def.motions.empty()) {
    rest.why = "the robot has kinematic bodies";
    rest.hint = "leave out their motion";
    return rest;
  }
  if (!DescribeTick(e, rest)) return rest;
  rest.model = Model::CompileForExperiment(e.robot.def, out);
  if (!rest.model) return rest;
  rest.batch = std::make_unique<WorldBatch>(rest.model, WorldBatchOptions{});
  bool found = false;
  if (options.at) {
    plant::ApplyScales(e.scales, *rest.batch, 0);
    Place(*options.at, *rest.batch);
  } else if (!plant::PrepareStart(e, *rest.batch, out, options.go_on)) {
    rest.batch.reset();
    return rest;
  }
  if (!rest.driven.empty()) {
    found = RunToRest(e, options, rest);
  } else {
    WindToTheEnd(e, *rest.batch);
    const double steps = std::min(1e9, options.most_s / e.step_s);
    found = Settle(*rest.batch, 0, e.step_s, options.go_on, static_cast<int>(steps));
    if (!found) {
      rest.why = "the robot does not settle to an equilibrium";
      rest.hint = "if it falls or rolls, add ground, supports or cables that hold it";
    }
  }
  if (!found || !CheckKinks(rest) || !CheckContacts(rest)) rest.batch.reset();
  return rest;
}

}  // namespace taut::linear
