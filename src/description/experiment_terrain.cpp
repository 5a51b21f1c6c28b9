#include <algorithm>
#include <cmath>
#include <map>

#include "description/experiment_parts.h"
#include "description/material.h"
#include "math/elementary.h"
#include "math/vec.h"

namespace taut::description {
namespace {

std::vector<std::string> WithMaterialKeys(std::vector<std::string> keys) {
  keys.insert(keys.end(), kMaterialKeys.begin(), kMaterialKeys.end());
  return keys;
}

/// The surface's normal from its slope and the direction in which it rises.
Vec3 SlopeNormal(const MapReader& map) {
  const double slope = map.Number("slope_rad", Bound::kNonNegative);
  if (slope >= 0.5 * 3.14159265358979323846) {
    map.scope().out.Error(map.Find("slope_rad")->at,
                          "plane.slope_rad must be below pi / 2, got " + Shown(slope),
                          "give a `normal` instead");
  }
  const Value* direction = map.Require("slope_direction");
  if (!direction || !(slope <= math::kMaxAngle)) return {0, 0, 1};
  const Vec3 up = ReadDirection(*direction, map.Path("slope_direction"), map.scope());
  if (up.z != 0.0 && !std::isnan(up.z)) {
    map.scope().out.Error(direction->at, "plane.slope_direction must be horizontal",
                          "its last number must be 0");
  }
  return Vec3{0, 0, math::Cos(slope)} - math::Sin(slope) * up;
}

PlaneDef ReadPlane(const Value& value, const Scope& scope) {
  const MapReader map(
      value, "plane",
      WithMaterialKeys({"height_m", "point_m", "normal", "slope_rad", "slope_direction"}), scope);
  PlaneDef plane;
  const std::string how = map.ExactlyOne({"height_m", "normal", "slope_rad"});
  if (how == "height_m") {
    plane.point_m = {0, 0, map.Number("height_m", Bound::kAny)};
    if (map.Has("point_m")) {
      map.Error("point_m", "plane has both height_m and point_m", "only one of them may be there");
    }
  } else {
    plane.point_m = map.VectorOr("point_m", {});
  }
  if (how == "normal") plane.normal = ReadDirection(*map.Find("normal"), "plane.normal", scope);
  if (how == "slope_rad") plane.normal = SlopeNormal(map);
  if (map.Has("slope_direction") && !map.Has("slope_rad")) {
    map.Error("slope_direction", "plane.slope_direction needs slope_rad");
  }
  plane.material = ReadMaterial(map);
  return plane;
}

TerrainBoxDef ReadTerrainBox(const Value& value, const Scope& scope) {
  const MapReader map(value, "box", WithMaterialKeys({"center_m", "size_m", "rotate"}), scope);
  TerrainBoxDef box;
  box.center_m = map.Vector("center_m");
  const Vec3 size = map.Vector("size_m");
  if (size.x <= 0.0 || size.y <= 0.0 || size.z <= 0.0) {
    scope.out.Error(map.Find("size_m")->at, "box.size_m must be positive");
  }
  box.half_extents_m = 0.5 * size;
  if (const Value* rotate = map.Find("rotate")) {
    box.orientation = ReadRotation(*rotate, "box.rotate", scope);
  }
  box.material = ReadMaterial(map);
  return box;
}

Inertia Rotated(const Quat& q, const Inertia& inertia) {
  // The columns of R I R^T, one axis after the other.
  const Vec3 axes[] = {Rotate(Conjugate(q), {1, 0, 0}), Rotate(Conjugate(q), {0, 1, 0}),
                       Rotate(Conjugate(q), {0, 0, 1})};
  const auto product = [&](int a, int b) {
    const Vec3& u = axes[b];
    const Vec3 v{inertia.xx * u.x + inertia.xy * u.y + inertia.xz * u.z,
                 inertia.xy * u.x + inertia.yy * u.y + inertia.yz * u.z,
                 inertia.xz * u.x + inertia.yz * u.y + inertia.zz * u.z};
    return Dot(axes[a], v);
  };
  return {product(0, 0), product(1, 1), product(2, 2), product(0, 1), product(0, 2), product(1, 2)};
}

/// Turns the robot by `q` about the origin, then moves it by `at_m`.
void Move(const Vec3& at_m, const Quat& q, ModelDef& def) {
  const auto moved = [&](const Vec3& p) { return at_m + Rotate(q, p); };
  for (BodyDef& body : def.bodies) {
    body.com_m = moved(body.com_m);
    body.inertia_kg_m2 = Rotated(q, body.inertia_kg_m2);
    body.velocity_m_per_s = Rotate(q, body.velocity_m_per_s);
    body.angular_velocity_rad_per_s = Rotate(q, body.angular_velocity_rad_per_s);
  }
  for (SphereDef& sphere : def.spheres) sphere.center_m = moved(sphere.center_m);
  for (CapsuleDef& capsule : def.capsules) {
    capsule.from_m = moved(capsule.from_m);
    capsule.to_m = moved(capsule.to_m);
  }
  for (BoxDef& box : def.boxes) {
    box.center_m = moved(box.center_m);
    box.orientation = q * box.orientation;
  }
  for (NodeDef& node : def.nodes) node.position_m = moved(node.position_m);
  for (CableDef& cable : def.cables) {
    for (AttachmentDef& end : cable.attachments) end.position_m = moved(end.position_m);
  }
}

/// Adds a motion of the whole robot: of its centre of mass, and about it.
void AddVelocity(const Vec3& v, const Vec3& w, ModelDef& def) {
  Vec3 sum;
  double mass_kg = 0.0;
  for (const BodyDef& body : def.bodies) {
    if (body.fixed) continue;
    sum = sum + body.mass_kg * body.com_m;
    mass_kg += body.mass_kg;
  }
  if (!(mass_kg > 0.0)) return;
  const Vec3 com_m = (1.0 / mass_kg) * sum;
  for (BodyDef& body : def.bodies) {
    if (body.fixed) continue;
    body.velocity_m_per_s = body.velocity_m_per_s + v + Cross(w, body.com_m - com_m);
    body.angular_velocity_rad_per_s = body.angular_velocity_rad_per_s + w;
  }
}

}  // namespace

void ReadTerrain(const Value* list, const Scope& scope, RobotSpec& robot) {
  ModelDef& def = robot.def;
  std::map<std::string, SourceRef> names;
  for (const ValuePtr& item : Items(list, "terrain", scope)) {
    const MapReader map(*item, "terrain", {"name", "plane", "box"}, scope);
    const std::string name = map.Name("name");
    const std::string kind = map.ExactlyOne({"plane", "box"});
    if (kind == "plane") {
      def.planes.push_back(ReadPlane(*map.Find(kind), scope));
      def.planes.back().name = name;
      robot.plane_sources.push_back(item->at);
    } else if (kind == "box") {
      def.terrain_boxes.push_back(ReadTerrainBox(*map.Find(kind), scope));
      def.terrain_boxes.back().name = name;
      robot.terrain_box_sources.push_back(item->at);
    }
    if (name.empty()) continue;
    const auto [first, fresh] = names.emplace(name, map.Find("name")->at);
    if (!fresh) {
      map.Error("name", "there are two parts of the terrain called " + name,
                "the first is in line " + std::to_string(first->second.line));
    }
  }
}

void ReadPlace(const Value& value, StartKind start, const Scope& scope, ModelDef& def) {
  const MapReader map(value, "place",
                      {"at_m", "rotate", "velocity_m_per_s", "angular_velocity_rad_per_s"}, scope);
  const Vec3 at_m = map.VectorOr("at_m", {});
  Quat rotate;
  const Value* rotate_value = map.Find("rotate");
  if (rotate_value) rotate = ReadRotation(*rotate_value, "place.rotate", scope);
  const Vec3 velocity = map.VectorOr("velocity_m_per_s", {});
  const Vec3 spin = map.VectorOr("angular_velocity_rad_per_s", {});
  for (const char* key : {"velocity_m_per_s", "angular_velocity_rad_per_s"}) {
    if (start == StartKind::kAsDescribed || !map.Has(key)) continue;
    map.Error(key, map.Path(key) + " has no effect: settling ends at rest",
              "write `start: as_described`");
  }
  // Nothing is touched for nothing: a robot that is not placed keeps its numbers bit for bit.
  if (map.Has("at_m") || rotate_value) Move(at_m, rotate, def);
  if (map.Has("velocity_m_per_s") || map.Has("angular_velocity_rad_per_s")) {
    AddVelocity(velocity, spin, def);
  }
}

}  // namespace taut::description
