// Writer of a model as MJCF text. docs/from_mujoco.md describes the conversion of quantities.
#include "mjcf/write.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/unique_names.h"
#include "description/yaml/reader.h"
#include "math/vec.h"
#include "taut/shape_kinds.h"

namespace taut::mjcf {
namespace {

using description::Shown;

constexpr int kPlaneBit = 1, kBodyBit = 2;

std::string List(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : " ") + Shown(value);
  return text;
}
std::string Numbers(const Vec3& v) { return List({v.x, v.y, v.z}); }
std::string Numbers(const Quat& q) { return List({q.w, q.x, q.y, q.z}); }
/// Returns ` key="value"`.
std::string Key(const char* key, const std::string& value) {
  return std::string(" ") + key + "=\"" + value + '"';
}
std::string TurnKey(const Quat& q) {
  const bool turned = q.x != 0 || q.y != 0 || q.z != 0;
  return turned ? Key("quat", Numbers(q)) : "";
}

class Writer {
 public:
  Writer(const ModelDef& def, const WriteOptions& options)
      : def_(def),
        options_(options),
        geoms_(GeomsOf(def)),
        friction_(FrictionsOf(def, geoms_)),
        site_of_(def.cables.size()) {
    unique_bodies_.Take("world");  // MuJoCo's name of the static body
  }

  std::string Text() {
    xml_ << "<mujoco" << Key("model", def_.name.empty() ? "unnamed" : def_.name) << ">\n"
         << "<compiler angle=\"radian\" inertiafromgeom=\"false\" boundmass=\"0\" "
            "boundinertia=\"0\"/>\n";
    Settings();
    Assets();
    NameSites();
    xml_ << "<worldbody>\n";
    Grounds();
    Sites(kWorld);
    for (std::size_t b = 0; b < def_.bodies.size(); ++b) Body(static_cast<int>(b));
    xml_ << "</worldbody>\n";
    Contacts();
    Tendons();
    if (options_.cables == MjcfCables::kActuator) Actuators();
    if (options_.keyframe) Start();
    xml_ << "</mujoco>\n";
    return xml_.str();
  }

 private:
  Vec3 Com(int body) const {
    return body == kWorld ? Vec3{} : def_.bodies[static_cast<std::size_t>(body)].com_m;
  }

  void Settings() {
    xml_ << "<option" << (options_.elliptic ? Key("cone", "elliptic") : Key("cone", "pyramidal"))
         << Key("gravity", Numbers(def_.gravity_m_per_s2));
    if (options_.as_peer) {  // defaults of MuJoCo 2; later versions have other defaults
      xml_ << Key("solver", "Newton") << Key("iterations", "100") << Key("tolerance", "1e-8")
           << Key("integrator", "Euler");
    } else {
      xml_ << Key("timestep", "0.001");
    }
    xml_ << "/>\n";
    if (options_.as_peer) {
      // Bodies with many shapes, such as a disc on feet, need more contacts. A larger default would
      // waste memory, which grows with the square of this number.
      const std::size_t usual = 12 * def_.bodies.size(),
                        shapes = def_.capsules.size() + def_.spheres.size() + def_.boxes.size(),
                        contacts = 100 + usual + 8 * (shapes > usual ? shapes - usual : 0);
      xml_ << "<size nconmax=\"" << contacts << "\" njmax=\"" << 4 * contacts << "\"/>\n";
    }
    xml_ << "<default><geom condim=\"3\"" << FrictionKey(DefaultFriction()) << "/></default>\n";
  }
  static std::string FrictionKey(double friction) {
    return Key("friction", Shown(friction) + " 0 0");
  }
  double DefaultFriction() const {
    Material material;
    material.kinetic_friction = friction_.shape;
    return FrictionOf(def_, material, material);
  }

  template <class Shape>
  void Mesh(const Shape&, const std::string&) {}
  void Mesh(const HullDef& hull, const std::string& name) {
    std::string corners;
    for (const Vec3& p : hull.corners_m) {
      corners += (corners.empty() ? "" : " ") + Numbers(p - Com(hull.body));
    }
    xml_ << "<mesh" << Key("name", name) << Key("vertex", corners) << "/>\n";
  }

  void Assets() {
    if (def_.hulls.empty() && def_.height_fields.empty()) return;
    xml_ << "<asset>\n";
    std::size_t geom = 0;
    EachShape(def_, [&](const auto& shape) { Mesh(shape, geoms_.shapes[geom++].name); });
    for (std::size_t i = 0; i < def_.height_fields.size(); ++i) {
      constexpr double kBase_m = 1;
      const HeightFieldDef& field = def_.height_fields[i];
      xml_ << "<hfield" << Key("name", geoms_.height_fields[i].name) << " nrow=\"" << field.rows
           << "\" ncol=\"" << field.columns << '"'
           << Key("size", List({0.5 * (field.columns - 1) * field.cell_m,
                                0.5 * (field.rows - 1) * field.cell_m,
                                RiseOf(mechanics::HeightsOf(field)), kBase_m}))
           << "/>\n";
    }
    xml_ << "</asset>\n";
  }

  void Ground(const Geoms::Geom& geom, const std::string& shape) {
    xml_ << "<geom" << Key("name", geom.name) << shape
         << (friction_.grounds_rule ? Key("priority", "1") : "")
         << Key("contype", std::to_string(geom.is_plane ? kPlaneBit : kBodyBit))
         << Key("conaffinity", "0") << FrictionKey(OwnFriction(def_, friction_, geom)) << "/>\n";
  }
  void Grounds() {
    for (std::size_t i = 0; i < def_.planes.size(); ++i) {
      const PlaneDef& p = def_.planes[i];
      const bool level = p.normal.x == 0 && p.normal.y == 0 && p.normal.z > 0;
      Ground(geoms_.planes[i], Key("type", "plane") + Key("size", "1 1 1") +
                                   Key("pos", Numbers(p.point_m)) +
                                   (level ? "" : Key("zaxis", Numbers(p.normal))));
    }
    for (std::size_t i = 0; i < def_.terrain_boxes.size(); ++i) {
      const TerrainBoxDef& b = def_.terrain_boxes[i];
      Ground(geoms_.terrain_boxes[i], Key("type", "box") + Key("pos", Numbers(b.center_m)) +
                                          TurnKey(b.orientation) +
                                          Key("size", Numbers(b.half_extents_m)));
    }
    for (std::size_t i = 0; i < def_.height_fields.size(); ++i) {
      const HeightFieldDef& f = def_.height_fields[i];
      const std::string& name = geoms_.height_fields[i].name;
      const Vec3 lowest = f.origin_m + Vec3{0, 0, mechanics::HeightsOf(f).least_m};
      Ground(geoms_.height_fields[i],
             Key("type", "hfield") + Key("hfield", name) + Key("pos", Numbers(lowest)));
    }
  }

  /// Defines sites: the nodes, plus one site for each cable attachment that is not at a node.
  void NameSites() {
    base::UniqueNames names;
    for (const NodeDef& node : def_.nodes) {
      sites_.push_back({names.Take(node.name), node.body, node.position_m});
    }
    const std::size_t nodes = sites_.size();
    for (std::size_t c = 0; c < def_.cables.size(); ++c) {
      const CableDef& cable = def_.cables[c];
      for (std::size_t i = 0; i < cable.attachments.size(); ++i) {
        const AttachmentDef& at = cable.attachments[i];
        std::size_t site = 0;
        while (site < nodes &&
               !(sites_[site].body == at.body && Same(sites_[site].p, at.position_m))) {
          ++site;
        }
        if (site == nodes) {
          site = sites_.size();
          sites_.push_back(
              {names.Take(cable.name + "_" + std::to_string(i)), at.body, at.position_m});
        }
        site_of_[c].push_back(site);
      }
    }
    for (const JointDef& bar : def_.joints) {
      bar_sites_.push_back(sites_.size());
      sites_.push_back({names.Take(bar.name + "_from"), bar.body_a, bar.from_m});
      sites_.push_back({names.Take(bar.name + "_to"), bar.body_b, bar.to_m});
    }
  }
  static bool Same(const Vec3& a, const Vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

  void Sites(int body) {
    for (const Site& site : sites_) {
      if (site.body != body) continue;
      xml_ << "<site" << Key("name", site.name) << Key("pos", Numbers(site.p - Com(body)))
           << "/>\n";
    }
  }

  void Body(int b) {
    const BodyDef& body = def_.bodies[static_cast<std::size_t>(b)];
    xml_ << "<body" << Key("name", BodyName(b)) << Key("pos", Numbers(body.com_m)) << ">\n";
    if (!body.fixed) {
      const Inertia& j = body.inertia_kg_m2;
      xml_ << "<freejoint/>\n<inertial pos=\"0 0 0\"" << Key("mass", Shown(body.mass_kg))
           << Key("fullinertia", List({j.xx, j.yy, j.zz, j.xy, j.xz, j.yz})) << "/>\n";
    }
    Shapes(b);
    Sites(b);
    xml_ << "</body>\n";
  }
  std::string BodyName(int b) {
    while (body_names_.size() <= static_cast<std::size_t>(b)) {
      body_names_.push_back(unique_bodies_.Take(def_.bodies[body_names_.size()].name));
    }
    return body_names_[static_cast<std::size_t>(b)];
  }

  void Shapes(int body) {
    std::size_t geom = 0;
    EachShape(def_, [&](const auto& shape) {
      if (shape.body == body) Geom(geoms_.shapes[geom], ShapeKeys(shape, geoms_.shapes[geom].name));
      ++geom;
    });
  }
  std::string ShapeKeys(const SphereDef& s, const std::string&) const {
    return Key("type", "sphere") + Key("pos", Numbers(s.center_m - Com(s.body))) +
           Key("size", Shown(s.radius_m));
  }
  std::string ShapeKeys(const CapsuleDef& c, const std::string&) const {
    const Vec3 com = Com(c.body);
    return Key("type", "capsule") +
           Key("fromto", Numbers(c.from_m - com) + " " + Numbers(c.to_m - com)) +
           Key("size", Shown(c.radius_m));
  }
  std::string ShapeKeys(const BoxDef& b, const std::string&) const {
    return Key("type", "box") + Key("pos", Numbers(b.center_m - Com(b.body))) +
           TurnKey(b.orientation) + Key("size", Numbers(b.half_extents_m));
  }
  std::string ShapeKeys(const HullDef&, const std::string& name) const {
    return Key("type", "mesh") + Key("mesh", name);
  }
  void Geom(const Geoms::Geom& geom, const std::string& shape) {
    const double friction = OwnFriction(def_, friction_, geom);
    if (options_.as_peer && !geom.meets_planes && !geom.meets_bodies) return;
    xml_ << "<geom" << Key("name", geom.name) << shape
         << Key("contype", std::to_string(geom.meets_bodies ? kBodyBit : 0))
         << Key("conaffinity", std::to_string((geom.meets_planes ? kPlaneBit : 0) +
                                              (geom.meets_bodies ? kBodyBit : 0)))
         << (friction == DefaultFriction() ? "" : FrictionKey(friction)) << "/>\n";
  }

  void Contacts() {
    const auto apart = KeptApart(def_);
    if (apart.empty() && friction_.pairs.empty()) return;
    xml_ << "<contact>\n";
    for (const Friction::Pair& pair : friction_.pairs) {
      xml_ << "<pair" << Key("geom1", pair.geom1) << Key("geom2", pair.geom2) << " condim=\"3\""
           << Key("friction", List({pair.friction, pair.friction, 0, 0, 0})) << "/>\n";
    }
    for (const auto& [a, b] : apart) {
      if (a == kWorld || b == kWorld) continue;
      xml_ << "<exclude" << Key("body1", BodyName(a)) << Key("body2", BodyName(b)) << "/>\n";
    }
    xml_ << "</contact>\n";
  }

  void Tendons() {
    if (def_.cables.empty() && def_.joints.empty()) return;
    base::UniqueNames names;
    xml_ << "<tendon>\n";
    for (std::size_t c = 0; c < def_.cables.size(); ++c) {
      const CableDef& cable = def_.cables[c];
      tendons_.push_back(names.Take(cable.name));
      xml_ << "<spatial" << Key("name", tendons_.back());
      if (options_.cables == MjcfCables::kSpring) {
        xml_ << Key("springlength", "0 " + Shown(cable.rest_length_m))
             << Key("stiffness", Shown(cable.stiffness_n_per_m))
             << Key("damping", Shown(cable.damping_n_s_per_m));
      }
      xml_ << ">";
      for (const std::size_t site : site_of_[c]) {
        xml_ << "<site" << Key("site", sites_[site].name) << "/>";
      }
      xml_ << "</spatial>\n";
    }
    for (std::size_t j = 0; j < def_.joints.size(); ++j) {
      const JointDef& bar = def_.joints[j];
      xml_ << "<spatial" << Key("name", names.Take(bar.name))
           << Key("springlength", Shown(bar.rest)) << Key("stiffness", Shown(bar.stiffness))
           << Key("damping", Shown(bar.damping)) << "><site"
           << Key("site", sites_[bar_sites_[j]].name) << "/><site"
           << Key("site", sites_[bar_sites_[j] + 1].name) << "/></spatial>\n";
    }
    xml_ << "</tendon>\n";
  }

  /// Writes actuators with the push k u - k l - b dl/dt, limited to values <= 0. u is the rest
  /// length.
  void Actuators() {
    if (def_.cables.empty()) return;
    xml_ << "<actuator>\n";
    for (std::size_t c = 0; c < def_.cables.size(); ++c) {
      const CableDef& cable = def_.cables[c];
      const double k = cable.stiffness_n_per_m, b = cable.damping_n_s_per_m,
                   at_zero = options_.keyframe ? 0 : k * cable.rest_length_m;
      xml_ << "<general" << Key("name", tendons_[c]) << Key("tendon", tendons_[c])
           << Key("gainprm", Shown(k)) << Key("biastype", "affine")
           << Key("biasprm", List({at_zero, -k, -b}))
           << " ctrllimited=\"false\" forcelimited=\"true\" forcerange=\"-1e12 0\"/>\n";
    }
    xml_ << "</actuator>\n";
  }

  /// Writes initial velocities and rest lengths. Without poses in the keyframe, MuJoCo uses the
  /// bodies' poses.
  void Start() {
    std::vector<double> speeds, controls;
    for (const BodyDef& body : def_.bodies) {
      if (body.fixed) continue;
      const Vec3 &v = body.velocity_m_per_s, &w = body.angular_velocity_rad_per_s;
      speeds.insert(speeds.end(), {v.x, v.y, v.z, w.x, w.y, w.z});
    }
    for (const CableDef& cable : def_.cables) controls.push_back(cable.rest_length_m);
    xml_ << "<keyframe><key name=\"start\"" << (speeds.empty() ? "" : Key("qvel", List(speeds)))
         << (controls.empty() ? "" : Key("ctrl", List(controls))) << "/></keyframe>\n";
  }

  struct Site {
    std::string name;
    int body;
    Vec3 p;
  };
  const ModelDef& def_;
  const WriteOptions& options_;
  const Geoms geoms_;
  const Friction friction_;
  std::ostringstream xml_;
  std::vector<Site> sites_;
  std::vector<std::vector<std::size_t>> site_of_;  ///< Site of each attachment, per cable.
  std::vector<std::size_t> bar_sites_;             ///< Index of the first of a bar's two sites, per
                                                   ///< joint.
  std::vector<std::string> tendons_, body_names_;
  base::UniqueNames unique_bodies_;
};

}  // namespace

double RiseOf(const mechanics::HeightRange& range) {
  return std::max(range.most_m - range.least_m, 1e-3);
}

std::string Text(const ModelDef& def, const WriteOptions& options) {
  return Writer(def, options).Text();
}

}  // namespace taut::mjcf

namespace taut {

std::optional<std::string> ExportMjcf(const ModelDef& def, const MjcfExport& options,
                                      Diagnostics& out) {
  const std::size_t errors_before = out.items().size();
  const mjcf::WriteOptions all{options};
  mjcf::RefuseWhatMjcfLacks(def, all, out);
  if (out.items().size() != errors_before) return std::nullopt;
  mjcf::WarnOfWhatIsLeftOut(def, all, out);
  return mjcf::Text(def, all);
}

}  // namespace taut
