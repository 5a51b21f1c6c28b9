// JSON output of `taut check`.
#include <nlohmann/json.hpp>

#include "check_report.h"
#include "json_values.h"
#include "taut/loads.h"
#include "taut/run.h"

namespace taut::cli {
namespace {

using Json = nlohmann::ordered_json;

Json BodiesJson(const ModelDef& def) {
  const std::vector<BodyLoad> loads = StartLoads(def);
  const std::vector<LeftLoad> left = LeftAtStart(def, StartJointLoads(def));
  const auto shapes = CollidingShapes(def);
  Json bodies = Json::array();
  for (std::size_t i = 0; i < def.bodies.size(); ++i) {
    const BodyDef& body = def.bodies[i];
    const Inertia& inertia = body.inertia_kg_m2;
    bodies.push_back({{"name", body.name},
                      {"fixed", body.fixed},
                      {"mass_kg", body.mass_kg},
                      {"com_m", ToJson(body.com_m)},
                      {"inertia_kg_m2",
                       {{"xx", inertia.xx},
                        {"yy", inertia.yy},
                        {"zz", inertia.zz},
                        {"xy", inertia.xy},
                        {"xz", inertia.xz},
                        {"yz", inertia.yz}}},
                      {"principal_inertia_kg_m2", ToJson(PrincipalMoments(inertia))},
                      {"cable_force_n", ToJson(loads[i].cable_force_n)},
                      {"cable_torque_n_m", ToJson(loads[i].cable_torque_n_m)},
                      {"weight_n", ToJson(loads[i].weight_n)},
                      {"left_force_n", ToJson(left[i].force_n)},
                      {"left_torque_n_m", ToJson(left[i].torque_n_m)}});
    for (const ShapeCount& of_kind : shapes[i]) {
      bodies.back()[std::string("colliding_") + of_kind.name.many] = of_kind.count;
    }
  }
  return bodies;
}

Json CablesJson(const RobotSpec& robot) {
  Json cables = Json::array();
  for (std::size_t i = 0; i < robot.def.cables.size(); ++i) {
    const CableDef& cable = robot.def.cables[i];
    Json attachments = Json::array();
    for (const AttachmentDef& at : cable.attachments) {
      attachments.push_back({{"body", at.body == kWorld ? "world" : robot.def.bodies[at.body].name},
                             {"position_m", ToJson(at.position_m)}});
    }
    cables.push_back({{"name", cable.name},
                      {"tags", robot.cable_tags[i]},
                      {"length_m", CableLength(cable)},
                      {"rest_length_m", cable.rest_length_m},
                      {"tension_n", CableTension(cable)},
                      {"stiffness_n_per_m", cable.stiffness_n_per_m},
                      {"damping_n_s_per_m", cable.damping_n_s_per_m},
                      {"attachments", std::move(attachments)}});
  }
  return cables;
}

Json JointsJson(const ModelDef& def) {
  const std::vector<JointLoad> loads = StartJointLoads(def);
  const auto name = [&](int body) { return body == kWorld ? "world" : def.bodies[body].name; };
  Json joints = Json::array();
  for (std::size_t i = 0; i < def.joints.size(); ++i) {
    const JointDef& joint = def.joints[i];
    joints.push_back({{"name", joint.name},
                      {"kind", JointKindName(joint.kind)},
                      {"body_a", name(joint.body_a)},
                      {"body_b", name(joint.body_b)},
                      {"position_m", ToJson(joint.to_m)},
                      {"force_n", loads.empty() ? Json() : ToJson(loads[i].force_n)},
                      {"torque_n_m", loads.empty() ? Json() : ToJson(loads[i].torque_n_m)}});
  }
  return joints;
}

Json RodsJson(const ModelDef& def, const std::vector<BodyForce>& forces) {
  Json rods = Json::array();
  for (const StrutForce& strut : StrutForces(def, forces)) {
    rods.push_back({{"body", def.bodies[static_cast<std::size_t>(strut.body)].name},
                    {"axial_n", strut.axial.middle_n},
                    {"axial_least_n", strut.axial.least_n},
                    {"axial_greatest_n", strut.axial.greatest_n}});
  }
  return rods;
}

Json AnchorsJson(const ModelDef& def, const std::vector<BodyForce>& forces) {
  Json anchors = Json::array();
  for (const Reaction& anchor : AnchorReactions(def, forces)) {
    anchors.push_back({{"body", def.bodies[static_cast<std::size_t>(anchor.body)].name},
                       {"force_n", ToJson(anchor.force_n)},
                       {"torque_n_m", ToJson(anchor.torque_n_m)}});
  }
  return anchors;
}

/// Converts diagnostics to JSON; `kind`: key for the text of each.
Json ToJson(const std::vector<Diagnostic>& found, const char* kind) {
  Json list = Json::array();
  for (const Diagnostic& d : Sorted(found)) {
    list.push_back({{"file", d.at.file},
                    {"line", d.at.line},
                    {"column", d.at.column},
                    {"id", d.id},
                    {kind, d.what},
                    {"hint", d.hint}});
  }
  return list;
}

/// Replaces invalid UTF-8: names may contain any bytes of the file.
std::string Dump(const Json& json) {
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

std::string CheckJson(const RobotSpec& robot, const ExperimentSpec* experiment,
                      const Diagnostics& found, const StartChange* settled) {
  Json nodes = Json::array();
  for (std::size_t i = 0; i < robot.def.nodes.size(); ++i) {
    const NodeDef& node = robot.def.nodes[i];
    nodes.push_back({{"name", node.name},
                     {"body", node.body == kWorld ? "world" : robot.def.bodies[node.body].name},
                     {"position_m", ToJson(node.position_m)},
                     {"tags", robot.node_tags[i]}});
  }
  Json json{{"ok", true}, {"name", robot.def.name}};
  json["warnings"] = ToJson(found.warnings(), "warning");
  if (experiment) {
    json["experiment"] = {{"name", experiment->name},
                          {"duration_s", experiment->duration_s},
                          {"step_s", LongestStep(*experiment)}};
    const CableIntegration integration = IntegrationOf(*experiment);
    for (const CableScheme scheme : integration.schemes) {
      json["experiment"]["cable_schemes"].push_back(CableSchemeName(scheme));
    }
    json["experiment"]["substeps"] = integration.substeps;
  }
  if (settled) {
    json["settled"] = {{"slack_cables", settled->slack_cables},
                       {"max_tension_n", settled->max_tension_n},
                       {"described_max_tension_n", settled->described_max_tension_n},
                       {"largest_displacement_m", settled->largest_displacement_m},
                       {"displaced_node", settled->displaced_node},
                       {"size_m", settled->size_m}};
  }
  json["files"] = experiment ? experiment->files : robot.files;
  json["parameters"] = robot.parameters;
  json["total_mass_kg"] = TotalMass(robot.def);
  json["gravity_m_per_s2"] = ToJson(robot.def.gravity_m_per_s2);
  json["bodies"] = BodiesJson(robot.def);
  json["cables"] = CablesJson(robot);
  if (!robot.def.joints.empty()) json["joints"] = JointsJson(robot.def);
  const std::vector<BodyForce> forces = StartForces(robot.def, StartJointLoads(robot.def));
  json["struts"] = RodsJson(robot.def, forces);
  json["anchors"] = AnchorsJson(robot.def, forces);
  json["nodes"] = std::move(nodes);
  return Dump(json);
}

std::string ErrorsJson(const std::string& path, const Diagnostics& found) {
  return Dump({{"ok", false},
               {"file", path},
               {"errors", ToJson(found.items(), "error")},
               {"warnings", ToJson(found.warnings(), "warning")}});
}

}  // namespace taut::cli
