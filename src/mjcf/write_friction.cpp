// Unique names of geoms, and their friction values for MuJoCo.
#include <cmath>

#include "base/unique_names.h"
#include "mechanics/contact_roles.h"
#include "mjcf/write.h"
#include "sim/contacts/combine.h"

namespace taut::mjcf {
namespace {

template <class F>
void ForAll(const Geoms& geoms, F f) {
  for (const auto* list : {&geoms.spheres, &geoms.capsules, &geoms.boxes, &geoms.hulls}) {
    for (const Geoms::Geom& geom : *list) f(geom);
  }
}

/// Returns the friction of two geoms by MuJoCo's rule, without a pair element.
double Given(const ModelDef& def, const Friction& all, const Geoms::Geom& shape,
             const Geoms::Geom& other) {
  const double a = OwnFriction(def, all, shape), b = OwnFriction(def, all, other);
  return other.body == kWorld && all.grounds_rule ? b : std::max(a, b);
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
  for (std::size_t i = 0; i < def.capsules.size(); ++i) {
    const CapsuleDef& c = def.capsules[i];
    add(geoms.capsules, c.name, c.body, c.material, c.collides ? roles.capsules[i] : none(false));
  }
  for (std::size_t i = 0; i < def.spheres.size(); ++i) {
    const SphereDef& s = def.spheres[i];
    add(geoms.spheres, s.name, s.body, s.material, s.collides ? roles.spheres[i] : none(false));
  }
  for (const BoxDef& b : def.boxes) add(geoms.boxes, b.name, b.body, b.material, none(b.collides));
  for (const HullDef& h : def.hulls) add(geoms.hulls, h.name, h.body, h.material, none(h.collides));
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
  ForAll(geoms, [&](const Geoms::Geom& geom) {
    if (!geom.meets_planes && !geom.meets_bodies) return;
    if (shapes.empty()) all.shape = geom.material->kinetic_friction;
    shapes.push_back(geom);
  });
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
