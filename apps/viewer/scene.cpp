#include "scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "taut/safety.h"
#include "taut/statics.h"

namespace taut::viewer {
namespace {

Vec3 Minus(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double Length(const Vec3& v) { return std::hypot(v.x, v.y, v.z); }

/// Converts a point in W at t = 0 to its body's frame.
Json InBody(const ModelDef& def, int body, const Vec3& point_m) {
  if (body == kWorld) return ToJson(point_m);
  return ToJson(Minus(point_m, def.bodies[static_cast<std::size_t>(body)].com_m));
}

Json Bodies(const ModelDef& def) {
  Json bodies = Json::array();
  for (const BodyDef& body : def.bodies) {
    bodies.push_back({{"name", body.name},
                      {"mass_kg", body.mass_kg},
                      {"fixed", body.fixed},
                      {"position_m", ToJson(body.com_m)},
                      {"orientation", ToJson(Quat{})},
                      {"shapes", Json::array()}});
  }
  const auto add = [&](int body, Json shape) {
    if (body != kWorld)
      bodies[static_cast<std::size_t>(body)]["shapes"].push_back(std::move(shape));
  };
  for (const CapsuleDef& rod : def.capsules) {
    Json one{{"kind", "rod"},
             {"name", rod.name},
             {"from_m", InBody(def, rod.body, rod.from_m)},
             {"to_m", InBody(def, rod.body, rod.to_m)},
             {"radius_m", rod.radius_m}};
    const double length_m = Length(Minus(rod.to_m, rod.from_m));
    const MemberLimits limits = LimitsOf(rod.member, MemberKind::kRod, length_m);
    if (limits.buckling_n) one["buckling_n"] = *limits.buckling_n;
    add(rod.body, std::move(one));
  }
  for (const SphereDef& sphere : def.spheres) {
    add(sphere.body, {{"kind", "sphere"},
                      {"name", sphere.name},
                      {"center_m", InBody(def, sphere.body, sphere.center_m)},
                      {"radius_m", sphere.radius_m}});
  }
  for (const BoxDef& box : def.boxes) {
    add(box.body, {{"kind", "box"},
                   {"name", box.name},
                   {"center_m", InBody(def, box.body, box.center_m)},
                   {"half_extents_m", ToJson(box.half_extents_m)},
                   {"orientation", ToJson(box.orientation)}});
  }
  for (const HullDef& hull : def.hulls) {
    Json corners = Json::array();
    for (const Vec3& corner : hull.corners_m) corners.push_back(InBody(def, hull.body, corner));
    add(hull.body, {{"kind", "hull"}, {"name", hull.name}, {"corners_m", corners}});
  }
  return bodies;
}

Json Cables(const RobotSpec& robot) {
  Json cables = Json::array();
  const ModelDef& def = robot.def;
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    const CableDef& cable = def.cables[c];
    Json attachments = Json::array();
    for (std::size_t i = 0; i < cable.attachments.size(); ++i) {
      const AttachmentDef& at = cable.attachments[i];
      Json one{{"body", at.body}, {"position_m", InBody(def, at.body, at.position_m)}};
      if (at.wheel) {
        one["wheel"] = {{"axis", ToJson(at.wheel->axis)},
                        {"radius_m", at.wheel->radius_m},
                        {"angle_rad", WheelStartAngle(cable, i)}};
      }
      if (at.friction > 0) one["parts"] = true;
      attachments.push_back(std::move(one));
    }
    cables.push_back({{"name", cable.name},
                      {"attachments", attachments},
                      {"stiffness_n_per_m", cable.stiffness_n_per_m},
                      {"actuated", cable.actuator.kind != ActuatorDef::Kind::kNone}});
    if (c < robot.cable_tags.size()) {
      Json tags = Json::array();
      for (const std::string& tag : robot.cable_tags[c]) {
        if (tag != cable.name) tags.push_back(tag);
      }
      cables.back()["tags"] = std::move(tags);
    }
    if (cable.touches != CableTouches::kNone) cables.back()["most_bends"] = CableDef::kMostBends;
    if (HasFriction(cable)) cables.back()["parted"] = true;
  }
  return cables;
}

/// Returns the pushes and drags, each from its first to its last force.
Json Actions(const ExperimentSpec& experiment) {
  const auto node = [&](int index) {
    return experiment.robot.def.nodes[static_cast<std::size_t>(index)].name;
  };
  Json actions = Json::array();
  for (const PushSpec& push : experiment.pushes) {
    double most_n = 0, from_s = 0, to_s = 0;
    bool acts = false;
    for (std::size_t i = 0; i < push.force_n.size(); ++i) {
      const auto [time_s, force_n] = push.force_n[i];
      if (force_n == 0) continue;
      most_n = std::max(most_n, std::abs(push.scale * force_n));
      // the force changes linearly from and to its neighbors
      if (!acts) from_s = push.force_n[i == 0 ? 0 : i - 1].first;
      to_s = i + 1 < push.force_n.size() ? push.force_n[i + 1].first
                                         : std::max(time_s, experiment.duration_s);
      acts = true;
    }
    if (!acts || most_n == 0) continue;
    actions.push_back(
        {{"kind", "push"},
         {"text", fmt::format("{}: up to {:.3g} N on {}", push.name, most_n, node(push.node))},
         {"from_s", from_s},
         {"to_s", to_s}});
  }
  for (const DragSpec& drag : experiment.drags) {
    actions.push_back({{"kind", "drag"},
                       {"text", fmt::format("{}: {} at {:.3g} m/s", drag.name, node(drag.node),
                                            Length(drag.velocity_m_per_s))},
                       {"from_s", drag.from_s},
                       {"to_s", drag.to_s}});
  }
  return actions;
}

Json Joints(const ModelDef& def) {
  Json joints = Json::array();
  for (const JointDef& joint : def.joints) {
    joints.push_back({{"name", joint.name},
                      {"kind", JointKindName(joint.kind)},
                      {"body_a", joint.body_a},
                      {"body_b", joint.body_b},
                      {"from_m", InBody(def, joint.body_a, joint.from_m)},
                      {"to_m", InBody(def, joint.body_b, joint.to_m)},
                      {"axis", ToJson(joint.axis)}});
  }
  return joints;
}

/// Limit of the corners drawn of a large height field.
constexpr int kMostCorners = 250'000;

void AddField(const HeightFieldDef& field, Json& terrain) {
  int step = 1;
  const auto kept = [&](int corners) { return (corners - 1) / step + 1; };
  while (static_cast<double>(kept(field.columns)) * kept(field.rows) > kMostCorners) ++step;
  const int columns = kept(field.columns), rows = kept(field.rows);
  Json corners = Json::array(), triangles = Json::array();
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int at = j * step * field.columns + i * step;
      corners.push_back(field.origin_m.x + (i * step - 0.5 * (field.columns - 1)) * field.cell_m);
      corners.push_back(field.origin_m.y + (j * step - 0.5 * (field.rows - 1)) * field.cell_m);
      corners.push_back(field.origin_m.z + field.height_m[static_cast<std::size_t>(at)]);
    }
  }
  const auto height = [&](int corner) {
    return corners[static_cast<std::size_t>(3 * corner + 2)].get<double>();
  };
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i + 1 < columns; ++i) {
      const int a = j * columns + i, b = a + 1, d = a + columns, c = d + 1;
      using Split = HeightFieldDef::Split;
      const bool shorter = std::fabs(height(c) - height(a)) <= std::fabs(height(d) - height(b));
      const bool rising = field.split == Split::kSame ||
                          (field.split == Split::kAlternating ? (i + j) * step % 2 == 0 : shorter);
      for (const int corner : {a, b, rising ? c : d, rising ? a : b, c, d}) {
        triangles.push_back(corner);
      }
    }
  }
  terrain.push_back({{"kind", "surface"},
                     {"name", field.name},
                     {"corners_m", std::move(corners)},
                     {"triangles", std::move(triangles)}});
}

void AddMesh(const TerrainMeshDef& mesh, Json& terrain) {
  Json corners = Json::array(), triangles = Json::array();
  for (const Vec3& p : mesh.corners_m) {
    for (const double x : {p.x, p.y, p.z}) corners.push_back(x);
  }
  for (const auto& triangle : mesh.triangles) {
    for (const int corner : triangle) triangles.push_back(corner);
  }
  terrain.push_back({{"kind", "surface"},
                     {"name", mesh.name},
                     {"corners_m", std::move(corners)},
                     {"triangles", std::move(triangles)}});
}

Json Terrain(const ModelDef& def) {
  Json terrain = Json::array();
  for (const PlaneDef& plane : def.planes) {
    terrain.push_back({{"kind", "plane"},
                       {"name", plane.name},
                       {"normal", ToJson(plane.normal)},
                       {"point_m", ToJson(plane.point_m)}});
  }
  for (const TerrainBoxDef& box : def.terrain_boxes) {
    terrain.push_back({{"kind", "box"},
                       {"name", box.name},
                       {"center_m", ToJson(box.center_m)},
                       {"half_extents_m", ToJson(box.half_extents_m)},
                       {"orientation", ToJson(box.orientation)}});
  }
  for (const HeightFieldDef& field : def.height_fields) AddField(field, terrain);
  for (const TerrainMeshDef& mesh : def.terrain_meshes) AddMesh(mesh, terrain);
  return terrain;
}

Json Empty() {
  Json scene;
  for (const char* key : {"bodies", "nodes", "cables", "joints", "terrain", "parameters",
                          "controls", "channels", "phases", "values", "compared"}) {
    scene[key] = Json::array();
  }
  scene["first_s"] = 0;
  scene["duration_s"] = 0;
  scene["drag_stiffness_n_per_m"] = 0;
  scene["contact_forces"] = false;
  return scene;
}

/// Returns "segment_0" for "body/segment_0/position_x_m"; empty for names of another form.
std::string Between(const std::string& name, const std::string& prefix, const std::string& suffix) {
  if (name.size() <= prefix.size() + suffix.size() || name.compare(0, prefix.size(), prefix) != 0 ||
      name.compare(name.size() - suffix.size(), suffix.size(), suffix) != 0) {
    return {};
  }
  return name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
}

}  // namespace

Json ToJson(const Vec3& v) { return {v.x, v.y, v.z}; }
Json ToJson(const Quat& q) { return {q.w, q.x, q.y, q.z}; }

Json ToJson(const std::vector<ChannelInfo>& channels) {
  Json json = Json::array();
  for (const ChannelInfo& channel : channels) {
    json.push_back({{"name", channel.name}, {"unit", channel.unit}});
  }
  return json;
}

Json SeriesJson(const std::string& channel, int source, const Series& series) {
  return {{"channel", channel},      {"source", source},      {"level", series.level},
          {"time_s", series.time_s}, {"first", series.first}, {"min", series.min},
          {"max", series.max}};
}

Json SceneOf(const ExperimentSpec& experiment) {
  const ModelDef& def = experiment.robot.def;
  Json scene = Empty();
  scene["bodies"] = Bodies(def);
  for (const NodeDef& node : def.nodes) {
    scene["nodes"].push_back({{"name", node.name},
                              {"body", node.body},
                              {"position_m", InBody(def, node.body, node.position_m)}});
  }
  scene["cables"] = Cables(experiment.robot);
  scene["joints"] = Joints(def);
  scene["terrain"] = Terrain(def);
  for (const PhaseSpec& phase : experiment.phases) {
    scene["phases"].push_back(
        {{"name", phase.name}, {"from_s", phase.from_s}, {"to_s", phase.to_s}});
  }
  scene["actions"] = Actions(experiment);
  scene["duration_s"] = experiment.duration_s;
  return scene;
}

Json SceneOf(const Trace& trace) {
  constexpr double kRadiusM = 0.02;
  Json scene = Empty();
  std::vector<std::string> cables;
  for (const ChannelInfo& channel : trace.channels) {
    const std::string body = Between(channel.name, "body/", "/position_x_m");
    if (!body.empty()) {
      const Json center = ToJson(Vec3{});
      const Json ball = {
          {"kind", "sphere"}, {"name", body}, {"center_m", center}, {"radius_m", kRadiusM}};
      scene["bodies"].push_back({{"name", body},
                                 {"mass_kg", 0},
                                 {"fixed", false},
                                 {"position_m", center},
                                 {"orientation", ToJson(Quat{})},
                                 {"shapes", Json::array({ball})}});
    }
    for (const char* quantity : {"/tension_n", "/elastic_n", "/length_m", "/setpoint_n"}) {
      const std::string cable = Between(channel.name, "cable/", quantity);
      if (cable.empty() || std::find(cables.begin(), cables.end(), cable) != cables.end()) continue;
      cables.push_back(cable);
      scene["cables"].push_back({{"name", cable},
                                 {"attachments", Json::array()},
                                 {"stiffness_n_per_m", 0},
                                 {"actuated", false}});
    }
  }
  return scene;
}

std::string Dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace taut::viewer
