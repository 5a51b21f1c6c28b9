/// The MuJoCo peer as text: what mujoco.cpp compiles, and what a program with another version of
/// MuJoCo can load. Needs no MuJoCo.
#include <algorithm>
#include <sstream>

#include "math/vec.h"
#include "peers/adapters.h"

namespace taut::peers {
namespace {

constexpr int kPlaneBit = 1, kBodyBit = 2;

std::ostream& operator<<(std::ostream& out, const Vec3& v) {
  return out << '"' << v.x << ' ' << v.y << ' ' << v.z << '"';
}

/// MuJoCo wants it above 0.
double Rise(const Range& range) { return std::max(range.most_m - range.least_m, 1e-3); }

void WriteShapes(std::ostream& xml, const std::vector<Shape>& shapes, int body) {
  for (const Shape& s : shapes) {
    if (s.body != body) continue;
    if (s.kind == Shape::Kind::kBox) {
      const Quat q = QuatOf(s.turn);
      xml << "<geom type='box' pos=" << s.center_m << " quat='" << q.w << ' ' << q.x << ' ' << q.y
          << ' ' << q.z << "' size=" << s.half_extents_m;
    } else if (s.kind == Shape::Kind::kCapsule) {
      const Vec3 half = s.half_length_m * (s.turn * Vec3{0, 0, 1});
      const Vec3 a = s.center_m - half, b = s.center_m + half;
      xml << "<geom type='capsule' fromto='" << a.x << ' ' << a.y << ' ' << a.z << ' ' << b.x << ' '
          << b.y << ' ' << b.z << "' size='" << s.radius_m << "'";
    } else {
      xml << "<geom type='sphere' pos=" << s.center_m << " size='" << s.radius_m << "'";
    }
    xml << " contype='" << (s.meets_bodies ? kBodyBit : 0) << "' conaffinity='"
        << (s.meets_planes ? kPlaneBit : 0) + (s.meets_bodies ? kBodyBit : 0) << "'/>\n";
  }
}

void WriteSites(std::ostream& xml, const ModelDef& def, int body) {
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    const std::vector<AttachmentDef>& ends = def.cables[c].attachments;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      if (ends[i].body != body) continue;
      const Vec3 origin =
          body == kWorld ? Vec3{} : def.bodies[static_cast<std::size_t>(body)].com_m;
      xml << "<site name='s" << c << '_' << i << "' pos=" << ends[i].position_m - origin << "/>\n";
    }
  }
}

void WriteGround(std::ostream& xml, const ModelDef& def) {
  // Of two geoms the one of higher priority says the friction.
  const auto write = [&](const Material& material, int bit) {
    xml << " priority='1' contype='" << bit << "' conaffinity='0' friction='"
        << WithGround(def, material).friction << " 0 0'/>\n";
  };
  for (const PlaneDef& p : def.planes) {
    xml << "<geom type='plane' size='1 1 1' pos=" << p.point_m << " zaxis=" << p.normal;
    write(p.material, kPlaneBit);
  }
  for (const HeightFieldDef& f : def.height_fields) {
    xml << "<geom type='hfield' hfield='field' pos="
        << f.origin_m + Vec3{0, 0, HeightsOf(f).least_m};
    write(f.material, kBodyBit);
  }
}

/// How large a field is: its heights are put in when the model is loaded (MujocoHeights).
void WriteField(std::ostream& xml, const HeightFieldDef& field) {
  constexpr double kBase_m = 1;
  const Range range = HeightsOf(field);
  xml << "<asset><hfield name='field' nrow='" << field.rows << "' ncol='" << field.columns
      << "' size='" << 0.5 * (field.columns - 1) * field.cell_m << ' '
      << 0.5 * (field.rows - 1) * field.cell_m << ' ' << Rise(range) << ' ' << kBase_m
      << "'/></asset>\n";
}

/// Speeds and rest lengths of the start. What is not named, the poses, is as in the bodies.
void WriteStart(std::ostream& xml, const ModelDef& def) {
  const char* before =
      "<keyframe><key name='start' qvel='";  // MuJoCo stumbles over a blank at the end
  const auto write = [&](double value) {
    xml << before << value;
    before = " ";
  };
  for (const BodyDef& body : def.bodies) {
    const Vec3 &v = body.velocity_m_per_s, &w = body.angular_velocity_rad_per_s;
    for (const double value : {v.x, v.y, v.z, w.x, w.y, w.z}) write(value);
  }
  if (!def.cables.empty()) before = "' ctrl='";
  for (const CableDef& cable : def.cables) write(cable.rest_length_m);
  xml << "'/></keyframe>\n";
}

}  // namespace

std::vector<float> MujocoHeights(const HeightFieldDef& field) {
  const Range range = HeightsOf(field);
  std::vector<float> heights;
  for (const double z : field.height_m) {
    heights.push_back(static_cast<float>((z - range.least_m) / Rise(range)));
  }
  return heights;
}

std::string Mjcf(const ModelDef& def, const Options& options) {
  const std::vector<Shape> shapes = ShapesOf(def);
  // Bodies of many shapes, a disc on feet, need more; but its memory grows with the square of this.
  const std::size_t usual = 12 * def.bodies.size();
  const std::size_t contacts =
      100 + usual + 8 * (shapes.size() > usual ? shapes.size() - usual : 0);
  std::ostringstream xml;
  xml.precision(17);
  xml << "<mujoco>\n<compiler angle='radian' inertiafromgeom='false' boundmass='0' "
         "boundinertia='0'/>\n"
      // the solver's are the defaults of MuJoCo 2, for versions that may have others
      << "<option solver='Newton' iterations='100' tolerance='1e-8' integrator='Euler' cone='"
      << (options.elliptic ? "elliptic" : "pyramidal") << "' gravity=" << def.gravity_m_per_s2
      << "/>\n<size nconmax='" << contacts << "' njmax='" << 4 * contacts
      << "'/>\n<default><geom condim='3' friction='" << BetweenBodies(def).friction
      << " 0 0'/></default>\n";
  for (const HeightFieldDef& field : def.height_fields) WriteField(xml, field);
  xml << "<worldbody>\n";
  WriteGround(xml, def);
  WriteSites(xml, def, kWorld);
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    const BodyDef& body = def.bodies[b];
    const Inertia& j = body.inertia_kg_m2;
    xml << "<body pos=" << body.com_m << "><freejoint/><inertial pos='0 0 0' mass='" << body.mass_kg
        << "' fullinertia='" << j.xx << ' ' << j.yy << ' ' << j.zz << ' ' << j.xy << ' ' << j.xz
        << ' ' << j.yz << "'/>\n";
    WriteShapes(xml, shapes, static_cast<int>(b));
    WriteSites(xml, def, static_cast<int>(b));
    xml << "</body>\n";
  }
  xml << "</worldbody>\n<tendon>\n";
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    xml << "<spatial name='t" << c << "'>";
    for (std::size_t i = 0; i < def.cables[c].attachments.size(); ++i) {
      xml << "<site site='s" << c << '_' << i << "'/>";
    }
    xml << "</spatial>\n";
  }
  xml << "</tendon>\n<actuator>\n";
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    const double k = def.cables[c].stiffness_n_per_m, b = def.cables[c].damping_n_s_per_m;
    xml << "<general tendon='t" << c << "' gainprm='" << k << "' biastype='affine' biasprm='0 "
        << -k << ' ' << -b << "' ctrllimited='false' forcelimited='true' forcerange='-1e12 0'/>\n";
  }
  xml << "</actuator>\n";
  WriteStart(xml, def);
  xml << "</mujoco>\n";
  return xml.str();
}

}  // namespace taut::peers
