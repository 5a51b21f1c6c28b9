#include "joined_robots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "taut/shape_kinds.h"

namespace taut::viewer {
namespace {

Vec3 Plus(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
double Dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
bool Same(const Vec3& a, const Vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
bool Same(const Quat& a, const Quat& b) {
  return a.w == b.w && a.x == b.x && a.y == b.y && a.z == b.z;
}

/// Returns whether two half spaces have the same surface.
bool Same(const PlaneDef& a, const PlaneDef& b) {
  return Same(a.normal, b.normal) &&
         std::abs(Dot(a.normal, a.point_m) - Dot(b.normal, b.point_m)) < 1e-12;
}

bool Same(const TerrainBoxDef& a, const TerrainBoxDef& b) {
  return Same(a.center_m, b.center_m) && Same(a.orientation, b.orientation) &&
         Same(a.half_extents_m, b.half_extents_m);
}

bool Same(const HeightFieldDef& a, const HeightFieldDef& b) {
  return a.columns == b.columns && a.cell_m == b.cell_m && a.split == b.split &&
         Same(a.origin_m, b.origin_m) && a.height_m == b.height_m;
}

bool Same(const TerrainMeshDef& a, const TerrainMeshDef& b) {
  return a.triangles == b.triangles &&
         std::equal(a.corners_m.begin(), a.corners_m.end(), b.corners_m.begin(), b.corners_m.end(),
                    [](const Vec3& p, const Vec3& q) { return Same(p, q); });
}

template <class T>
void AddUnlessThere(std::vector<T>& list, T part) {
  const auto is_same = [&](const T& other) { return Same(other, part); };
  if (std::none_of(list.begin(), list.end(), is_same)) list.push_back(std::move(part));
}

[[noreturn]] void Wrong(const std::string& what) {
  std::fputs(("taut::Page: " + what + "\n").c_str(), stderr);
  std::abort();
}

/// Checks that a list is empty or has one entry per element.
template <class T>
void CheckLength(const std::vector<T>& list, std::size_t wanted, const char* name, int robot) {
  if (list.empty() || list.size() == wanted) return;
  Wrong(
      fmt::format("{} of robot {} has {} entries, expected {}", name, robot, list.size(), wanted));
}

double At(const std::vector<double>& list, std::size_t place) {
  return list.empty() ? Frame::kUnknown : list[place];
}

}  // namespace

int JoinedRobots::Add(const ModelDef& robot, const std::string& name, const Vec3& at_m) {
  const std::string prefix = name.empty() ? "" : name + "/";
  const int first_body = static_cast<int>(joined_.bodies.size());
  robots_.push_back({at_m, robot, static_cast<int>(joined_.nodes.size()), {}});
  const auto moved = [&](int body) { return body == kWorld ? kWorld : body + first_body; };
  for (BodyDef body : robot.bodies) {
    body.name = prefix + body.name;
    body.com_m = Plus(body.com_m, at_m);
    joined_.bodies.push_back(std::move(body));
  }
  const auto add_shapes = [&](const ShapeName&, const auto& shapes, auto& joined) {
    for (auto shape : shapes) {
      shape.name = prefix + shape.name;
      shape.body = moved(shape.body);
      EachPoint(shape, [&](Vec3& point_m) { point_m = Plus(point_m, at_m); });
      joined.push_back(std::move(shape));
    }
  };
  EachShapeList(add_shapes, robot, joined_);
  for (NodeDef node : robot.nodes) {
    node.name = prefix + node.name;
    node.body = moved(node.body);
    node.position_m = Plus(node.position_m, at_m);
    joined_.nodes.push_back(std::move(node));
  }
  for (CableDef cable : robot.cables) {
    cable.name = prefix + cable.name;
    for (AttachmentDef& at : cable.attachments) {
      at.body = moved(at.body);
      at.position_m = Plus(at.position_m, at_m);
    }
    joined_.cables.push_back(std::move(cable));
  }
  for (JointDef joint : robot.joints) {
    joint.name = prefix + joint.name;
    joint.body_a = moved(joint.body_a), joint.body_b = moved(joint.body_b);
    joint.from_m = Plus(joint.from_m, at_m), joint.to_m = Plus(joint.to_m, at_m);
    joined_.joints.push_back(std::move(joint));
  }
  AddTerrain(robot, prefix, at_m);
  return static_cast<int>(robots_.size()) - 1;
}

void JoinedRobots::AddTerrain(const ModelDef& robot, const std::string& prefix, const Vec3& at_m) {
  for (PlaneDef plane : robot.planes) {
    plane.name = prefix + plane.name;
    plane.point_m = Plus(plane.point_m, at_m);
    AddUnlessThere(joined_.planes, std::move(plane));
  }
  for (TerrainBoxDef box : robot.terrain_boxes) {
    box.name = prefix + box.name;
    box.center_m = Plus(box.center_m, at_m);
    AddUnlessThere(joined_.terrain_boxes, std::move(box));
  }
  for (HeightFieldDef field : robot.height_fields) {
    field.name = prefix + field.name;
    field.origin_m = Plus(field.origin_m, at_m);
    AddUnlessThere(joined_.height_fields, std::move(field));
  }
  for (TerrainMeshDef mesh : robot.terrain_meshes) {
    mesh.name = prefix + mesh.name;
    for (Vec3& corner : mesh.corners_m) corner = Plus(corner, at_m);
    AddUnlessThere(joined_.terrain_meshes, std::move(mesh));
  }
}

void JoinedRobots::Set(int robot, const RobotMoment& moment) {
  if (robot < 0 || robot >= static_cast<int>(robots_.size())) {
    Wrong(fmt::format("there is no robot {} (the page has {})", robot, robots_.size()));
  }
  Robot& own = robots_[static_cast<std::size_t>(robot)];
  const std::size_t cables = own.def.cables.size();
  CheckLength(moment.bodies, own.def.bodies.size(), "bodies", robot);
  CheckLength(moment.tension_n, cables, "tension_n", robot);
  CheckLength(moment.length_m, cables, "length_m", robot);
  CheckLength(moment.rest_length_m, cables, "rest_length_m", robot);
  CheckLength(moment.set_point_n, cables, "set_point_n", robot);
  CheckLength(moment.bends_m, cables, "bends_m", robot);
  CheckLength(moment.span_tension_n, cables, "span_tension_n", robot);
  CheckLength(moment.node_force_n, own.def.nodes.size(), "node_force_n", robot);
  own.moment = moment;
}

std::vector<bool> JoinedRobots::HasSetPoint() const {
  std::vector<bool> has;
  for (const Robot& robot : robots_) {
    has.resize(has.size() + robot.def.cables.size(), !robot.moment.set_point_n.empty());
  }
  return has;
}

void JoinedRobots::FillCables(const Robot& robot, Frame& frame) const {
  const RobotMoment& now = robot.moment;
  for (std::size_t c = 0; c < robot.def.cables.size(); ++c) {
    for (std::size_t i = 0; !now.bends_m.empty() && i < now.bends_m[c].size(); ++i) {
      frame.bends.push_back(
          {static_cast<int>(frame.cables.size()), Plus(now.bends_m[c][i], robot.at_m)});
    }
    for (std::size_t i = 0; !now.span_tension_n.empty() && i < now.span_tension_n[c].size(); ++i) {
      frame.spans.push_back({static_cast<int>(frame.cables.size()), now.span_tension_n[c][i]});
    }
    frame.cables.push_back({At(now.tension_n, c), At(now.length_m, c), At(now.rest_length_m, c),
                            At(now.set_point_n, c)});
  }
}

void JoinedRobots::Fill(Frame& frame) const {
  frame.bodies.clear();
  frame.cables.clear();
  frame.bends.clear();
  frame.spans.clear();
  frame.contacts.clear();
  frame.pushes.clear();
  frame.energy = {};
  for (const Robot& robot : robots_) {
    const RobotMoment& now = robot.moment;
    for (std::size_t b = 0; b < robot.def.bodies.size(); ++b) {
      const Vec3& described_m = robot.def.bodies[b].com_m;
      frame.bodies.push_back(
          {Plus(now.bodies.empty() ? described_m : now.bodies[b].position_m, robot.at_m),
           now.bodies.empty() ? Quat{} : now.bodies[b].orientation});
    }
    FillCables(robot, frame);
    frame.energy.kinetic_j += now.energy.kinetic_j;
    frame.energy.gravity_j += now.energy.gravity_j;
    frame.energy.elastic_j += now.energy.elastic_j;
    for (const ContactState& contact : now.contacts) {
      frame.contacts.push_back({Plus(contact.point_m, robot.at_m), contact.force_n});
    }
    for (std::size_t n = 0; n < now.node_force_n.size(); ++n) {
      const Vec3& force_n = now.node_force_n[n];
      if (!Same(force_n, {}))
        frame.pushes.push_back({robot.first_node + static_cast<int>(n), force_n});
    }
  }
  frame.contact_count = static_cast<double>(frame.contacts.size());
}

}  // namespace taut::viewer
