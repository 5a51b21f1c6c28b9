// Unique names of geoms, and their friction coefficients for MuJoCo.
#include <cmath>

#include "base/unique_names.h"
#include "mechanics/contact_roles.h"
#include "mjcf/write.h"
#include "sim/contacts/combine.h"
#include "taut/shape_kinds.h"

namespace taut::mjcf {
namespace {

/// Returns the friction of two geoms by MuJoCo's rule if there is no pair element.
double Given(const ModelDef& def, const Friction& all, const Geoms::Geom& shape,
             const Geoms::Geom& other) {
  const double a = OwnFriction(def, all, shape), b = OwnFriction(def, all, other);
  return other.body == kWorld && all.grounds_rule ? b : std::max(a, b);
}

mechanics::ContactRole RoleOf(const mechanics::ContactRoles& roles, const CapsuleDef&,
                              std::size_t i) {
  return roles.capsules[i];
}
mechanics::ContactRole RoleOf(const mechanics::ContactRoles& roles, const SphereDef&,
                              std::size_t i) {
  return roles.spheres[i];
}
template <class Shape>
mechanics::ContactRole RoleOf(const mechanics::ContactRoles&, const Shape&, std::size_t) {
  return {};
}

}  // namespace

Geoms GeomsOf(const ModelDef& def) {
  const mechanics::ContactRoles roles = mechanics::ContactRolesOf(def);
  base::UniqueNames names;
  Geoms geoms;
  const auto none = [](bool collides) { return mechanics::ContactRole{collides, collides}; };
  const auto add = [&](auto& list, const std::string& name, int body, const Material& material,
                       const mechanics::ContactRole& role) {
    list.push_back(
        {names.Take(name), body, &material, role.meets_planes, role.meets_bodies, false});
  };
  EachShapeList(
      [&](const ShapeName&, const auto& shapes) {
        for (std::size_t i = 0; i < shapes.size(); ++i) {
          const auto& shape = shapes[i];
          add(geoms.shapes, shape.name, shape.body, shape.material,
              shape.collides ? RoleOf(roles, shape, i) : none(false));
        }
      },
      def);
  for (const PlaneDef& p : def.planes) {
    add(geoms.planes, p.name, kWorld, p.material, none(true));
    geoms.planes.back().is_plane = true;
  }
  for (const TerrainBoxDef& b : def.terrain_boxes) {
    add(geoms.terrain_boxes, b.name, kWorld, b.material, none(true));
  }
  for (const HeightFieldDef& f : def.height_fields) {
    add(geoms.height_fields, f.name, kWorld, f.material, none(true));
  }
  return geoms;
}

double FrictionOf(const ModelDef& def, const Material& a, const Material& b) {
  return sim::Combined(def, a, b).kinetic_friction;
}

double OwnFriction(const ModelDef& def, const Friction& all, const Geoms::Geom& geom) {
  const Material& m = *geom.material;
  if (geom.body != kWorld) return FrictionOf(def, m, m);
  if (!all.grounds_rule) return m.kinetic_friction;
  Material shape;
  shape.kinetic_friction = all.shape;
  return FrictionOf(def, shape, m);
}

Friction FrictionsOf(const ModelDef& def, const Geoms& geoms) {
  Friction all;
  all.grounds_rule = def.friction_combine != CombineRule::kMaximum;
  std::vector<Geoms::Geom> shapes, grounds;
  for (const Geoms::Geom& geom : geoms.shapes) {
    if (!geom.meets_planes && !geom.meets_bodies) continue;
    if (shapes.empty()) all.shape = geom.material->kinetic_friction;
    shapes.push_back(geom);
  }
  for (const auto* list : {&geoms.planes, &geoms.terrain_boxes, &geoms.height_fields}) {
    grounds.insert(grounds.end(), list->begin(), list->end());
  }
  const auto apart = KeptApart(def);
  const auto fixed = [&](const Geoms::Geom& geom) {
    return def.bodies[static_cast<std::size_t>(geom.body)].fixed;
  };
  const auto look = [&](const Geoms::Geom& shape, const Geoms::Geom& other) {
    const double want = FrictionOf(def, *shape.material, *other.material);
    if (std::fabs(Given(def, all, shape, other) - want) <= 1e-14 * (1 + want)) return;
    all.pairs.push_back({shape.name, other.name, want});
  };
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const Geoms::Geom& shape = shapes[i];
    for (const Geoms::Geom& ground : grounds) {
      if (!fixed(shape) && (ground.is_plane ? shape.meets_planes : shape.meets_bodies)) {
        look(shape, ground);
      }
    }
    for (std::size_t j = 0; j < i; ++j) {
      const Geoms::Geom& other = shapes[j];
      if (shape.body == other.body || (fixed(shape) && fixed(other)) || !shape.meets_bodies ||
          !other.meets_bodies || apart.contains(std::minmax(shape.body, other.body))) {
        continue;
      }
      look(shape, other);
    }
  }
  return all;
}

}  // namespace taut::mjcf
