#include "plant/statistics.h"

#include <algorithm>
#include <cmath>

#include "plant/schedule.h"

namespace taut::plant {
namespace {

/// End of the start-up phase, as in NTRT's figures.
constexpr double kStartIsOverS = 5.0;

/// Includes both ends, so that a phase includes the step that ends with it.
bool Within(double time_s, double from_s, double to_s) {
  return time_s >= from_s - kTimeToleranceS && time_s <= to_s + kTimeToleranceS;
}

}  // namespace

void Statistics::Sum::Take(double x, double step_s) {
  min = any ? std::min(min, x) : x;
  max = any ? std::max(max, x) : x;
  // The value at the start of a run has no weight, since no step ends there.
  if (step_s > 0) integral += x * step_s, time_s += step_s;
  any = true;
}

Range Statistics::Sum::range() const {
  if (!any) return {};
  return {time_s > 0 ? integral / time_s : min, min, max};
}

Statistics::Statistics(const ExperimentSpec& experiment)
    : experiment_(experiment),
      watch_(experiment.robot.def),
      forces_(experiment.robot.def),
      cables_(experiment.robot.def.cables.size()),
      drags_(experiment.drags.size()) {
  for (Cable& cable : cables_) {
    cable.tension.phases.resize(experiment.phases.size());
    cable.elastic.phases.resize(experiment.phases.size());
  }
  const ModelDef& def = experiment.robot.def;
  for (int b = 0; b < static_cast<int>(def.bodies.size()); ++b) {
    const BodyDef& body = def.bodies[static_cast<std::size_t>(b)];
    if (const auto strut = mechanics::StrutOf(def, b)) struts_.push_back({*strut, 0, 0});
    if (body.fixed) anchors_.push_back({b, body.mass_kg * def.gravity_m_per_s2, 0, 0});
  }
}

void Statistics::Take(Quantity& quantity, double time_s, double step_s, double force_n) const {
  quantity.max = std::max(quantity.max, force_n);
  if (time_s > kStartIsOverS)
    quantity.max_after_start = std::max(quantity.max_after_start, force_n);
  for (std::size_t p = 0; p < experiment_.phases.size(); ++p) {
    const PhaseSpec& phase = experiment_.phases[p];
    if (Within(time_s, phase.from_s, phase.to_s)) quantity.phases[p].Take(force_n, step_s);
  }
}

void Statistics::Take(std::optional<MotorSummary>& sum, const MotorState& motor) {
  if (!sum) sum.emplace();
  sum->energy_from_supply_j = motor.energy_from_supply_j;
  sum->energy_to_cable_j = motor.energy_to_cable_j;
  sum->energy_in_winding_j = motor.energy_in_winding_j;
  sum->max_current_a = std::max(sum->max_current_a, std::fabs(motor.current_a));
  sum->max_winding_temperature_c =
      std::max(sum->max_winding_temperature_c, motor.winding_temperature_c);
}

void Statistics::TakeLoads(const Observation& now, const World& world) {
  if (struts_.empty() && anchors_.empty()) return;
  const std::vector<BodyForce>& forces = forces_.Gather(now, world);
  for (StrutSum& sum : struts_) {
    const int body = sum.strut.body;
    const AxialForce axial =
        mechanics::AxialForceOf(sum.strut, world.BodyMass(0, body), MomentOf(world, body), forces);
    sum.least_n = has_loads_ ? std::min(sum.least_n, axial.least_n) : axial.least_n;
    sum.greatest_n = has_loads_ ? std::max(sum.greatest_n, axial.greatest_n) : axial.greatest_n;
  }
  for (AnchorSum& sum : anchors_) {
    const Reaction held =
        mechanics::ReactionOf(sum.body, world.Body(0, sum.body).position_m, sum.weight_n, forces);
    sum.max_force_n = std::max(sum.max_force_n, std::sqrt(Dot(held.force_n, held.force_n)));
    sum.max_torque_n_m =
        std::max(sum.max_torque_n_m, std::sqrt(Dot(held.torque_n_m, held.torque_n_m)));
  }
  has_loads_ = true;
}

void Statistics::Take(double time_s, double step_s, const Observation& now,
                      const std::vector<double>& drag_n, const World* world) {
  watch_.Take(time_s, now, world);
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    Cable& cable = cables_[c];
    const CableState r = now.Cable(static_cast<int>(c));
    Take(cable.tension, time_s, step_s, r.tension_n);
    Take(cable.elastic, time_s, step_s, r.elastic_n);
    const ActuatorDef::Kind kind = experiment_.robot.def.cables[c].actuator.kind;
    if (kind == ActuatorDef::Kind::kDcMotor && world != nullptr) {
      Take(cable.motor, world->Motor(0, static_cast<int>(c)));
    }
    if (kind != ActuatorDef::Kind::kNone) {
      cable.max_force_n = std::max(cable.max_force_n, r.tension_n);
      cable.since_s += step_s;
      const double wound_m = cable.rest_length_m - r.rest_length_m;
      // A real robot's rest length is constant between readings, so divide by the time since its
      // last change.
      const double over_s = world != nullptr ? step_s : cable.since_s;
      if (wound_m != 0) cable.since_s = 0;
      if (step_s > 0) {
        cable.max_speed = std::max(cable.max_speed, std::fabs(wound_m) / over_s);
        cable.max_power_w = std::max(cable.max_power_w, r.tension_n * wound_m / over_s);
        cable.energy_j += r.tension_n * std::max(wound_m, 0.0);
        cable.net_energy_j += r.tension_n * wound_m;
      }
    }
    cable.rest_length_m = r.rest_length_m;
  }
  for (std::size_t i = 0; i < drags_.size(); ++i) {
    const DragSpec& drag = experiment_.drags[i];
    if (Within(time_s, 0.5 * (drag.from_s + drag.to_s), drag.to_s))
      drags_[i].Take(drag_n[i], step_s);
  }
}

void Statistics::Fill(RunSummary& summary) const {
  summary.phases = experiment_.phases;
  summary.references = experiment_.references;
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    const Cable& cable = cables_[c];
    CableSummary out;
    out.name = experiment_.robot.def.cables[c].name;
    const auto copy = [](const Quantity& from, CableSummary::Quantity& to) {
      to.max_n = from.max;
      to.max_after_start_n = from.max_after_start;
      for (const Sum& sum : from.phases) to.phases.push_back(sum.range());
    };
    copy(cable.tension, out.tension);
    copy(cable.elastic, out.elastic);
    out.max_force_n = cable.max_force_n;
    out.max_speed_m_per_s = cable.max_speed;
    out.max_power_w = cable.max_power_w;
    out.energy_j = cable.energy_j;
    out.net_energy_j = cable.net_energy_j;
    out.motor = cable.motor;
    if (out.tension.max_n > summary.system_max_tension_n) {
      summary.system_max_tension_n = out.tension.max_n;
      summary.system_max_tension_cable = out.name;
    }
    summary.system_max_elastic_n = std::max(summary.system_max_elastic_n, out.elastic.max_n);
    summary.system_max_elastic_after_start_n =
        std::max(summary.system_max_elastic_after_start_n, out.elastic.max_after_start_n);
    summary.cables.push_back(std::move(out));
  }
  const auto name = [&](int body) {
    return experiment_.robot.def.bodies[static_cast<std::size_t>(body)].name;
  };
  for (const StrutSum& sum : struts_) {
    if (has_loads_) summary.struts.push_back({name(sum.strut.body), sum.least_n, sum.greatest_n});
  }
  for (const AnchorSum& sum : anchors_) {
    if (!has_loads_) continue;
    summary.anchors.push_back({name(sum.body), sum.max_force_n, sum.max_torque_n_m});
  }
  summary.overloads = watch_.Overloads();
  for (std::size_t i = 0; i < drags_.size(); ++i) {
    summary.drags.push_back({experiment_.drags[i].name, drags_[i].range()});
  }
}

}  // namespace taut::plant
