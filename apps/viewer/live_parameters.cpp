#include "live_parameters.h"

#include <algorithm>
#include <cmath>

#include "taut/trace.h"

namespace taut::viewer {

NamedValues ParametersOfFiles(const ExperimentSpec& experiment) {
  NamedValues named = experiment.robot.parameters;
  named.insert(experiment.parameters.begin(), experiment.parameters.end());
  return named;
}

std::vector<LiveParameter> Parameters(const LiveRun& run, const ExperimentSpec& experiment,
                                      const NamedValues& given) {
  std::vector<LiveParameter> all;
  const auto now = [&](std::string name, const char* unit, Parameter kind, int index, double min,
                       double max) {
    const double value = run.GetParameter(kind, index);
    all.push_back({std::move(name), unit, value, min, max, false, kind, index});
  };
  const ModelDef& def = experiment.robot.def;
  now("friction_scale", "1", Parameter::kFrictionScale, 0, 0, 4);
  now("gravity_z_m_per_s2", "m/s^2", Parameter::kGravityZ, 0, -20, 20);
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    const double mass_kg = def.bodies[b].mass_kg;
    if (def.bodies[b].fixed) continue;
    now("body/" + def.bodies[b].name + "/mass_kg", "kg", Parameter::kBodyMass, static_cast<int>(b),
        mass_kg / 4, 4 * mass_kg);
  }
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    const CableDef& cable = def.cables[c];
    const int index = static_cast<int>(c);
    now("cable/" + cable.name + "/stiffness_n_per_m", "N/m", Parameter::kCableStiffness, index,
        cable.stiffness_n_per_m / 10, 10 * cable.stiffness_n_per_m);
    now("cable/" + cable.name + "/damping_n_s_per_m", "N s/m", Parameter::kCableDamping, index, 0,
        std::max(10.0, 10 * cable.damping_n_s_per_m));
  }
  for (const auto& [name, value] : ParametersOfFiles(experiment)) {
    const auto first = given.find(name);
    const double far = first == given.end() || first->second == 0 ? 1 : 4 * first->second;
    all.push_back({name, UnitOfName(name), value, std::min(0.0, far), std::max(0.0, far), true,
                   Parameter::kFrictionScale, 0});
  }
  return all;
}

std::optional<LiveParameter> FindParameter(const LiveRun& run, const ExperimentSpec& experiment,
                                           const NamedValues& given, const std::string& name) {
  for (LiveParameter& parameter : Parameters(run, experiment, given)) {
    if (parameter.name == name) return std::move(parameter);
  }
  return std::nullopt;
}

Json ParametersJson(const LiveRun& run, const ExperimentSpec& experiment,
                    const NamedValues& given) {
  Json json = Json::array();
  for (const LiveParameter& p : Parameters(run, experiment, given)) {
    json.push_back({{"name", p.name},
                    {"value", p.value},
                    {"unit", p.unit},
                    {"min", p.min},
                    {"max", p.max},
                    {"restarts", p.restarts}});
  }
  return json;
}

Json ControlsJson(const LiveRun& run) {
  Json json = Json::array();
  for (const LiveControl& control : run.Controls()) {
    const auto& cable = run.experiment().robot.def.cables[static_cast<std::size_t>(control.cable)];
    Json one = {{"cable", cable.name}, {"kind", control.impedance ? "impedance" : "rest_length"}};
    if (control.impedance) {
      one["tension_offset_n"] = control.impedance->tension_offset_n;
      one["length_offset_m"] = control.impedance->length_offset_m;
      one["position_gain_n_per_m"] = control.impedance->position_gain_n_per_m;
      one["velocity_gain_n_s_per_m"] = control.impedance->velocity_gain_n_s_per_m;
    } else {
      one["rest_length_m"] = control.rest_length_m;
    }
    json.push_back(std::move(one));
  }
  return json;
}

}  // namespace taut::viewer
