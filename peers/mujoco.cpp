/// MuJoCo: free bodies, spatial tendons, and for each cable one actuator that can only pull.
///
/// The actuator's force is k u - k l - b dl/dt, limited to (-inf, 0], with the control u as rest
/// length. That is paper eq. (1) but for one thing: it is the sum that is limited, so that a cable
/// that is slack and grows longer quickly, b dl/dt > k (L - l), already pulls.
#include <mujoco/mujoco.h>

#include <cstring>
#include <sstream>
#include <stdexcept>

#include "math/vec.h"
#include "peers/adapters.h"

namespace taut::peers {
namespace {

constexpr int kPlaneBit = 1, kBodyBit = 2;

std::ostream& operator<<(std::ostream& out, const Vec3& v) {
  return out << '"' << v.x << ' ' << v.y << ' ' << v.z << '"';
}

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

void WritePlanes(std::ostream& xml, const ModelDef& def) {
  for (std::size_t i = 0; i < def.planes.size(); ++i) {
    const PlaneDef& p = def.planes[i];
    // Of two geoms the one of higher priority says the friction.
    xml << "<geom type='plane' size='1 1 1' priority='1' pos=" << p.point_m << " zaxis=" << p.normal
        << " contype='" << kPlaneBit << "' conaffinity='0' friction='"
        << WithPlane(def, static_cast<int>(i)).friction << " 0 0'/>\n";
  }
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
      << "<option integrator='Euler' cone='" << (options.elliptic ? "elliptic" : "pyramidal")
      << "' gravity=" << def.gravity_m_per_s2 << "/>\n<size nconmax='" << contacts << "' njmax='"
      << 4 * contacts << "'/>\n<default><geom condim='3' friction='" << BetweenBodies(def).friction
      << " 0 0'/></default>\n<worldbody>\n";
  WritePlanes(xml, def);
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
  xml << "</actuator>\n</mujoco>\n";
  return xml.str();
}

struct Files {
  mjVFS* vfs = new mjVFS;
  Files() { mj_defaultVFS(vfs); }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;
  ~Files() {
    mj_deleteVFS(vfs);
    delete vfs;
  }
};

mjModel* Compile(const std::string& xml) {
  const Files files;
  if (mj_makeEmptyFileVFS(files.vfs, "model.xml", static_cast<int>(xml.size())) != 0) {
    throw std::runtime_error("MuJoCo has no room for the model");
  }
  std::memcpy(files.vfs->filedata[0], xml.data(), xml.size());
  char error[1000] = "";
  mjModel* const model = mj_loadXML("model.xml", files.vfs, error, sizeof error);
  if (model == nullptr) throw std::invalid_argument(std::string("MuJoCo: ") + error);
  return model;
}

class Mujoco final : public World {
 public:
  Mujoco(const ModelDef& def, const Options& options)
      : model_(Compile(Mjcf(def, options))), data_(mj_makeData(model_)) {
    mju_user_warning = [](const char*) {};  // Step looks at the warnings; no file of them
    for (std::size_t b = 0; b < def.bodies.size(); ++b) {
      const BodyDef& body = def.bodies[b];
      const Vec3 &v = body.velocity_m_per_s, &w = body.angular_velocity_rad_per_s;
      const double qvel[6] = {v.x, v.y, v.z, w.x, w.y, w.z};
      std::copy(qvel, qvel + 6, data_->qvel + 6 * b);
    }
    for (std::size_t c = 0; c < def.cables.size(); ++c)
      data_->ctrl[c] = def.cables[c].rest_length_m;
  }
  Mujoco(const Mujoco&) = delete;
  Mujoco& operator=(const Mujoco&) = delete;
  ~Mujoco() override {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }

  void Step(double step_s, int count) override {
    model_->opt.timestep = step_s;
    for (int i = 0; i < count; ++i) mj_step(model_, data_);
    measured_ = false;
    for (int kind = 0; kind < mjNWARNING; ++kind) {  // contacts that had no room, a state gone wild
      const mjWarningStat& warning = data_->warning[kind];
      if (warning.number > 0) throw std::runtime_error(mju_warningText(kind, warning.lastinfo));
    }
  }
  void SetRestLength(int cable, double rest_length_m) override {
    data_->ctrl[cable] = rest_length_m;
    measured_ = false;
  }

  CableState Cable(int cable) const override {
    Measure();
    CableState state;
    state.length_m = data_->ten_length[cable];
    state.rate_m_per_s = data_->ten_velocity[cable];
    state.rest_length_m = data_->ctrl[cable];
    state.tension_n = -data_->actuator_force[cable];
    state.stiffness_n_per_m = model_->actuator_gainprm[cable * mjNGAIN];
    state.elastic_n =
        std::max(0.0, state.stiffness_n_per_m * (state.length_m - state.rest_length_m));
    return state;
  }
  BodyState Body(int body) const override {
    const double *q = data_->qpos + 7 * body, *v = data_->qvel + 6 * body;
    const Quat turn{q[3], q[4], q[5], q[6]};
    return {{q[0], q[1], q[2]}, turn, {v[0], v[1], v[2]}, Rotate(turn, {v[3], v[4], v[5]})};
  }
  MassState Mass(int body) const override {
    Measure();
    const int i = body + 1;  // 0 is the world
    const double *p = data_->xipos + 3 * i, *j = model_->body_inertia + 3 * i;
    Rotation r;
    std::copy(data_->ximat + 9 * i, data_->ximat + 9 * i + 9, r.m);
    return {model_->body_mass[i], {p[0], p[1], p[2]}, Turned(r, {j[0], j[1], j[2]})};
  }
  int ContactCount() const override { return data_->ncon; }

 private:
  /// What is derived from positions and velocities is otherwise that of the step's start.
  void Measure() const {
    if (measured_) return;
    mj_fwdPosition(model_, data_);
    mj_fwdVelocity(model_, data_);
    mj_fwdActuation(model_, data_);
    measured_ = true;
  }
  mjModel* model_;
  mjData* data_;
  mutable bool measured_ = false;
};

}  // namespace

std::unique_ptr<World> MakeMujoco(const ModelDef& def, const Options& options) {
  return std::make_unique<Mujoco>(def, options);
}

std::string MujocoVersion() { return mj_versionString(); }

}  // namespace taut::peers
