// Construction of rigid bodies, shapes and nodes.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "description/model/beam_axes.h"
#include "description/model/body_velocities.h"
#include "description/model/build.h"
#include "description/model/welds.h"
#include "description/yaml/once.h"
#include "math/vec.h"
#include "mechanics/mass_properties.h"
#include "taut/statics.h"

namespace taut::description {
namespace {

constexpr double kShortest_m = 1e-9;  ///< Shortest length that defines a direction [m].
/// Radius that defines the inertia of a single point mass. The value has no effect, since all
/// forces act at its center, but the inertia must be positive.
constexpr double kPointRadius_m = 0.01;

/// Solid elements of a weld.
struct Solids {
  std::vector<MassProperties> parts;
  Bounds bounds;
  bool complete = true;  ///< False: a rod with an error is missing.
};

class BodyBuilder {
 public:
  BodyBuilder(const ModelText& model, const Assembly& assembly, const Assignment& assignment,
              RobotSpec& robot, Diagnostics& out)
      : model_(model),
        assembly_(assembly),
        assignment_(assignment),
        robot_(robot),
        out_(out),
        bodiless_(out),
        short_(out) {
    Welds found = FindWelds(model, assembly, assignment);
    welds_ = std::move(found.welds);
    pins_ = std::move(found.pins);
    body_of_node_.assign(assembly.nodes.size(), kWorld);
    body_of_pair_.assign(assembly.pairs.size(), kWorld);
  }

  BodyOfNode Run() {
    CheckPairs();
    CountBodies();
    for (const Weld& weld : welds_) BuildWeld(weld);
    for (const Pin& pin : pins_) AddPin(pin);
    SetBodyVelocities({assembly_, welds_with_body_, instance_of_body_, bodies_in_instance_},
                      robot_.def, out_);
    for (std::size_t node = 0; node < assembly_.nodes.size(); ++node) {
      const PlacedNode& placed = assembly_.nodes[node];
      robot_.def.nodes.push_back({placed.name, body_of_node_[node], placed.position_m});
      robot_.node_tags.push_back(placed.tags);
      robot_.node_sources.push_back(placed.at);
    }
    return std::move(body_of_node_);
  }

 private:
  const BuilderText& PairBuilder(int pair) const {
    return model_.builders[assignment_.of_pair[pair]];
  }

  void CheckPairs() {
    for (std::size_t pair = 0; pair < assembly_.pairs.size(); ++pair) {
      const PlacedPair& placed = assembly_.pairs[pair];
      const int b = assignment_.of_pair[pair];
      if (b < 0 || !IsSolid(model_.builders[b]) || placed.nodes.size() == 2) continue;
      out_.Error("builder.two_nodes_needed", placed.at,
                 "a " + model_.builders[b].kind + " needs two nodes, but \"" + placed.name +
                     "\" has " + std::to_string(placed.nodes.size()));
    }
  }

  void CountBodies() {
    bodies_in_instance_.assign(assembly_.instances.size(), 0);
    for (const Weld& weld : welds_) {
      const int instance = FirstInstance(weld);
      if (weld.has_solid && instance >= 0) ++bodies_in_instance_[instance];
    }
  }

  void BuildWeld(const Weld& weld) {
    if (!weld.has_solid) {
      if (!weld.anchored) ReportBodiless(weld);
      return;
    }
    const int body = static_cast<int>(robot_.def.bodies.size());
    for (const int node : weld.nodes) body_of_node_[node] = body;
    Solids solids;
    for (const int pair : weld.pairs) AddPair(solids, pair, body), body_of_pair_[pair] = body;
    for (const int node : weld.nodes) AddNode(weld, solids, node, body);
    const MassProperties whole = Combine(solids.parts);
    BodyDef def;
    def.name = Name(weld);
    def.mass_kg = whole.mass_kg;
    def.com_m = whole.mass_kg == 0.0 && !weld.nodes.empty()
                    ? assembly_.nodes[weld.nodes[0]].position_m
                    : whole.com_m;
    def.inertia_kg_m2 = whole.inertia_kg_m2;
    if (model_.inertia == InertiaLaw::kBoundingBox && solids.parts.size() > 1 &&
        solids.bounds.low.x < solids.bounds.high.x) {
      def.inertia_kg_m2 = BoundingBoxInertia(solids.bounds, whole.mass_kg);
    }
    def.fixed = weld.anchored;
    if (!def.fixed) CheckMass(weld, solids, def);
    if (!names_.insert(def.name).second) {
      out_.Error("body.duplicate_name", Source(weld),
                 "two bodies have the name \"" + def.name + "\"",
                 "give a pair of one of them a `name:`");
    }
    robot_.def.bodies.push_back(std::move(def));
    robot_.body_sources.push_back(Source(weld));
    instance_of_body_.push_back(InstanceOf(weld));
    welds_with_body_.push_back(&weld);
  }

  void ReportBodiless(const Weld& weld) {
    const PlacedNode& node = assembly_.nodes[weld.nodes[0]];
    if (!model_.builders_complete || !assembly_.complete) return;
    if (weld.ends_bar) {
      bodiless_("node.no_mass", node.at, "the node \"" + node.name + "\" has no mass",
                "give a bar or a cable at this node density_kg_per_m3 and area_m2, or mass_kg; or "
                "give the node a point_mass or an anchor");
      return;
    }
    bodiless_("node.no_body", node.at, "node \"" + node.name + "\" belongs to no body",
              "give it a rod, box, sphere or point_mass, attach it to the body of another node "
              "with fixed_to, or fix it in the world with an anchor");
  }

  void AddPair(Solids& solids, int pair, int body) {
    const PlacedPair& placed = assembly_.pairs[pair];
    const Vec3 from = assembly_.nodes[placed.nodes[0]].position_m;
    const Vec3 to = assembly_.nodes[placed.nodes[1]].position_m;
    const double length = std::sqrt(Dot(to - from, to - from));
    solids.complete = solids.complete && length >= kShortest_m;
    if (std::isnan(length)) return;
    const BuilderText& builder = PairBuilder(pair);
    if (length < kShortest_m) {
      short_("rod.no_length", placed.at,
             "the " + builder.kind + " \"" + placed.name + "\" has no length",
             "its nodes are at the same position");
      return;
    }
    if (builder.rod) {
      const double r = builder.rod->radius_m, volume = std::numbers::pi * r * r * length;
      solids.parts.push_back(SolidCylinder(from, to, r, builder.rod->mass.Of(volume, length)));
      solids.bounds = Union(solids.bounds, BulletCylinderBounds(from, to, r));
      robot_.solids->capsules.push_back(builder.rod->mass.AsWritten());
      CapsuleDef& def =
          Add(robot_.def.capsules, *builder.rod, placed.name, body, TurnOf(placed.instance));
      def.from_m = from;
      def.to_m = to;
      if (def.member.second_moment_m4 > 0 && def.member.buckling_length_m == 0) {
        def.member.buckling_length_m = length;
      }
    } else if (builder.box) {
      const BoxText& box = *builder.box;
      const Quat q_WPart = TurnOf(placed.instance);
      const Vec3 u = Rotate(Conjugate(q_WPart), (1.0 / length) * (to - from));
      AddBox(solids, box, placed.name, body, q_WPart, 0.5 * (from + to),
             q_WPart * BeamOrientation(u), {0.5 * length, 0.5 * box.width_m, 0.5 * box.height_m},
             box.mass.Of(length * box.width_m * box.height_m, length));
    }
  }

  void AddNode(const Weld& weld, Solids& solids, int node, int body) {
    const PlacedNode& placed = assembly_.nodes[node];
    const std::vector<int>& builders = assignment_.of_node[node];
    const bool is_point = weld.nodes.size() == 1 && weld.pairs.empty() &&
                          std::none_of(builders.begin(), builders.end(), [&](int b) {
                            const BuilderText& builder = model_.builders[b];
                            return builder.sphere || builder.box || builder.convex;
                          });
    double point_radius_m = is_point ? kPointRadius_m : 0.0;
    for (const int b : builders) {
      const BuilderText& builder = model_.builders[b];
      if (builder.sphere) {
        const double r = builder.sphere->radius_m;
        solids.parts.push_back(
            SolidSphere(placed.position_m, r,
                        builder.sphere->mass.Of(4.0 / 3.0 * std::numbers::pi * r * r * r, 0.0)));
        solids.bounds = Union(solids.bounds, SphereBounds(placed.position_m, r));
        robot_.solids->spheres.push_back(builder.sphere->mass.AsWritten());
        Add(robot_.def.spheres, *builder.sphere, placed.name, body, TurnOf(placed.instance))
            .center_m = placed.position_m;
      } else if (builder.point_mass) {
        const PointMassText& mass = *builder.point_mass;
        const double r = mass.radius_m > 0.0 ? mass.radius_m : point_radius_m;
        solids.parts.push_back(SolidSphere(placed.position_m, r, mass.mass_kg));
        std::optional<Inertia> own;
        if (!mass.inertia_kg_m2.empty()) {
          const std::vector<double>& i = mass.inertia_kg_m2;
          own = Turned(TurnOf(placed.instance), {i[0], i[1], i[2], i[3], i[4], i[5]});
          solids.parts.back().inertia_kg_m2 = *own;
        }
        if (is_point) point_radius_m = r;
        robot_.solids->point_masses.push_back({node, mass.mass_kg, mass.radius_m, own});
      } else if (builder.box) {
        const BoxText& box = *builder.box;
        const Vec3 size = 2.0 * box.half_extents_m;
        const Quat q_WPart = TurnOf(placed.instance);
        AddBox(solids, box, placed.name, body, q_WPart, placed.position_m, q_WPart * box.rotate,
               box.half_extents_m, box.mass.Of(size.x * size.y * size.z, 0.0));
      } else if (builder.convex) {
        AddConvex(solids, *builder.convex, placed, body);
      }
    }
    const double lump_kg = assignment_.lump_kg[node];
    if (lump_kg != 0.0) {
      solids.parts.push_back(SolidSphere(placed.position_m, point_radius_m, lump_kg));
    }
  }

  Quat TurnOf(int instance) const {
    return instance < 0 ? Quat{} : assembly_.instances[instance].q_WPart;
  }

  /// Adds a shape to a body. Directions of its surface are rotated with the part.
  template <class Def, class Text>
  static Def& Add(std::vector<Def>& shapes, const Text& text, const std::string& name, int body,
                  const Quat& q_WPart) {
    Def& def = shapes.emplace_back(text);
    def.name = name;
    def.body = body;
    if (def.material.directions) {
      Vec3& axis = def.material.directions->axis;
      axis = Rotate(q_WPart, axis);
    }
    return def;
  }

  void AddBox(Solids& solids, const BoxText& text, const std::string& name, int body,
              const Quat& q_WPart, const Vec3& center, const Quat& q, const Vec3& half,
              double mass) {
    solids.parts.push_back(SolidBox(center, q, half, mass));
    solids.bounds = Union(solids.bounds, BoxBounds(center, q, half));
    robot_.solids->boxes.push_back(text.mass.AsWritten());
    BoxDef& def = Add(robot_.def.boxes, text, name, body, q_WPart);
    def.center_m = center;
    def.orientation = q;
    def.half_extents_m = half;
  }

  void AddConvex(Solids& solids, const ConvexText& text, const PlacedNode& node, int body) {
    if (text.parts.empty()) solids.complete = false;
    const Quat q_WPart = TurnOf(node.instance);
    const auto place = [&](std::vector<Vec3> corners_m) {
      for (Vec3& p : corners_m) p = node.position_m + Rotate(q_WPart, p);
      return corners_m;
    };
    double volume_m3 = 0.0;
    for (const ConvexText::Part& part : text.parts) {
      volume_m3 += math::SixVolumes(part.corners_m, part.triangles) / 6.0;
    }
    const double density_kg_per_m3 = text.mass.Of(volume_m3, 0.0) / volume_m3;
    for (std::size_t i = 0; i < text.parts.size(); ++i) {
      const ConvexText::Part& part = text.parts[i];
      solids.parts.push_back(SolidMesh(place(part.corners_m), part.triangles, density_kg_per_m3));
      const std::string number = text.parts.size() == 1 ? "" : "_" + std::to_string(i);
      HullDef& def = Add(robot_.def.hulls, text, node.name + number, body, q_WPart);
      def.corners_m = place(part.hull_m);
      for (const Vec3& p : def.corners_m) solids.bounds.Add(p, {});
    }
    const auto read = std::find(robot_.files.begin(), robot_.files.end(), text.read_file);
    if (!text.read_file.empty() && read == robot_.files.end()) {
      robot_.files.push_back(text.read_file);
    }
  }

  void CheckMass(const Weld& weld, const Solids& solids, const BodyDef& def) {
    if (!solids.complete || std::isnan(def.mass_kg) ||
        std::isnan(def.com_m.x + def.com_m.y + def.com_m.z))
      return;
    if (def.mass_kg <= 0.0) {
      out_.Error("body.no_mass", Source(weld), "the body \"" + def.name + "\" has no mass");
      return;
    }
    const Inertia& i = def.inertia_kg_m2;
    if (!std::isfinite(i.xx + i.yy + i.zz + i.xy + i.xz + i.yz)) return;
    const Vec3 moments = PrincipalMoments(i);
    if (moments.x > 1e-12 * moments.z) return;
    out_.Error("body.no_inertia", Source(weld),
               "the body \"" + def.name + "\" has no inertia about a principal axis",
               "give the point_mass a radius_m: all mass is on one line");
  }

  void AddPin(const Pin& pin) {
    const PlacedNode& node = assembly_.nodes[pin.node];
    JointDef joint;
    joint.name = assembly_.pairs[pin.pair].name + "." + node.name;
    joint.body_a = body_of_node_[pin.node], joint.body_b = body_of_pair_[pin.pair];
    joint.from_m = joint.to_m = node.position_m;
    const PinText turns = PairBuilder(pin.pair).rod->pins.value_or(PinText());
    joint.friction = turns.friction;
    joint.stiffness = turns.stiffness, joint.damping = turns.damping;
    for (const Pin& other : pins_) {
      if (&other == &pin) break;
      if (other.node != pin.node) continue;
      robot_.def.apart.push_back({body_of_pair_[other.pair], joint.body_b});
    }
    robot_.def.joints.push_back(std::move(joint));
  }

  /// Returns the instance of the first node, or of the first rod if the body has no nodes.
  int FirstInstance(const Weld& weld) const {
    return weld.nodes.empty() ? assembly_.pairs[weld.pairs[0]].instance
                              : assembly_.nodes[weld.nodes[0]].instance;
  }
  /// Returns the instance of all nodes of the body, or -1 if the nodes are in several instances.
  int InstanceOf(const Weld& weld) const {
    const int instance = FirstInstance(weld);
    const bool same = std::all_of(weld.nodes.begin(), weld.nodes.end(), [&](int node) {
      return assembly_.nodes[node].instance == instance;
    });
    return same ? instance : -1;
  }

  /// Returns the name of the placement if the body is the whole placement; otherwise the name of
  /// the body's first rod or node.
  std::string Name(const Weld& weld) const {
    const int instance = InstanceOf(weld);
    if (instance >= 0 && bodies_in_instance_[instance] == 1) {
      const std::string& name = assembly_.instances[instance].name;
      if (!name.empty()) return name;
      if (assembly_.instances.size() == 1) return model_.name;
    }
    return weld.pairs.empty() ? assembly_.nodes[weld.nodes[0]].name
                              : assembly_.pairs[weld.pairs[0]].name;
  }

  SourceRef Source(const Weld& weld) const {
    const int instance = InstanceOf(weld);
    if (instance > 0 && bodies_in_instance_[instance] == 1) return assembly_.instances[instance].at;
    return weld.pairs.empty() ? assembly_.nodes[weld.nodes[0]].at
                              : assembly_.pairs[weld.pairs[0]].at;
  }

  const ModelText& model_;
  const Assembly& assembly_;
  const Assignment& assignment_;
  RobotSpec& robot_;
  Diagnostics& out_;
  std::vector<Weld> welds_;
  std::vector<Pin> pins_;
  std::vector<const Weld*> welds_with_body_;  ///< Weld of each body.
  std::vector<int> instance_of_body_, bodies_in_instance_;
  BodyOfNode body_of_node_;
  std::vector<int> body_of_pair_;  ///< Body of each pair that is a rod or beam.
  std::set<std::string> names_;
  OncePerPlace bodiless_, short_;
};

}  // namespace

BodyOfNode BuildBodies(const ModelText& model, const Assembly& assembly,
                       const Assignment& assignment, RobotSpec& robot, Diagnostics& out) {
  return BodyBuilder(model, assembly, assignment, robot, out).Run();
}

}  // namespace taut::description
