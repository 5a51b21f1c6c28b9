// Compilation of a model definition into the tables of the simulation.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/assert.h"
#include "math/principal_axes.h"
#include "math/rotation.h"
#include "sim/compile/model_check.h"
#include "sim/contacts/combine.h"
#include "sim/data/body_frame.h"
#include "sim/data/tables.h"

namespace taut {
namespace {

using sim::Frame;
using sim::Length;
using sim::Tables;
using sim::ToBody;

/// Radius of the bounding sphere of surfaces, which have no center.
constexpr double kEverywhere_m = 1e30;

/// Converts a checked definition into tables.
class Compiler {
 public:
  explicit Compiler(Tables& t) : t_(t), def_(t.def()) {}

  void Run() {
    t_.body_count = static_cast<int>(def_.bodies.size());
    t_.cable_count = static_cast<int>(def_.cables.size());
    t_.node_count = static_cast<int>(def_.nodes.size());
    t_.plane_count = static_cast<int>(def_.planes.size());
    t_.along_slip = def_.friction_law == FrictionLaw::kAlongSlip;
    Bodies();
    sim::LayOutMotions(t_);
    sim::LayOutCables(t_, frames_);
    Nodes();
    sim::LayOutJoints(t_, frames_);
    Planes();
    Shapes();
    Points();
    sim::LayOutPairs(t_, shapes_of_, ground_);
    sim::LayOutTree(t_), sim::LayOutTouchRods(t_), sim::LayOutChainLinks(t_);
    sim::JoinBoxes(t_);
    sim::JoinPieces(t_);
    sim::LayOutMotors(t_);
    sim::LayOutFriction(t_), sim::LayOutFloor(t_);
    sim::CoupleCables(t_);
    sim::OrderWorld(t_);
    Check();
  }

 private:
  const Frame& frame(int body) const { return frames_[static_cast<std::size_t>(Index(body))]; }
  int Index(int body) const {
    TAUT_ASSERT(kWorld <= body && body < t_.body_count);
    return body == kWorld ? t_.body_count : body;
  }

  /// Asserts the invariants of the tables that the step requires.
  void Check() const {
    const auto bodies = static_cast<std::size_t>(t_.body_count);
    TAUT_ASSERT(t_.q_WP0.size() == 4 * bodies && t_.inertia.size() == 3 * bodies);
    TAUT_ASSERT(t_.bound_m.size() == bodies + 1 && t_.first_point.size() == bodies + 1);
    TAUT_ASSERT(std::is_sorted(t_.first_point.begin(), t_.first_point.end()));
    TAUT_ASSERT(t_.planes.size() <= sim::kMaxPlanes);
    TAUT_ASSERT(t_.coupling.size() == t_.cables.size());
    std::size_t attachments = 0;
    for ([[maybe_unused]] const sim::CableTable& cable : t_.cables) {
      TAUT_ASSERT(static_cast<std::size_t>(cable.first_attachment) == attachments);
      TAUT_ASSERT(cable.attachment_count >= 2);
      attachments += static_cast<std::size_t>(cable.attachment_count);
    }
    TAUT_ASSERT(attachments == t_.attachments.size());
    for ([[maybe_unused]] const sim::WorldPairTable& pair : t_.world_pairs) {
      TAUT_ASSERT(t_.Moves(pair.a) && pair.a != pair.b && pair.b <= t_.body_count);
    }
  }

  void Bodies() {
    frames_.resize(def_.bodies.size() + 1);
    for (std::size_t b = 0; b < def_.bodies.size(); ++b) {
      const BodyDef& body = def_.bodies[b];
      double moments[3] = {0, 0, 0};
      if (!body.fixed) {
        PrincipalAxes(body.inertia_kg_m2, frames_[b].r, moments);
        SymmetryAxisLast(frames_[b].r, moments);
      }
      frames_[b].origin[0] = body.com_m.x;
      frames_[b].origin[1] = body.com_m.y;
      frames_[b].origin[2] = body.com_m.z;
      const Quat q = QuatOf(frames_[b].r);
      t_.q_WP0.insert(t_.q_WP0.end(), {q.w, q.x, q.y, q.z});
      t_.inertia.insert(t_.inertia.end(), moments, moments + 3);
    }
    t_.bound_m.assign(def_.bodies.size() + 1, 0.0);
  }

  sim::AttachmentTable Attach(int body, const Vec3& p) const {
    sim::AttachmentTable a;
    a.body = Index(body);
    ToBody(frame(body), p, a.p_P);
    return a;
  }

  void Nodes() {
    for (const NodeDef& n : def_.nodes) t_.nodes.push_back(Attach(n.body, n.position_m));
  }

  void Planes() {
    for (const PlaneDef& p : def_.planes) {
      sim::PlaneTable table;
      const double n[3] = {p.normal.x, p.normal.y, p.normal.z};
      // The first tangent is the least aligned axis of W, made orthogonal to the normal.
      int axis = 0;
      for (int i = 1; i < 3; ++i) {
        if (std::fabs(n[i]) < std::fabs(n[axis])) axis = i;
      }
      double t1[3] = {-n[0] * n[axis], -n[1] * n[axis], -n[2] * n[axis]};
      t1[axis] += 1;
      const double length = Length(t1);
      for (double& x : t1) x /= length;
      const double t2[3] = {n[1] * t1[2] - n[2] * t1[1], n[2] * t1[0] - n[0] * t1[2],
                            n[0] * t1[1] - n[1] * t1[0]};
      std::copy(n, n + 3, table.normal);
      std::copy(t1, t1 + 3, table.tangent1);
      std::copy(t2, t2 + 3, table.tangent2);
      table.upright = n[2] == 1 && t1[0] == 1 && t2[1] == 1;
      table.offset_m = n[0] * p.point_m.x + n[1] * p.point_m.y + n[2] * p.point_m.z;
      t_.planes.push_back(table);
    }
  }

  void Round(const ShapeRef& ref, int body, const Vec3& from, const Vec3& to, double radius,
             const Material& material) {
    sim::ShapeTable s;
    s.body = Index(body);
    sim::RoundShape& round = s.shape_P.round;
    round.radius_m = radius;
    ToBody(frame(body), from, round.from);
    ToBody(frame(body), to, round.to);
    double half[3];
    for (int i = 0; i < 3; ++i) {
      s.center_P[i] = 0.5 * (round.from[i] + round.to[i]);
      half[i] = 0.5 * (round.to[i] - round.from[i]);
    }
    s.bound_m = Length(half) + radius;
    s.material = material;
    AddShape(s, ref);
  }

  void Box(const ShapeRef& ref, int body, const Vec3& center, const Quat& q, const Vec3& half,
           const Material& material) {
    sim::ShapeTable s;
    s.body = Index(body);
    s.shape_P.kind = sim::ShapeKind::kBox;
    sim::BoxShape& out = s.shape_P.box;
    ToBody(frame(body), center, out.center);
    std::copy(out.center, out.center + 3, s.center_P);
    double box[9];
    MatrixOf(q, box);  // columns: box axes in W
    const Frame& f = frame(body);
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = 0; i < 3; ++i) {
        out.axes[3 * axis + i] =
            f.r[i] * box[axis] + f.r[3 + i] * box[3 + axis] + f.r[6 + i] * box[6 + axis];
      }
    }
    out.half_m[0] = half.x;
    out.half_m[1] = half.y;
    out.half_m[2] = half.z;
    s.bound_m = Length(out.half_m);
    s.material = material;
    AddShape(s, ref);
  }

  void Convex(const ShapeRef& ref, const HullDef& def) {
    math::ConvexHull hull = math::HullOf(def.corners_m, sim::kMaxHullCorners);
    for (Vec3& p : hull.corners) {
      double at[3];
      ToBody(frame(def.body), p, at);
      p = {at[0], at[1], at[2]};
    }
    t_.hulls.emplace_back(std::move(hull));
    const sim::HullTable& table = t_.hulls.back().table();
    sim::ShapeTable s;
    s.body = Index(def.body);
    s.shape_P.kind = sim::ShapeKind::kHull;
    s.shape_P.hull = {&table, {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}}};
    s.center_P[0] = table.center.x, s.center_P[1] = table.center.y, s.center_P[2] = table.center.z;
    s.bound_m = table.bound_m;
    s.material = def.material;
    AddShape(s, ref);
  }

  void AddShape(const sim::ShapeTable& s, const ShapeRef& ref) {
    double& bound = t_.bound_m[static_cast<std::size_t>(s.body)];
    bound = std::max(bound, Length(s.center_P) + s.bound_m);
    shapes_of_[static_cast<std::size_t>(s.body)].push_back(t_.shapes.size());
    t_.shapes.push_back(s);
    t_.shape_refs.push_back(ref);
  }

  void AddPoints(std::size_t, const sim::SurfaceShape&, const sim::ShapeTable&) {}

  void Shapes() {
    shapes_of_.resize(def_.bodies.size() + 1);
    using List = ShapeRef::List;
    const auto each = [](List list, const auto& defs, const auto& add) {
      for (std::size_t i = 0; i < defs.size(); ++i) add({list, static_cast<int>(i)}, defs[i]);
    };
    each(List::kSpheres, def_.spheres, [&](const ShapeRef& ref, const SphereDef& s) {
      if (s.collides) Round(ref, s.body, s.center_m, s.center_m, s.radius_m, s.material);
    });
    each(List::kCapsules, def_.capsules, [&](const ShapeRef& ref, const CapsuleDef& c) {
      if (c.collides) Round(ref, c.body, c.from_m, c.to_m, c.radius_m, c.material);
    });
    each(List::kBoxes, def_.boxes, [&](const ShapeRef& ref, const BoxDef& b) {
      if (b.collides) Box(ref, b.body, b.center_m, b.orientation, b.half_extents_m, b.material);
    });
    // Shapes contain pointers to this table, so it must not be reallocated.
    t_.hulls.reserve(def_.hulls.size());
    each(List::kHulls, def_.hulls, [&](const ShapeRef& ref, const HullDef& h) {
      if (h.collides) Convex(ref, h);
    });
    each(List::kTerrainBoxes, def_.terrain_boxes, [&](const ShapeRef& ref, const TerrainBoxDef& b) {
      Box(ref, kWorld, b.center_m, b.orientation, b.half_extents_m, b.material);
    });
    // Shapes contain pointers to the surfaces, too, so this table must not be reallocated.
    t_.surfaces.reserve(def_.height_fields.size() + def_.terrain_meshes.size());
    each(List::kHeightFields, def_.height_fields, [&](const ShapeRef& ref, const auto& field) {
      Ground(ref, sim::Surface(field), field.material);
    });
    each(List::kTerrainMeshes, def_.terrain_meshes, [&](const ShapeRef& ref, const auto& mesh) {
      Ground(ref, sim::Surface(mesh), mesh.material);
    });
  }

  /// Adds a surface of the terrain. Every pair of a shape and a surface has a separate clearance,
  /// so that the contact of a body's lowest rod does not cause tests of its other rods.
  void Ground(const ShapeRef& ref, sim::Surface surface, const Material& material) {
    t_.surfaces.push_back(std::move(surface));
    sim::ShapeTable s;
    s.body = t_.body_count;
    s.shape_P.kind = sim::ShapeKind::kSurface;
    s.shape_P.surface.table = &t_.surfaces.back().table();
    s.bound_m = kEverywhere_m;
    s.material = material;
    ground_.push_back(t_.shapes.size());
    t_.shapes.push_back(s);
    t_.shape_refs.push_back(ref);
  }

  /// Collects the points that can touch planes. Of several points at the same place, only the
  /// thickest is kept; spheres come first. Therefore ends of rods at the sphere of a node add no
  /// points, also not on other ground.
  void Points() {
    for (int body = 0; body < t_.body_count; ++body) {
      t_.first_point.push_back(static_cast<int>(t_.points.size()));
      if (def_.bodies[static_cast<std::size_t>(body)].fixed) continue;
      const std::size_t first = t_.points.size();
      for (const std::size_t number : shapes_of_[static_cast<std::size_t>(body)]) {
        sim::ShapeTable& s = t_.shapes[number];
        WithShape(s.shape_P, [&](const auto& shape) { AddPoints(first, shape, s); });
        t_.shape_of_point.resize(t_.points.size(), static_cast<int>(number));
      }
    }
    t_.first_point.push_back(static_cast<int>(t_.points.size()));
    t_.first_pair_id = static_cast<std::uint32_t>(t_.points.size() * t_.planes.size());
  }

  void AddPoints(std::size_t first, const sim::RoundShape& s, sim::ShapeTable& table) {
    for (int end = 0; end < 2; ++end) {
      const std::size_t before = t_.points.size();
      const double* const p = end == 0 ? s.from : s.to;
      table.point[end] = AddPoint(first, p, s.radius_m, table.material);
      table.elsewhere[end] = t_.points.size() == before;
    }
  }

  void AddPoints(std::size_t first, const sim::BoxShape& s, const sim::ShapeTable& table) {
    for (int corner = 0; corner < 8; ++corner) {
      double p[3];
      for (int i = 0; i < 3; ++i) {
        p[i] = s.center[i];
        for (int axis = 0; axis < 3; ++axis) {
          p[i] += ((corner >> axis) & 1 ? 1 : -1) * s.half_m[axis] * s.axes[3 * axis + i];
        }
      }
      AddPoint(first, p, 0.0, table.material);
    }
  }

  void AddPoints(std::size_t first, const sim::HullShape& s, const sim::ShapeTable& table) {
    for (int i = 0; i < s.table->corner_count; ++i) {
      const Vec3& corner = s.table->corners[i];
      const double p[3] = {corner.x, corner.y, corner.z};
      AddPoint(first, p, 0.0, table.material);
    }
  }

  /// Returns the number of a point; adds it if it does not exist yet.
  int AddPoint(std::size_t first, const double p[3], double radius, const Material& material) {
    for (std::size_t i = first; i < t_.points.size(); ++i) {
      const sim::PointTable& other = t_.points[i];
      const double d[3] = {p[0] - other.p_P[0], p[1] - other.p_P[1], p[2] - other.p_P[2]};
      if (Length(d) <= 1e-9 && radius <= other.radius_m) return static_cast<int>(i);
    }
    sim::PointTable point;
    std::copy(p, p + 3, point.p_P);
    point.radius_m = radius;
    for (std::size_t k = 0; k < def_.planes.size(); ++k) {
      const sim::Coefficients both = sim::Combined(def_, material, def_.planes[k].material);
      point.static_friction[k] = both.static_friction;
      point.kinetic_friction[k] = both.kinetic_friction;
      point.restitution[k] = both.restitution;
    }
    t_.points.push_back(point);
    return static_cast<int>(t_.points.size()) - 1;
  }

  Tables& t_;
  const ModelDef& def_;
  std::vector<Frame> frames_;
  /// Indices of the shapes of each body and of the world, without surfaces.
  std::vector<std::vector<std::size_t>> shapes_of_;
  std::vector<std::size_t> ground_;  ///< Indices of the surfaces among the shapes.
};

}  // namespace

std::shared_ptr<const Model> Model::Compile(const ModelDef& def, Diagnostics& out) {
  if (!def.experiment_parts.empty()) {
    out.Warning("model.experiment_left_out", {},
                "the experiment has " + def.experiment_parts + ", which a batch ignores",
                "to run them, use Simulation; to suppress this warning, clear "
                "ModelDef::experiment_parts or, in Python, pass experiment.robot");
  }
  return CompileForExperiment(def, out);
}

std::shared_ptr<const Model> Model::CompileForExperiment(const ModelDef& def, Diagnostics& out) {
  if (!sim::CheckModel(def, out) || !sim::CheckEnvironment(out)) return nullptr;
  auto tables = std::make_shared<Tables>(def);
  Compiler(*tables).Run();
  return tables;
}

}  // namespace taut
