#include "description/model/members.h"

#include <cmath>

#include "description/model/cable_shape.h"
#include "description/model/member_keys.h"
#include "math/vec.h"
#include "taut/statics.h"

namespace taut::description {
namespace {

/// Inputs for the rest length and stiffness of a member.
struct Given {
  const MemberDef& member;
  double stiffness_n_per_m;  ///< NaN: computed from the section.
  double rest_length_m;      ///< NaN: computed from `ratio` or `prestress_n`.
  const std::optional<double>&ratio, prestress_n, density_kg_per_m3;
};

Elastic Work(const Given& given, double length_m) {
  const MemberDef& m = given.member;
  const bool of_section = std::isnan(given.stiffness_n_per_m);
  const double rigidity_n = m.young_pa > 0 && m.area_m2 > 0 ? m.young_pa * m.area_m2 : NAN;
  Elastic out{given.stiffness_n_per_m, given.rest_length_m, m.mass_kg};
  if (given.prestress_n) {
    out.rest_length_m = of_section ? length_m / (1.0 + *given.prestress_n / rigidity_n)
                                   : length_m - *given.prestress_n / given.stiffness_n_per_m;
  } else if (given.ratio) {
    out.rest_length_m = *given.ratio * length_m;
  }
  if (of_section) out.stiffness_n_per_m = rigidity_n / out.rest_length_m;
  if (given.density_kg_per_m3) {
    out.mass_kg = *given.density_kg_per_m3 * m.area_m2 * out.rest_length_m;
  }
  return out;
}

bool HasMass(const MemberDef& member, const std::optional<double>& density_kg_per_m3) {
  return member.mass_kg != 0 || density_kg_per_m3.value_or(0.0) != 0;
}

void Needs(const MapReader& map, const char* key, const char* other, const char* why) {
  if (!map.Has(key) || map.Has(other)) return;
  map.Error("key.needs_key", key, map.Path(key) + " needs the key \"" + other + "\" as well", why);
}

double Length(const Vec3& a, const Vec3& b) { return std::sqrt(Dot(b - a, b - a)); }

}  // namespace

Elastic ElasticOf(const BarText& bar, double length_m) {
  const bool as_described = !bar.rest_length_ratio && !bar.prestress_n;
  return Work({bar.member, bar.stiffness_n_per_m.value_or(NAN),
               bar.rest_length_m.value_or(as_described ? length_m : NAN), bar.rest_length_ratio,
               bar.prestress_n, bar.density_kg_per_m3},
              length_m);
}

Elastic ElasticOf(const CableText& cable, double length_m) {
  return Work({cable.member, cable.stiffness_n_per_m, cable.rest_length_m, cable.rest_length_ratio,
               cable.prestress_n, cable.density_kg_per_m3},
              length_m);
}

void LumpMembers(const ModelText& model, const Assembly& assembly, Assignment& assignment) {
  Diagnostics unheard;  // ignored: `BuildCables` and `BuildJoints` report the same errors
  OncePerPlace complain(unheard);
  for (std::size_t pair = 0; pair < assembly.pairs.size(); ++pair) {
    const int b = assignment.of_pair[pair];
    if (b < 0) continue;
    const PlacedPair& placed = assembly.pairs[pair];
    const BuilderText& builder = model.builders[static_cast<std::size_t>(b)];
    double mass_kg = 0;
    if (builder.bar && HasMass(builder.bar->member, builder.bar->density_kg_per_m3)) {
      const auto at = [&](int n) { return assembly.nodes[static_cast<std::size_t>(n)].position_m; };
      mass_kg = ElasticOf(*builder.bar, Length(at(placed.nodes[0]), at(placed.nodes[1]))).mass_kg;
    } else if (builder.cable && HasMass(builder.cable->member, builder.cable->density_kg_per_m3)) {
      CableDef cable = *builder.cable;
      ShapeCable({model, assembly, assignment, nullptr}, placed, *builder.cable, cable, complain);
      mass_kg = ElasticOf(*builder.cable, CableLength(cable)).mass_kg;
    }
    for (const int node : {placed.nodes.front(), placed.nodes.back()}) {
      assignment.lump_kg[static_cast<std::size_t>(node)] += 0.5 * mass_kg;
    }
  }
}

void CheckSection(const MapReader& map, MemberOf of) {
  Needs(map, "yield_pa", "area_m2", "the yield force is yield stress times area");
  if (of == MemberOf::kCable) return;
  Needs(map, "second_moment_m4", "young_pa", "Euler's buckling load is pi^2 E I / l^2");
  Needs(map, "buckling_length_m", "second_moment_m4", "Euler's buckling load is pi^2 E I / l^2");
}

void CheckOwnMass(const MapReader& map, const MemberDef& member,
                  const std::optional<double>& density_kg_per_m3) {
  if (map.Has("density_kg_per_m3") && map.Has("mass_kg")) {
    map.ExactlyOne({"mass_kg", "density_kg_per_m3"});
  } else {
    Needs(map, "density_kg_per_m3", "area_m2", "the mass is density times area times length");
  }
  if (map.Has("mass") && member.mass_kg == 0 && !density_kg_per_m3) {
    map.Error("rod.mass_without_effect", "mass",
              map.Path("mass") + " has no effect: the member has no mass",
              "give mass_kg or density_kg_per_m3");
  }
}

void CheckStiffness(const MapReader& map) {
  if (!map.is_map() || map.Has("stiffness_n_per_m")) return;
  if (map.Has("young_pa") && map.Has("area_m2")) return;
  const std::string hint = "or give `young_pa` and `area_m2`: k = E A / L";
  if (map.Has("young_pa")) {
    Needs(map, "young_pa", "area_m2", "or give stiffness_n_per_m instead: k = E A / L");
  } else {
    map.scope().out.Error("bar.stiffness_missing", map.at(),
                          map.what() + " needs the key \"stiffness_n_per_m\"", hint);
  }
}

void Check(const MapReader& map, BarText& bar) {
  CheckStiffness(map);
  CheckSection(map, MemberOf::kBar);
  CheckOwnMass(map, bar.member, bar.density_kg_per_m3);
  std::vector<std::string> given;
  for (const char* key : {"prestress_n", "rest_length_m", "rest_length_ratio"}) {
    if (!map.Has(key)) continue;
    bar.rest_at = map.Find(key)->at;
    given.push_back(key);
  }
  if (given.size() > 1) {
    map.ExactlyOne(given);
    bar.rest_length_m = NAN;
    bar.rest_length_ratio.reset(), bar.prestress_n.reset();
  }
}

}  // namespace taut::description
