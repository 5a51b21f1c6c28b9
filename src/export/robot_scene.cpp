// Messages in the schemas that Foxglove publishes (https://docs.foxglove.dev/docs/sdk/schemas).
#include "export/robot_scene.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/fixed.h"
#include "export/appearance.h"
#include "export/cable_points.h"
#include "export/message_tree.h"
#include "math/convex_hull.h"
#include "math/vec.h"

namespace taut::exporting {
namespace {

using nlohmann::ordered_json;

constexpr char kWorldFrame[] = "world";
constexpr int kLineList = 2;
constexpr double kLinePixels = 2;

std::string TextOf(const ordered_json& json) {
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

ordered_json Time(std::uint64_t time_ns) {
  return {{"sec", time_ns / 1'000'000'000}, {"nsec", time_ns % 1'000'000'000}};
}
ordered_json Vector(const Vec3& v) { return {{"x", v.x}, {"y", v.y}, {"z", v.z}}; }
ordered_json PoseOf(const Vec3& at, const Quat& q) {
  return {{"position", Vector(at)},
          {"orientation", {{"x", q.x}, {"y", q.y}, {"z", q.z}, {"w", q.w}}}};
}
ordered_json ColourOf(ShapeMesh::Kind kind) {
  const Appearance& look = AppearanceOf(kind);
  return {{"r", look.Screen(0)}, {"g", look.Screen(1)}, {"b", look.Screen(2)}, {"a", 1.0}};
}

/// Returns the shortest rotation from the z axis to the direction of `way`.
Quat FromZ(const Vec3& way) {
  const double length = std::sqrt(Dot(way, way));
  if (!(length > 0)) return {};
  const Vec3 u = (1 / length) * way;
  if (u.z < -1 + 1e-12) return {0, 1, 0, 0};
  const Quat q{1 + u.z, -u.y, u.x, 0};
  const double size = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y);
  return {q.w / size, q.x / size, q.y / size, 0};
}

/// Returns a scene entity with a frame and empty lists of all primitives.
ordered_json Entity(const std::string& id, const std::string& frame, std::uint64_t time_ns) {
  ordered_json entity{{"timestamp", Time(time_ns)},
                      {"frame_id", frame},
                      {"id", id},
                      {"lifetime", {{"sec", 0}, {"nsec", 0}}},
                      {"frame_locked", true}};
  for (const char* list : {"metadata", "arrows", "cubes", "spheres", "cylinders", "lines",
                           "triangles", "texts", "models"}) {
    entity[list] = ordered_json::array();
  }
  return entity;
}

void AddSphere(ordered_json& to, const Vec3& at, double radius_m, ShapeMesh::Kind kind) {
  const double d = 2 * radius_m;
  to["spheres"].push_back(
      {{"pose", PoseOf(at, {})}, {"size", Vector({d, d, d})}, {"color", ColourOf(kind)}});
}

void AddRod(ordered_json& to, const Vec3& from, const Vec3& end, double radius_m) {
  const Vec3 way = end - from;
  const double d = 2 * radius_m;
  to["cylinders"].push_back({{"pose", PoseOf(0.5 * (from + end), FromZ(way))},
                             {"size", Vector({d, d, std::sqrt(Dot(way, way))})},
                             {"bottom_scale", 1.0},
                             {"top_scale", 1.0},
                             {"color", ColourOf(ShapeMesh::Kind::kRod)}});
  AddSphere(to, from, radius_m, ShapeMesh::Kind::kRod);
  AddSphere(to, end, radius_m, ShapeMesh::Kind::kRod);
}

void AddHull(ordered_json& to, const HullDef& hull, const Vec3& origin_m) {
  const math::ConvexHull solid = math::HullOf(hull.corners_m, HullDef::kMostCorners);
  ordered_json points = ordered_json::array(), indices = ordered_json::array();
  for (const Vec3& corner : solid.corners) points.push_back(Vector(corner - origin_m));
  for (const auto& triangle : math::TrianglesOf(solid)) {
    for (const int corner : triangle) indices.push_back(corner);
  }
  to["triangles"].push_back({{"pose", PoseOf({}, {})},
                             {"points", points},
                             {"color", ColourOf(ShapeMesh::Kind::kHull)},
                             {"colors", ordered_json::array()},
                             {"indices", indices}});
}

ordered_json Kind(const char* type) { return {{"type", type}}; }
ordered_json Object(const ordered_json& properties) {
  return {{"type", "object"}, {"properties", properties}};
}
ordered_json ListOf(const ordered_json& items) { return {{"type", "array"}, {"items", items}}; }
ordered_json NumbersOf(const std::vector<const char*>& names) {
  ordered_json properties = ordered_json::object();
  for (const char* name : names) properties[name] = Kind("number");
  return Object(properties);
}
ordered_json TimeSchema() { return Object({{"sec", Kind("integer")}, {"nsec", Kind("integer")}}); }

}  // namespace

Vec3 BodyChannels::PlaceAt(const Trace& trace, std::size_t row) const {
  return {trace.values[place[0]][row], trace.values[place[1]][row], trace.values[place[2]][row]};
}
Quat BodyChannels::TurnAt(const Trace& trace, std::size_t row) const {
  return {trace.values[turn[0]][row], trace.values[turn[1]][row], trace.values[turn[2]][row],
          trace.values[turn[3]][row]};
}
bool BodyChannels::IsFiniteAt(const Trace& trace, std::size_t row) const {
  const Vec3 p = PlaceAt(trace, row);
  const Quat q = TurnAt(trace, row);
  return std::isfinite(p.x + p.y + p.z + q.w + q.x + q.y + q.z);
}

std::vector<BodyChannels> BodiesOf(const Trace& trace) {
  constexpr std::string_view kBefore = "body/", kBehind = "/position_x_m";
  std::vector<BodyChannels> bodies;
  for (const ChannelInfo& channel : trace.channels) {
    const std::string& name = channel.name;
    if (!name.starts_with(kBefore) || !name.ends_with(kBehind)) continue;
    BodyChannels body;
    body.name = name.substr(kBefore.size(), name.size() - kBefore.size() - kBehind.size());
    bool all = true;
    const auto find = [&](const std::string& quantity, std::size_t& at) {
      const auto found = trace.Find("body/" + body.name + "/" + quantity);
      if (found) at = *found;
      all = all && found;
    };
    for (std::size_t k = 0; k < 3; ++k) {
      find(std::string("position_") + "xyz"[k] + "_m", body.place[k]);
    }
    for (std::size_t k = 0; k < 4; ++k) find(std::string("orientation_") + "wxyz"[k], body.turn[k]);
    if (all) bodies.push_back(body);
  }
  return bodies;
}

std::string FramesAt(const Trace& trace, const std::vector<BodyChannels>& bodies, std::size_t row,
                     std::uint64_t time_ns) {
  ordered_json transforms = ordered_json::array();
  for (const BodyChannels& body : bodies) {
    if (!body.IsFiniteAt(trace, row)) continue;
    const Quat q = body.TurnAt(trace, row);
    transforms.push_back({{"timestamp", Time(time_ns)},
                          {"parent_frame_id", kWorldFrame},
                          {"child_frame_id", body.name},
                          {"translation", Vector(body.PlaceAt(trace, row))},
                          {"rotation", {{"x", q.x}, {"y", q.y}, {"z", q.z}, {"w", q.w}}}});
  }
  return TextOf({{"transforms", transforms}});
}

std::string RobotShapes(const ModelDef& def, std::uint64_t time_ns) {
  ordered_json entities = ordered_json::array();
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    const BodyDef& body = def.bodies[b];
    const auto own = [&](const auto& shape) { return shape.body == static_cast<int>(b); };
    ordered_json entity = Entity(body.name, body.name, time_ns);
    for (const CapsuleDef& rod : def.capsules) {
      if (own(rod)) AddRod(entity, rod.from_m - body.com_m, rod.to_m - body.com_m, rod.radius_m);
    }
    for (const SphereDef& sphere : def.spheres) {
      if (!own(sphere)) continue;
      AddSphere(entity, sphere.center_m - body.com_m, sphere.radius_m, ShapeMesh::Kind::kSphere);
    }
    for (const BoxDef& box : def.boxes) {
      if (!own(box)) continue;
      entity["cubes"].push_back({{"pose", PoseOf(box.center_m - body.com_m, box.orientation)},
                                 {"size", Vector(2.0 * box.half_extents_m)},
                                 {"color", ColourOf(ShapeMesh::Kind::kBox)}});
    }
    for (const HullDef& hull : def.hulls) {
      if (own(hull)) AddHull(entity, hull, body.com_m);
    }
    entities.push_back(entity);
  }
  return TextOf({{"deletions", ordered_json::array()}, {"entities", entities}});
}

std::optional<CableLines> CableLines::Of(const ModelDef& def, const Trace& trace,
                                         const std::vector<BodyChannels>& bodies) {
  if (def.cables.empty()) return std::nullopt;
  CableLines lines(def);
  for (const BodyDef& body : def.bodies) {
    const auto found = std::find_if(bodies.begin(), bodies.end(),
                                    [&](const BodyChannels& b) { return b.name == body.name; });
    lines.bodies_.emplace_back();
    if (found != bodies.end()) {
      lines.bodies_.back() = *found;
    } else if (!body.fixed) {
      return std::nullopt;
    }
  }
  for (const CableDef& cable : def.cables) {
    lines.tension_.push_back(trace.Find("cable/" + cable.name + "/tension_n"));
  }
  return lines;
}

Vec3 CableLines::Moved(int body, const Vec3& point_m, const Trace& trace, std::size_t row) const {
  if (body == kWorld || !bodies_[static_cast<std::size_t>(body)]) return point_m;
  const auto b = static_cast<std::size_t>(body);
  return bodies_[b]->PlaceAt(trace, row) +
         Rotate(bodies_[b]->TurnAt(trace, row), point_m - def_->bodies[b].com_m);
}

CableDef CableLines::CableAt(const CableDef& cable, const Trace& trace, std::size_t row) const {
  CableDef now = cable;
  for (AttachmentDef& at : now.attachments) {
    if (at.wheel) {
      // The wheel's axis is the difference of two points of the body.
      const Vec3 tip = Moved(at.body, at.position_m + at.wheel->axis, trace, row);
      at.wheel->axis = tip - Moved(at.body, at.position_m, trace, row);
    }
    at.position_m = Moved(at.body, at.position_m, trace, row);
  }
  return now;
}

std::string CableLines::At(const Trace& trace, std::size_t row, std::uint64_t time_ns) const {
  ordered_json points = ordered_json::array(), colours = ordered_json::array();
  for (std::size_t c = 0; c < def_->cables.size(); ++c) {
    const bool slack = tension_[c] && !(trace.values[*tension_[c]][row] > 0);
    const ordered_json colour =
        ColourOf(slack ? ShapeMesh::Kind::kSlackCable : ShapeMesh::Kind::kCable);
    const std::vector<Vec3> path = CablePoints(CableAt(def_->cables[c], trace, row));
    for (std::size_t i = 1; i < path.size(); ++i) {
      for (const Vec3& end : {path[i - 1], path[i]}) {
        if (!std::isfinite(end.x + end.y + end.z)) continue;
        points.push_back(Vector(end)), colours.push_back(colour);
      }
    }
  }
  ordered_json entity = Entity("cables", kWorldFrame, time_ns);
  entity["lines"].push_back({{"type", kLineList},
                             {"pose", PoseOf({}, {})},
                             {"thickness", kLinePixels},
                             {"scale_invariant", true},
                             {"points", points},
                             {"color", ColourOf(ShapeMesh::Kind::kCable)},
                             {"colors", colours},
                             {"indices", ordered_json::array()}});
  ordered_json entities = ordered_json::array();
  entities.push_back(entity);
  return TextOf({{"deletions", ordered_json::array()}, {"entities", entities}});
}

std::string FramesSchema() {
  return TextOf(
      Object({{"transforms", ListOf(Object({{"timestamp", TimeSchema()},
                                            {"parent_frame_id", Kind("string")},
                                            {"child_frame_id", Kind("string")},
                                            {"translation", NumbersOf({"x", "y", "z"})},
                                            {"rotation", NumbersOf({"x", "y", "z", "w"})}}))}}));
}

std::string SceneSchema() {
  const ordered_json vector = NumbersOf({"x", "y", "z"}), colour = NumbersOf({"r", "g", "b", "a"}),
                     number = Kind("number"), none = ListOf(Object(ordered_json::object()));
  const ordered_json pose =
      Object({{"position", vector}, {"orientation", NumbersOf({"x", "y", "z", "w"})}});
  const ordered_json solid{{"pose", pose}, {"size", vector}, {"color", colour}};
  ordered_json cylinder = solid, triangles, line;
  cylinder["bottom_scale"] = cylinder["top_scale"] = number;
  triangles = {{"pose", pose},
               {"points", ListOf(vector)},
               {"color", colour},
               {"colors", ListOf(colour)},
               {"indices", ListOf(Kind("integer"))}};
  line = triangles;
  line["type"] = Kind("integer"), line["thickness"] = number;
  line["scale_invariant"] = Kind("boolean");
  return TextOf(Object({{"deletions", none},
                        {"entities", ListOf(Object({{"timestamp", TimeSchema()},
                                                    {"frame_id", Kind("string")},
                                                    {"id", Kind("string")},
                                                    {"lifetime", TimeSchema()},
                                                    {"frame_locked", Kind("boolean")},
                                                    {"metadata", none},
                                                    {"arrows", none},
                                                    {"cubes", ListOf(Object(solid))},
                                                    {"spheres", ListOf(Object(solid))},
                                                    {"cylinders", ListOf(Object(cylinder))},
                                                    {"lines", ListOf(Object(line))},
                                                    {"triangles", ListOf(Object(triangles))},
                                                    {"texts", none},
                                                    {"models", none}}))}}));
}

}  // namespace taut::exporting
