// Tables of `taut check`.
#include "check_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "member_groups.h"
#include "table.h"
#include "taut/cable_scheme.h"
#include "taut/loads.h"
#include "taut/run.h"

namespace taut::cli {
namespace {

constexpr int kMostCollisions = 20;  ///< A longer list of possible collisions is omitted.

std::string ActuatorText(const ActuatorDef& actuator) {
  if (actuator.kind == ActuatorDef::Kind::kNone) return "-";
  if (actuator.kind == ActuatorDef::Kind::kIdeal) return "ideal";
  if (actuator.kind == ActuatorDef::Kind::kDcMotor) {
    const DcMotorDef& motor = *actuator.dc_motor;
    return fmt::format("dc_motor {:g} V {:g}:1 {:g} mm", motor.supply_voltage_v, motor.gear_ratio,
                       1e3 * motor.spool_radius_m);
  }
  std::string text;
  if (std::isfinite(actuator.max_speed_m_per_s))
    text += fmt::format("{:g} m/s ", actuator.max_speed_m_per_s);
  if (std::isfinite(actuator.max_acceleration_m_per_s2)) {
    text += fmt::format("{:g} m/s^2 ", actuator.max_acceleration_m_per_s2);
  }
  if (std::isfinite(actuator.max_force_n)) text += fmt::format("{:g} N ", actuator.max_force_n);
  return text.empty() ? "limited" : text.substr(0, text.size() - 1);
}

int Total(const std::vector<ShapeCount>& shapes) {
  int total = 0;
  for (const ShapeCount& of_kind : shapes) total += of_kind.count;
  return total;
}

std::string ShapeText(const std::vector<ShapeCount>& shapes) {
  std::string text;
  for (const auto& [name, count] : shapes) {
    if (count == 0) continue;
    text +=
        fmt::format("{}{} {}", text.empty() ? "" : ", ", count, count == 1 ? name.one : name.many);
  }
  return text.empty() ? "-" : text;
}

std::string Bodies(const ModelDef& def) {
  Table table(
      {"body", "mass", "center x", "y", "z", "principal inertia 1", "2", "3", "colliding shapes"});
  table.Add({"", "kg", "m", "m", "m", "kg m^2", "kg m^2", "kg m^2", ""});
  const auto shapes = CollidingShapes(def);
  for (std::size_t i = 0; i < def.bodies.size(); ++i) {
    const BodyDef& body = def.bodies[i];
    const Vec3 moments = PrincipalMoments(body.inertia_kg_m2);
    const auto moment = [&](double m) {
      return body.fixed ? std::string("-") : fmt::format("{:.6g}", m);
    };
    table.Add({body.name + (body.fixed ? " (fixed)" : ""), Fixed(body.mass_kg, 6),
               Fixed(body.com_m.x, 6), Fixed(body.com_m.y, 6), Fixed(body.com_m.z, 6),
               moment(moments.x), moment(moments.y), moment(moments.z), ShapeText(shapes[i])});
  }
  return table.Text();
}

std::string Cables(const ModelDef& def) {
  Table table(
      {"cable", "length", "rest length", "tension", "stiffness", "damping", "path", "actuator"});
  table.Add({"", "m", "m", "N", "N/m", "N s/m", "", ""});
  for (const CableDef& cable : def.cables) {
    std::string path;
    for (const AttachmentDef& at : cable.attachments) {
      path +=
          (path.empty() ? "" : " - ") + (at.body == kWorld ? "world" : def.bodies[at.body].name);
    }
    table.Add({cable.name, Fixed(CableLength(cable), 6), Fixed(cable.rest_length_m, 6),
               Fixed(CableTension(cable), 3), fmt::format("{:g}", cable.stiffness_n_per_m),
               fmt::format("{:g}", cable.damping_n_s_per_m), path, ActuatorText(cable.actuator)});
  }
  return table.Text();
}

std::string Loads(const ModelDef& def) {
  Table table(
      {"body", "cable force x", "y", "z", "cable torque x", "y", "z", "weight x", "y", "z"});
  table.Add({"", "N", "N", "N", "N m", "N m", "N m", "N", "N", "N"});
  const std::vector<BodyLoad> loads = StartLoads(def);
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const BodyLoad& load = loads[i];
    const Vec3 f = load.cable_force_n, t = load.cable_torque_n_m, w = load.weight_n;
    table.Add({def.bodies[i].name, Fixed(f.x, 3), Fixed(f.y, 3), Fixed(f.z, 3), Fixed(t.x, 4),
               Fixed(t.y, 4), Fixed(t.z, 4), Fixed(w.x, 3), Fixed(w.y, 3), Fixed(w.z, 3)});
  }
  return table.Text();
}

/// Formats the loads of the joints and the net forces and torques that remain on the bodies.
std::string Joints(const ModelDef& def) {
  const auto name = [&](int body) { return body == kWorld ? "world" : def.bodies[body].name; };
  const std::vector<JointLoad> loads = StartJointLoads(def);
  if (loads.empty()) {
    return fmt::format(
        "  Joint loads are not computed: the joints constrain more than {} directions.\n",
        kMostHeldDirections);
  }
  Table joints({"joint", "kind", "between", "force x", "y", "z", "torque x", "y", "z"});
  joints.Add({"", "", "", "N", "N", "N", "N m", "N m", "N m"});
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const JointDef& joint = def.joints[i];
    const Vec3 f = loads[i].force_n, t = loads[i].torque_n_m;
    joints.Add({joint.name, JointKindName(joint.kind),
                name(joint.body_a) + " - " + name(joint.body_b), Fixed(f.x, 3), Fixed(f.y, 3),
                Fixed(f.z, 3), Fixed(t.x, 4), Fixed(t.y, 4), Fixed(t.z, 4)});
  }
  Table left({"body", "net force x", "y", "z", "net torque x", "y", "z"});
  left.Add({"", "N", "N", "N", "N m", "N m", "N m"});
  const std::vector<LeftLoad> rest = LeftAtStart(def, loads);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const Vec3 f = rest[i].force_n, t = rest[i].torque_n_m;
    left.Add({def.bodies[i].name, Fixed(f.x, 3), Fixed(f.y, 3), Fixed(f.z, 3), Fixed(t.x, 4),
              Fixed(t.y, 4), Fixed(t.z, 4)});
  }
  return joints.Text() + "\nNet loads of the bodies (cables, weight and joints)\n" + left.Text();
}

/// Formats the axial forces of rods and the forces that hold anchored bodies, if there are any.
std::string RodsAndAnchors(const ModelDef& def) {
  const std::vector<BodyForce> forces = StartForces(def, StartJointLoads(def));
  std::string text;
  const std::vector<StrutForce> struts = StrutForces(def, forces);
  if (!struts.empty()) {
    Table table({"rod", "middle", "min", "max"});
    table.Add({"", "N", "N", "N"});
    for (const StrutForce& strut : struts) {
      table.Add({def.bodies[strut.body].name, Fixed(strut.axial.middle_n, 3),
                 Fixed(strut.axial.least_n, 3), Fixed(strut.axial.greatest_n, 3)});
    }
    text += "\nAxial forces of the rods at the start, tension positive\n" + table.Text();
  }
  const std::vector<Reaction> anchors = AnchorReactions(def, forces);
  if (!anchors.empty()) {
    Table table({"anchor", "force x", "y", "z", "torque x", "y", "z"});
    table.Add({"", "N", "N", "N", "N m", "N m", "N m"});
    for (const Reaction& anchor : anchors) {
      const Vec3 f = anchor.force_n, t = anchor.torque_n_m;
      table.Add({def.bodies[anchor.body].name, Fixed(f.x, 3), Fixed(f.y, 3), Fixed(f.z, 3),
                 Fixed(t.x, 4), Fixed(t.y, 4), Fixed(t.z, 4)});
    }
    text += "\nReactions at anchored bodies at the start, weights included\n" + table.Text();
  }
  return text;
}

std::string Collisions(const ModelDef& def) {
  const auto shapes = CollidingShapes(def);
  const auto apart = KeptApart(def);
  Table table({"pair of bodies", "pairs of shapes"});
  long long pairs = 0, shape_pairs = 0;
  for (std::size_t a = 0; a < shapes.size(); ++a) {
    for (std::size_t b = a + 1; b < shapes.size(); ++b) {
      const long long count = static_cast<long long>(Total(shapes[a])) * Total(shapes[b]);
      if (count == 0 || (def.bodies[a].fixed && def.bodies[b].fixed)) continue;
      if (apart.count({static_cast<int>(a), static_cast<int>(b)}) > 0) continue;
      ++pairs;
      shape_pairs += count;
      if (pairs > kMostCollisions) continue;
      table.Add({def.bodies[a].name + " - " + def.bodies[b].name, fmt::format("{}", count)});
    }
  }
  const int terrain = static_cast<int>(def.planes.size() + def.terrain_boxes.size() +
                                       def.height_fields.size() + def.terrain_meshes.size());
  std::string text = fmt::format("Possible collisions: {} of bodies, {} of shapes; also with ",
                                 Counted(pairs, "pair"), Counted(shape_pairs, "pair"));
  text +=
      terrain == 0 ? "the terrain of an experiment\n" : Counted(terrain, "terrain surface") + "\n";
  if (pairs > 0 && pairs <= kMostCollisions) text += table.Text();
  return text;
}

}  // namespace

std::string RobotTables(const RobotSpec& robot) {
  const ModelDef& def = robot.def;
  const Vec3 g = def.gravity_m_per_s2;
  std::string text = fmt::format(
      "Model {}: {}, {}, {}; moving mass {:.6f} kg; gravity ({:g}, {:g}, {:g}) m/s^2\n", def.name,
      def.bodies.size() == 1 ? "1 body" : fmt::format("{} bodies", def.bodies.size()),
      Counted(def.cables.size(), "cable"), Counted(def.nodes.size(), "node"), TotalMass(def), g.x,
      g.y, g.z);
  if (!robot.parameters.empty()) {
    text += "Parameters:";
    for (const auto& [name, value] : robot.parameters) text += fmt::format(" {}={:g}", name, value);
    text += "\n";
  }
  if (!def.bodies.empty()) text += "\nBodies\n" + Bodies(def);
  if (!def.cables.empty()) text += "\nCables\n" + Cables(def);
  if (!def.cables.empty() || !def.joints.empty()) {
    text += "\nLoads of the bodies at the start\n" + Loads(def);
  }
  if (!def.joints.empty()) {
    text +=
        "\n"
        "Loads of the joints at the start, on the second body\n" +
        Joints(def);
  }
  text += RodsAndAnchors(def);
  return text + "\n" + Collisions(def);
}

CableIntegration IntegrationOf(const ExperimentSpec& experiment) {
  Diagnostics unused;  // no errors: the caller has already compiled the model
  const auto model = Model::CompileForExperiment(experiment.robot.def, unused);
  if (!model) return {};
  const double step_s = LongestStep(experiment);
  return {CableSchemes(*model, step_s), SubstepCount(*model, step_s)};
}

std::string ExperimentTables(const ExperimentSpec& experiment) {
  std::string text = fmt::format("Experiment {}: {:g} s in steps of {:g} s, {}\n", experiment.name,
                                 experiment.duration_s, LongestStep(experiment),
                                 Counted(experiment.controllers.size(), "controller"));
  const std::string schemes = SchemesLine(experiment);
  if (!schemes.empty()) text += schemes + "\n";
  const std::vector<NodeDef>& nodes = experiment.robot.def.nodes;
  Table table({"kind", "name", "target", "time"});
  for (const ControllerSpec& controller : experiment.controllers) {
    const std::size_t cables =
        controller.impedance ? controller.impedance->cables.size() : controller.position.size();
    table.Add({controller.impedance ? "impedance controller" : "position controller",
               controller.name, fmt::format("{} cables", cables),
               fmt::format("every {:g} s", controller.clock.period_s)});
  }
  for (const PushSpec& push : experiment.pushes) {
    const std::string when =
        push.force_n.empty()
            ? std::string()
            : fmt::format("{:g} to {:g} s", push.force_n.front().first, push.force_n.back().first);
    table.Add({"push", push.name, nodes[push.node].name, when});
  }
  for (const DragSpec& drag : experiment.drags) {
    table.Add({"drag", drag.name, nodes[drag.node].name,
               fmt::format("{:g} to {:g} s", drag.from_s, drag.to_s)});
  }
  for (const PhaseSpec& phase : experiment.phases) {
    table.Add({"phase", phase.name, "", fmt::format("{:g} to {:g} s", phase.from_s, phase.to_s)});
  }
  text += table.Text();
  if (experiment.environment) text += EnvironmentLine(experiment) + "\n";
  return text;
}

}  // namespace taut::cli
