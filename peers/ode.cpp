/// ODE: geoms with offsets on each body, cables as forces on the bodies before each step.
#include <ode/ode.h>

#include <array>
#include <mutex>
#include <stdexcept>

#include "math/vec.h"
#include "peers/adapters.h"

namespace taut::peers {
namespace {

constexpr unsigned long kPlaneBit = 1, kBodyBit = 2;

/// ODE's rotation matrices have four columns.
Rotation Ours(const dReal* m) { return {{m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]}}; }
Vec3 OursVector(const dReal* v) { return {v[0], v[1], v[2]}; }

void Initialize() {
  static std::once_flag once;
  std::call_once(once, [] { dInitODE2(0); });
}

class Ode final : public World {
 public:
  Ode(const ModelDef& def, const Options& options)
      : full_step_(options.full_step),
        springs_(def),
        poses_(def.bodies.size()),
        loads_(def.bodies.size()) {
    static_assert(sizeof(dReal) == sizeof(double));
    Initialize();
    world_ = dWorldCreate();
    space_ = dSimpleSpaceCreate(nullptr);
    contacts_ = dJointGroupCreate(0);
    const Vec3& g = def.gravity_m_per_s2;
    dWorldSetGravity(world_, g.x, g.y, g.z);
    dWorldSetQuickStepNumIterations(world_, options.iterations);
    between_bodies_ = BetweenBodies(def);
    for (std::size_t i = 0; i < def.planes.size(); ++i) {
      const PlaneDef& p = def.planes[i];
      const dGeomID plane =
          dCreatePlane(space_, p.normal.x, p.normal.y, p.normal.z, Dot(p.normal, p.point_m));
      dGeomSetCategoryBits(plane, kPlaneBit);
      dGeomSetCollideBits(plane, 0);
      with_plane_.push_back(WithPlane(def, static_cast<int>(i)));
    }
    for (std::size_t i = 0; i < with_plane_.size(); ++i) {
      dGeomSetData(dSpaceGetGeom(space_, static_cast<int>(i)), &with_plane_[i]);
    }
    const std::vector<Shape> shapes = ShapesOf(def);
    for (std::size_t b = 0; b < def.bodies.size(); ++b) AddBody(def, static_cast<int>(b), shapes);
    Look();
  }
  Ode(const Ode&) = delete;
  Ode& operator=(const Ode&) = delete;
  ~Ode() override {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }

  void Step(double step_s, int count) override {
    for (int i = 0; i < count; ++i) {
      springs_.Pull(poses_, loads_);
      for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const Vec3 &f = loads_[b].force_n, &t = loads_[b].torque_n_m;
        dBodyAddForce(bodies_[b], f.x, f.y, f.z);
        dBodyAddTorque(bodies_[b], t.x, t.y, t.z);
      }
      contact_count_ = 0;
      dSpaceCollide(space_, this, Near);
      const int done = full_step_ ? dWorldStep(world_, step_s) : dWorldQuickStep(world_, step_s);
      if (done == 0) throw std::runtime_error("ODE has no memory for a step");
      dJointGroupEmpty(contacts_);
      Look();
    }
  }
  void SetRestLength(int cable, double rest_length_m) override {
    springs_.SetRestLength(cable, rest_length_m);
  }
  CableState Cable(int cable) const override { return springs_.State(cable, poses_); }
  BodyState Body(int body) const override {
    const Pose& pose = poses_[static_cast<std::size_t>(body)];
    return {pose.p, QuatOf(pose.r), pose.v, pose.w};
  }
  MassState Mass(int body) const override {
    const dBodyID id = bodies_[static_cast<std::size_t>(body)];
    dMass mass;
    dBodyGetMass(id, &mass);
    const Rotation r = poses_[static_cast<std::size_t>(body)].r;
    const Rotation j = r * Ours(mass.I) * Transposed(r);
    return {mass.mass,
            OursVector(dBodyGetPosition(id)) + r * OursVector(mass.c),
            {j.m[0], j.m[4], j.m[8], j.m[1], j.m[2], j.m[5]}};
  }
  int ContactCount() const override { return contact_count_; }

 private:
  void AddBody(const ModelDef& def, int index, const std::vector<Shape>& shapes) {
    const BodyDef& body = def.bodies[static_cast<std::size_t>(index)];
    const dBodyID id = dBodyCreate(world_);
    const Vec3 &p = body.com_m, &v = body.velocity_m_per_s, &w = body.angular_velocity_rad_per_s;
    const Inertia& j = body.inertia_kg_m2;
    dMass mass;
    dMassSetParameters(&mass, body.mass_kg, 0, 0, 0, j.xx, j.yy, j.zz, j.xy, j.xz, j.yz);
    dBodySetMass(id, &mass);
    dBodySetPosition(id, p.x, p.y, p.z);
    dBodySetLinearVel(id, v.x, v.y, v.z);
    dBodySetAngularVel(id, w.x, w.y, w.z);
    bodies_.push_back(id);
    const dSpaceID own = dSimpleSpaceCreate(space_);  // so that bodies are told apart at once
    for (const Shape& s : shapes) {
      if (s.body != index) continue;
      const dGeomID geom = GeomOf(own, s);
      dGeomSetBody(geom, id);
      dGeomSetOffsetPosition(geom, s.center_m.x, s.center_m.y, s.center_m.z);
      const Rotation& r = s.turn;
      const dMatrix3 turn = {r.m[0], r.m[1], r.m[2], 0,      r.m[3], r.m[4],
                             r.m[5], 0,      r.m[6], r.m[7], r.m[8], 0};
      dGeomSetOffsetRotation(geom, turn);
      dGeomSetCategoryBits(geom, s.meets_bodies ? kBodyBit : 0);
      dGeomSetCollideBits(geom, (s.meets_planes ? kPlaneBit : 0) | (s.meets_bodies ? kBodyBit : 0));
    }
  }

  static dGeomID GeomOf(dSpaceID space, const Shape& s) {
    const Vec3& half = s.half_extents_m;
    switch (s.kind) {
      case Shape::Kind::kSphere:
        return dCreateSphere(space, s.radius_m);
      case Shape::Kind::kCapsule:
        return dCreateCapsule(space, s.radius_m, 2 * s.half_length_m);
      default:
        return dCreateBox(space, 2 * half.x, 2 * half.y, 2 * half.z);
    }
  }

  static void Near(void* self, dGeomID a, dGeomID b) { static_cast<Ode*>(self)->Touch(a, b); }

  void Touch(dGeomID a, dGeomID b) {
    if (dGeomIsSpace(a) != 0 || dGeomIsSpace(b) != 0) {
      dSpaceCollide2(a, b, this, Near);
      return;
    }
    std::array<dContact, 8> found;  // as many as two boxes can have
    const int count =
        dCollide(a, b, static_cast<int>(found.size()), &found[0].geom, sizeof(dContact));
    const void* const plane = dGeomGetData(a) != nullptr ? dGeomGetData(a) : dGeomGetData(b);
    const Contact& how = plane != nullptr ? *static_cast<const Contact*>(plane) : between_bodies_;
    for (int i = 0; i < count; ++i) {
      dContact& contact = found[static_cast<std::size_t>(i)];
      contact.surface = {};
      contact.surface.mode = dContactApprox1 | (how.restitution > 0 ? dContactBounce : 0);
      contact.surface.mu = how.friction;
      contact.surface.bounce = how.restitution;
      contact.surface.bounce_vel = 0.01;
      dJointAttach(dJointCreateContact(world_, contacts_, &contact), dGeomGetBody(a),
                   dGeomGetBody(b));
    }
    contact_count_ += count;
  }

  void Look() {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const dBodyID id = bodies_[b];
      poses_[b] = {Ours(dBodyGetRotation(id)), OursVector(dBodyGetPosition(id)),
                   OursVector(dBodyGetLinearVel(id)), OursVector(dBodyGetAngularVel(id))};
    }
  }

  bool full_step_;
  dWorldID world_ = nullptr;
  dSpaceID space_ = nullptr;
  dJointGroupID contacts_ = nullptr;
  int contact_count_ = 0;
  Contact between_bodies_;
  std::vector<Contact> with_plane_;
  std::vector<dBodyID> bodies_;
  Springs springs_;
  std::vector<Pose> poses_;
  std::vector<Load> loads_;
};

}  // namespace

std::unique_ptr<World> MakeOde(const ModelDef& def, const Options& options) {
  return std::make_unique<Ode>(def, options);
}

std::string OdeVersion() {
  // ODE does not say; the package's name does (peers/CMakeLists.txt).
  return TAUT_PEER_ODE;
}

}  // namespace taut::peers
