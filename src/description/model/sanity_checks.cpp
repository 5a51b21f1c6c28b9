#include "description/model/sanity_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/brief.h"
#include "math/shape_corners.h"
#include "math/vec.h"
#include "taut/shape_kinds.h"

namespace taut::description {
namespace {

using base::Brief;

constexpr double kInf = std::numeric_limits<double>::infinity();

/// Largest permitted rounding error of a position, relative to the robot's smallest part.
constexpr double kFinest = 1e-6;
/// Largest plausible ratios between the largest and smallest element of a model. The values are
/// generous, since large structures have small parts, too.
constexpr double kMaxSizeRatio = 1e3, kMaxMassRatio = 1e6, kMaxStiffnessRatio = 1e6;
/// The density of air is 1.2 kg/m^3, of osmium 22 600 kg/m^3. The range is wider, since thin rods
/// often represent thicker and heavier parts.
constexpr double kLeastDensity = 0.1, kGreatestDensity = 1e6;  // [kg/m^3]

/// Returns the spacing of floating-point numbers at x.
double Rounding(double x) { return std::nextafter(std::fabs(x), kInf) - std::fabs(x); }

double Farthest(const Vec3& p) {
  return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
}

double Length(const CapsuleDef& rod) {
  const Vec3 d = rod.to_m - rod.from_m;
  return std::sqrt(Dot(d, d));
}

/// Returns whether a body index is valid. Resolved experiments may contain invalid ones, which
/// `Model::Compile` reports.
bool IsBody(const RobotSpec& robot, int body) {
  return body >= 0 && static_cast<std::size_t>(body) < robot.body_sources.size();
}

SourceRef SourceOf(const RobotSpec& robot, int body) {
  return IsBody(robot, body) ? robot.body_sources[static_cast<std::size_t>(body)] : SourceRef{};
}

/// Value of an element of the model, with the element's name and position in the file.
struct Item {
  double value;
  std::string name;
  SourceRef at;
};
using ItemList = std::vector<Item>;

bool Less(const Item& a, const Item& b) { return a.value < b.value; }

/// Returns half the smallest extent of each shape [m].
ItemList Sizes(const RobotSpec& robot) {
  ItemList sizes;
  const auto add = [&](const ShapeName& name, const auto& shapes) {
    for (const auto& shape : shapes) {
      sizes.push_back({math::HalfExtent(shape), std::string(name.one) + " \"" + shape.name + "\"",
                       SourceOf(robot, shape.body)});
    }
  };
  EachShapeList(add, robot.def);
  return sizes;
}

ItemList Masses(const RobotSpec& robot) {
  ItemList masses;
  for (std::size_t b = 0; b < robot.def.bodies.size(); ++b) {
    const BodyDef& body = robot.def.bodies[b];
    if (!body.fixed) {
      masses.push_back({body.mass_kg, "body \"" + body.name + "\"", robot.body_sources[b]});
    }
  }
  return masses;
}

ItemList Stiffnesses(const RobotSpec& robot) {
  ItemList stiffnesses;
  for (std::size_t c = 0; c < robot.def.cables.size(); ++c) {
    const CableDef& cable = robot.def.cables[c];
    stiffnesses.push_back(
        {cable.stiffness_n_per_m, "cable \"" + cable.name + "\"", robot.cable_sources[c]});
  }
  return stiffnesses;
}

/// Warns of a large ratio at the position of the larger item, since numbers are usually too large
/// by mistake.
void WarnOfRatio(const ItemList& items, double most, const char* what, const char* unit,
                 Diagnostics& out) {
  if (items.empty()) return;
  const auto [least, greatest] = std::minmax_element(items.begin(), items.end(), Less);
  if (!(least->value > 0.0) || greatest->value <= most * least->value) return;
  out.Warning("plausible.large_ratio", greatest->at,
              std::string(what) + " of the " + greatest->name + " (" + Brief(greatest->value) +
                  " " + unit + ") is " + Brief(greatest->value / least->value) + " times " + what +
                  " of the " + least->name + " (" + Brief(least->value) + " " + unit + ")",
              "check the units: the ratio is above " + Brief(most));
}

void WarnOfThickRods(const RobotSpec& robot, Diagnostics& out) {
  std::set<std::pair<int, int>> seen;  // copies of one rod count as one mistake
  for (const CapsuleDef& rod : robot.def.capsules) {
    const SourceRef at = SourceOf(robot, rod.body);
    const double length_m = Length(rod);
    if (rod.radius_m <= length_m || !seen.insert({at.line, at.column}).second) continue;
    out.Warning("plausible.thick_rod", at,
                "the rod \"" + rod.name + "\" has a radius of " + Brief(rod.radius_m) +
                    " m and a length of " + Brief(length_m) + " m",
                "use a box or a sphere for a disc: a rod has round ends");
  }
}

void WarnOfDensities(const RobotSpec& robot, Diagnostics& out) {
  std::vector<double> volume_m3(robot.def.bodies.size());
  EachShape(robot.def, [&](const auto& shape) {
    if (IsBody(robot, shape.body)) {
      volume_m3[static_cast<std::size_t>(shape.body)] += math::VolumeOf(shape);
    }
  });
  std::set<std::pair<int, int>> seen;
  for (std::size_t b = 0; b < robot.def.bodies.size(); ++b) {
    const BodyDef& body = robot.def.bodies[b];
    if (body.fixed || !(volume_m3[b] > 0.0)) continue;
    const double density = body.mass_kg / volume_m3[b];
    if (density >= kLeastDensity && density <= kGreatestDensity) continue;
    const SourceRef& at = robot.body_sources[b];
    if (!seen.insert({at.line, at.column}).second) continue;
    out.Warning("plausible.density", at,
                "the body \"" + body.name + "\" has a mass of " + Brief(body.mass_kg) +
                    " kg in a volume of " + Brief(volume_m3[b]) + " m^3: its density is " +
                    Brief(density) + " kg/m^3",
                density < kLeastDensity ? "check the units: air has 1.2 kg/m^3"
                                        : "check the units: osmium has 22600 kg/m^3");
  }
}

}  // namespace

namespace {

/// Returns the smallest shape of a robot. Without shapes, returns its shortest cable, else 1 m.
Item Smallest(const RobotSpec& robot) {
  ItemList sizes = Sizes(robot);
  if (sizes.empty()) {
    for (const CableDef& cable : robot.def.cables) {
      sizes.push_back({cable.rest_length_m, "cable \"" + cable.name + "\"", {}});
    }
  }
  if (sizes.empty()) return {1.0, "default scale", {}};
  return *std::min_element(sizes.begin(), sizes.end(), Less);
}

}  // namespace

bool IsTooFar(const RobotSpec& robot, double far_m) {
  const double smallest_m = Smallest(robot).value;
  return smallest_m > 0.0 && !(Rounding(far_m) <= kFinest * smallest_m);
}

void CheckPositions(const RobotSpec& robot, Diagnostics& out, const SourceRef* place) {
  const Item smallest = Smallest(robot);
  if (!(smallest.value > 0.0)) return;
  const auto complain = [&](const SourceRef& at, const std::string& what, double far_m) {
    out.Error("plausible.far_from_origin", at,
              what + " is " + Brief(far_m) + " m from the origin, where positions are rounded to " +
                  Brief(Rounding(far_m)) + " m",
              "the rounding may be at most a millionth of the smallest size, " +
                  Brief(smallest.value) + " m of the " + smallest.name);
  };
  const auto too_far = [&](double far_m) { return Rounding(far_m) > kFinest * smallest.value; };

  const ModelDef& def = robot.def;
  for (std::size_t n = 0; n < def.nodes.size(); ++n) {
    const double far_m = Farthest(def.nodes[n].position_m);
    if (!too_far(far_m)) continue;
    complain(place ? *place : robot.node_sources[n], "the node \"" + def.nodes[n].name + "\"",
             far_m);
    break;  // report the first node only; other nodes are probably as far away
  }
  for (std::size_t p = 0; p < def.planes.size(); ++p) {
    // The engine stores the plane's distance from the origin, so this distance determines the
    // rounding error.
    const Vec3 &n = def.planes[p].normal, &at = def.planes[p].point_m;
    const double far_m = Farthest({n.x * at.x, n.y * at.y, n.z * at.z});
    if (too_far(far_m)) {
      complain(robot.plane_sources[p], "the plane \"" + def.planes[p].name + "\"", far_m);
    }
  }
  for (std::size_t b = 0; b < def.terrain_boxes.size(); ++b) {
    const TerrainBoxDef& box = def.terrain_boxes[b];
    const double far_m = Farthest(box.center_m) + Farthest(box.half_extents_m);
    if (too_far(far_m)) {
      complain(robot.terrain_box_sources[b], "the box \"" + box.name + "\"", far_m);
    }
  }
  for (std::size_t f = 0; f < def.height_fields.size(); ++f) {
    const HeightFieldDef& field = def.height_fields[f];
    const double side_m = 0.5 * field.cell_m * (std::max(field.columns, field.rows) - 1);
    double high_m = 0.0;
    for (const double height : field.height_m) {
      high_m = std::max(high_m, std::fabs(field.origin_m.z + height));
    }
    const Vec3& middle = field.origin_m;
    const double far_m = std::max(Farthest({middle.x, middle.y, 0.0}) + side_m, high_m);
    if (too_far(far_m)) {
      complain(robot.height_field_sources[f], "the height field \"" + field.name + "\"", far_m);
    }
  }
  for (std::size_t m = 0; m < def.terrain_meshes.size(); ++m) {
    double far_m = 0.0;
    for (const Vec3& corner : def.terrain_meshes[m].corners_m) {
      far_m = std::max(far_m, Farthest(corner));
    }
    if (too_far(far_m)) {
      complain(robot.mesh_sources[m], "the mesh \"" + def.terrain_meshes[m].name + "\"", far_m);
    }
  }
}

void WarnImplausible(const RobotSpec& robot, Diagnostics& out) {
  WarnOfThickRods(robot, out);
  WarnOfDensities(robot, out);
  WarnOfRatio(Sizes(robot), kMaxSizeRatio, "the half thickness", "m", out);
  WarnOfRatio(Masses(robot), kMaxMassRatio, "the mass", "kg", out);
  WarnOfRatio(Stiffnesses(robot), kMaxStiffnessRatio, "the stiffness", "N/m", out);
}

}  // namespace taut::description
