// Terrain of an experiment, and placement of the robot in it.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "description/experiment/experiment_keys.h"
#include "description/experiment/experiment_parts.h"
#include "math/elementary.h"
#include "math/vec.h"
#include "mechanics/placed_parts.h"

namespace taut::description {
namespace {

Inertia Rotated(const Quat& q, const Inertia& inertia) {
  // Rows of the rotation matrix of q, as vectors.
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

/// Rigid displacement of the robot, including its points fixed in the world: rotation `q` about the
/// origin, then translation `at_m`.
struct Placing {
  Vec3 at_m;
  Quat q;
  static bool Moves(int) { return true; }
  Vec3 Moved(int, const Vec3& point_m) const { return at_m + Rotate(q, point_m); }
  const Quat& Turned(int) const { return q; }
};

void Move(const Placing& placing, RobotSpec& robot) {
  ModelDef& def = robot.def;
  for (BodyDef& body : def.bodies) {
    body.com_m = placing.Moved(kWorld, body.com_m);
    body.inertia_kg_m2 = Rotated(placing.q, body.inertia_kg_m2);
    body.velocity_m_per_s = Rotate(placing.q, body.velocity_m_per_s);
    body.angular_velocity_rad_per_s = Rotate(placing.q, body.angular_velocity_rad_per_s);
  }
  MoveParts(placing, def);
  if (!robot.solids) return;
  for (SolidsSpec::PointMass& mass : robot.solids->point_masses) {
    if (mass.inertia_kg_m2) mass.inertia_kg_m2 = Rotated(placing.q, *mass.inertia_kg_m2);
  }
}

/// Adds a rigid motion of the whole robot. `v`: velocity of its center of mass; `w`: angular
/// velocity about the center of mass.
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

void Check(const MapReader& map, PlaneText& plane) {
  plane.material = ToMaterial(map, plane.surface);
  if (plane.height_m) {
    plane.point_m = {0, 0, *plane.height_m};
    if (map.Has("point_m")) {
      map.Error("terrain.plane_given_twice", "point_m", "plane has both height_m and point_m",
                "give only one of them");
    }
  }
  if (map.Has("slope_direction") && !map.Has("slope_rad")) {
    map.Error("terrain.slope_missing", "slope_direction", "plane.slope_direction needs slope_rad");
  }
  if (!plane.slope_rad || !map.Require("slope_direction")) return;
  const double slope = *plane.slope_rad;
  const Vec3 up = *plane.slope_direction;
  if (up.z != 0.0 && !std::isnan(up.z)) {
    map.scope().out.Error("terrain.slope_not_horizontal", map.Find("slope_direction")->at,
                          "plane.slope_direction must be horizontal", "its last number must be 0");
  }
  if (std::isnan(slope)) return;
  plane.normal = Vec3{0, 0, math::Cos(slope)} - math::Sin(slope) * up;
}

void Check(const MapReader& map, TerrainBoxText& box) {
  box.half_extents_m = 0.5 * box.size_m;
  box.material = ToMaterial(map, box.surface);
}

void Check(const MapReader& map, TerrainText& terrain) {
  if (map.Has("name")) terrain.name_at = map.Find("name")->at;
  terrain.name_key_at = map.KeyAt("name");
}

void Check(const MapReader& map, PlaceText& place) {
  place.moved = map.Has("at_m") || map.Has("rotate");
  if (map.Has("velocity_m_per_s")) place.velocity_at = map.KeyAt("velocity_m_per_s");
  if (map.Has("angular_velocity_rad_per_s"))
    place.angular_velocity_at = map.KeyAt("angular_velocity_rad_per_s");
}

void AddTerrain(const std::vector<TerrainText>& texts, const Scope& scope, RobotSpec& robot) {
  ModelDef& def = robot.def;
  std::map<std::string, SourceRef> names;
  trace::TableBudget heights(kMostHeights);
  for (const TerrainText& text : texts) {
    if (text.plane) {
      def.planes.push_back(*text.plane);
      def.planes.back().name = text.name;
      robot.plane_sources.push_back(text.at);
    } else if (text.box) {
      def.terrain_boxes.push_back(*text.box);
      def.terrain_boxes.back().name = text.name;
      robot.terrain_box_sources.push_back(text.at);
    } else if (text.height_field) {
      if (auto field = ReadHeightField(*text.height_field, scope, heights)) {
        def.height_fields.push_back(std::move(*field));
        def.height_fields.back().name = text.name;
        robot.height_field_sources.push_back(text.at);
        if (!text.height_field->file.text.empty())
          robot.files.push_back(PathOf(*text.height_field));
      }
    } else if (text.mesh) {
      if (auto mesh = ReadTerrainMesh(*text.mesh, scope)) {
        def.terrain_meshes.push_back(std::move(*mesh));
        def.terrain_meshes.back().name = text.name;
        robot.mesh_sources.push_back(text.at);
        robot.files.push_back(PathOf(*text.mesh));
      }
    }
    if (text.name.empty()) continue;
    const auto claim = [&](const std::string& name) {
      const auto [first, fresh] = names.emplace(name, text.name_at);
      if (!fresh) {
        scope.out.Error("terrain.duplicate_name", text.name_key_at,
                        "two terrain elements are called " + name,
                        "the first is in line " + std::to_string(first->second.line));
      }
      return fresh;
    };
    if (!claim(text.name)) continue;
    const int made = text.scatter ? text.scatter->count : text.stairs ? text.stairs->steps : 0;
    if (const std::size_t all = def.terrain_boxes.size() + static_cast<std::size_t>(made);
        all > static_cast<std::size_t>(kMostBoxes)) {
      scope.out.Error("terrain.too_many_boxes", text.at,
                      "the terrain has " + std::to_string(all) +
                          " boxes up to this element, more than " + std::to_string(kMostBoxes),
                      "use a height field or a mesh");
      return;  // Return before allocation: thousands of entries would exhaust memory.
    }
    std::vector<TerrainBoxDef> boxes;
    if (text.scatter) boxes = Boxes(*text.scatter);
    if (text.stairs) boxes = Boxes(*text.stairs);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      boxes[i].name = text.name + '_' + std::to_string(i);
      if (boxes[i].name.size() > kMaxNameLength) {
        scope.out.Error("terrain.name_too_long", text.name_at,
                        "terrain.name and the appended number of a box have more than " +
                            std::to_string(kMaxNameLength) + " characters",
                        "use a shorter name");
        break;
      }
      if (!claim(boxes[i].name)) break;
      def.terrain_boxes.push_back(std::move(boxes[i]));
      robot.terrain_box_sources.push_back(text.at);
    }
  }
}

void Place(const PlaceText& place, StartKind start, const Scope& scope, RobotSpec& robot) {
  const bool moving = place.velocity_at.line > 0, turning = place.angular_velocity_at.line > 0;
  const auto check = [&](bool given, const SourceRef& at, const char* key) {
    if (start == StartKind::kAsDescribed || !given) return;
    scope.out.Error("start.key_without_effect", at,
                    std::string("place.") + key + " has no effect: settling ends at rest",
                    "write `start: as_described`");
  };
  check(moving, place.velocity_at, "velocity_m_per_s");
  check(turning, place.angular_velocity_at, "angular_velocity_rad_per_s");
  // Without a new place, the robot's numbers stay bit-identical.
  if (place.moved) Move({place.at_m, place.rotate}, robot);
  if (moving || turning) {
    AddVelocity(place.velocity_m_per_s, place.angular_velocity_rad_per_s, robot.def);
  }
}

}  // namespace taut::description
