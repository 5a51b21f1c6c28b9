// Static equilibria of an experiment at its set points or under its load cases.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/assert.h"
#include "identify/computed.h"
#include "math/vec.h"

namespace taut::identify {
namespace {

/// Interpolates linearly between points; constant before the first and after the last point.
double At(const std::vector<std::pair<double, double>>& course, double time_s) {
  const auto after = std::upper_bound(
      course.begin(), course.end(), time_s,
      [](double t, const std::pair<double, double>& point) { return t < point.first; });
  if (after == course.begin()) return course.front().second;
  if (after == course.end()) return course.back().second;
  const auto before = after - 1;
  const double share = (time_s - before->first) / (after->first - before->first);
  return before->second + share * (after->second - before->second);
}

/// Sets loads and rest lengths at a time. Rest lengths without a program remain unchanged.
void SetMoment(const ExperimentSpec& experiment, double time_s, std::vector<double>& rest_lengths_m,
               LoadCaseSpec& loads) {
  for (const ControllerSpec& controller : experiment.controllers) {
    for (const PositionProgram& program : controller.position) {
      rest_lengths_m[static_cast<std::size_t>(program.cable)] = At(program.rest_length_m, time_s);
    }
  }
  loads.forces.clear();
  for (const PushSpec& push : experiment.pushes) {
    const auto& course = push.force_n;
    const bool acts = time_s >= course.front().first && time_s <= course.back().first;
    const double force_n = acts ? push.scale * At(course, time_s) : 0.0;
    if (force_n != 0) loads.forces.push_back({push.node, force_n * push.direction});
  }
}

void Put(const Vec3& v, std::vector<double>& out) {
  out.push_back(v.x), out.push_back(v.y), out.push_back(v.z);
}

/// Returns the values of all channels, in the order of `RestChannels`.
std::vector<double> Values(const ModelDef& def, const Equilibrium& rest) {
  std::vector<double> out;
  for (const BodyState& body : rest.pose.bodies) {
    Put(body.position_m, out);
    const Quat& q = body.orientation;
    out.insert(out.end(), {q.w, q.x, q.y, q.z});
    Put(TurnOf(q), out);
  }
  for (const NodeDef& node : def.nodes) {
    if (node.body == kWorld) {
      Put(node.position_m, out);
      continue;
    }
    const auto b = static_cast<std::size_t>(node.body);
    const BodyState& body = rest.pose.bodies[b];
    Put(body.position_m + Rotate(body.orientation, node.position_m - def.bodies[b].com_m), out);
  }
  for (std::size_t i = 0; i < def.cables.size(); ++i) {
    const double tension_n = rest.cable_tension_n[i];
    out.insert(out.end(), {tension_n, tension_n, rest.pose.rest_lengths_m[i]});
  }
  for (std::size_t i = 0; i < def.joints.size(); ++i) {
    Put(rest.joint_loads[i].force_n, out);
    Put(rest.joint_loads[i].torque_n_m, out);
    out.push_back(rest.bar_force_n[i]);
  }
  return out;
}

/// Selects the requested channels from `Values`.
class Picker {
 public:
  Picker(const ExperimentSpec& experiment, const std::vector<std::string>& channels)
      : channels_(channels) {
    const std::vector<ChannelInfo> all = RestChannels(experiment);
    for (const std::string& channel : channels) {
      const auto at = std::find_if(all.begin(), all.end(),
                                   [&](const ChannelInfo& c) { return c.name == channel; });
      at_.push_back(static_cast<std::size_t>(at - all.begin()));
      if (at == all.end()) missing = channel;
    }
  }
  void Add(const std::vector<double>& values, Computed& out) const {
    out.values.resize(channels_.size());
    for (std::size_t i = 0; i < at_.size(); ++i) {
      TAUT_ASSERT(at_[i] < values.size());
      out.values[i].push_back(values[at_[i]]);
    }
  }
  std::string missing;  ///< Name of an unknown channel; empty if there is none.

 private:
  const std::vector<std::string>& channels_;
  std::vector<std::size_t> at_;
};

}  // namespace

std::vector<ChannelInfo> RestChannels(const ExperimentSpec& experiment) {
  const ModelDef& def = experiment.robot.def;
  std::vector<ChannelInfo> out;
  const auto add = [&](const std::string& whose, std::initializer_list<ChannelInfo> channels) {
    for (const ChannelInfo& c : channels) out.push_back({whose + c.name, c.unit});
  };
  for (const BodyDef& body : def.bodies) {
    add("body/" + body.name + "/", {{"position_x_m", "m"},
                                    {"position_y_m", "m"},
                                    {"position_z_m", "m"},
                                    {"orientation_w", "1"},
                                    {"orientation_x", "1"},
                                    {"orientation_y", "1"},
                                    {"orientation_z", "1"},
                                    {"rotation_x_rad", "rad"},
                                    {"rotation_y_rad", "rad"},
                                    {"rotation_z_rad", "rad"}});
  }
  for (const NodeDef& node : def.nodes) {
    add("node/" + node.name + "/",
        {{"position_x_m", "m"}, {"position_y_m", "m"}, {"position_z_m", "m"}});
  }
  for (const CableDef& cable : def.cables) {
    add("cable/" + cable.name + "/",
        {{"tension_n", "N"}, {"elastic_n", "N"}, {"rest_length_m", "m"}});
  }
  for (const JointDef& joint : def.joints) {
    add("joint/" + joint.name + "/", {{"force_x_n", "N"},
                                      {"force_y_n", "N"},
                                      {"force_z_n", "N"},
                                      {"torque_x_n_m", "N m"},
                                      {"torque_y_n_m", "N m"},
                                      {"torque_z_n_m", "N m"},
                                      {"axial_n", "N"}});
  }
  return out;
}

std::string WhyNoRest(const ExperimentSpec& experiment) {
  for (const ControllerSpec& controller : experiment.controllers) {
    if (controller.impedance || GaitInputOf(controller)) {
      return "controller " + controller.name + " is not a program of rest lengths";
    }
  }
  if (!experiment.drags.empty()) return "it has drags, which never come to rest";
  if (!experiment.robot.def.motions.empty()) return "it has kinematic bodies";
  return {};
}

std::string EachRest(const ExperimentSpec& experiment, FitForward forward,
                     const std::vector<double>& moments_s, const RestTaker& take) {
  const ModelDef& def = experiment.robot.def;
  EquilibriumOptions options;
  std::string why;
  const auto go_on = [&](double time, const std::string& what, const LoadCaseSpec& loads) {
    const Equilibrium rest = FindEquilibrium(def, loads, options);
    if (!rest.found) why = "no equilibrium " + what + ": " + rest.why;
    options.from = rest.pose;
    return rest.found && take(time, loads, rest);
  };
  if (forward == FitForward::kLoadCases) {
    double number = 0;
    for (const LoadCaseSpec& loads : experiment.load_cases) {
      if (options.from) {  // do not use rest lengths of the previous case
        for (std::size_t i = 0; i < def.cables.size(); ++i) {
          options.from->rest_lengths_m[i] = def.cables[i].rest_length_m;
        }
      }
      if (!go_on(++number, "under load case " + loads.name, loads)) break;
    }
    return why;
  }
  Pose pose;
  for (const BodyDef& body : def.bodies) pose.bodies.push_back({body.com_m, {}, {}, {}});
  for (const CableDef& cable : def.cables) pose.rest_lengths_m.push_back(cable.rest_length_m);
  options.from = pose;
  LoadCaseSpec loads;
  for (const double time_s : moments_s) {
    SetMoment(experiment, time_s, options.from->rest_lengths_m, loads);
    if (!go_on(time_s, "at the set point of " + fmt::format("{:g}", time_s) + " s", loads)) break;
  }
  return why;
}

Computed Rest(const ExperimentSpec& experiment, FitForward forward,
              const std::vector<double>& moments_s, const std::vector<std::string>& channels,
              const std::atomic<bool>* stop) {
  Computed out;
  const Picker pick(experiment, channels);
  if (!pick.missing.empty()) {
    out.failed = "there is no channel " + pick.missing;
    return out;
  }
  out.failed = EachRest(experiment, forward, moments_s,
                        [&](double time, const LoadCaseSpec&, const Equilibrium& rest) {
                          pick.Add(Values(experiment.robot.def, rest), out);
                          out.time_s.push_back(time);
                          out.stopped = stop && *stop;
                          return !out.stopped;
                        });
  return out;
}

}  // namespace taut::identify
