/// ODE adapter: geoms with offsets on each body; cables are forces on the bodies before each step.
#include <ode/ode.h>

#include <array>
#include <atomic>
#include <cstdarg>
#include <mutex>
#include <stdexcept>

#include "benchmarks/peers/adapters.h"
#include "math/vec.h"

namespace taut::peers {
namespace {

constexpr unsigned long kPlaneBit = 1, kBodyBit = 2;

/// ODE's rotation matrices have four columns.
Rotation Ours(const dReal* m) { return {{m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]}}; }
Vec3 OursVector(const dReal* v) { return {v[0], v[1], v[2]}; }

/// Counts ODE's global messages, such as "LCP internal error".
std::atomic<int> g_messages = 0;
void Hear(int, const char*, va_list) { ++g_messages; }

void Initialize() {
  static std::once_flag once;
  std::call_once(once, [] {
    dInitODE2(0);
    dSetMessageHandler(Hear);
  });
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
    with_ground_.reserve(def.planes.size() + def.height_fields.size());  // geoms point to them
    for (const PlaneDef& p : def.planes) {
      AddGround(def, p.material, kPlaneBit,
                dCreatePlane(space_, p.normal.x, p.normal.y, p.normal.z, Dot(p.normal, p.point_m)));
    }
    for (const HeightFieldDef& f : def.height_fields) {
      AddGround(def, f.material, kBodyBit, FieldOf(f));
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
    if (heights_ != nullptr) dGeomHeightfieldDataDestroy(heights_);
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
      const int before = g_messages;
      const int done = full_step_ ? dWorldStep(world_, step_s) : dWorldQuickStep(world_, step_s);
      if (done == 0) throw std::runtime_error("ODE has no memory for a step");
      if (g_messages != before) ++unsolved_;
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
  int UnsolvedSteps() const override { return unsolved_; }

 private:
  void AddGround(const ModelDef& def, const Material& material, unsigned long bit, dGeomID geom) {
    with_ground_.push_back(WithGround(def, material));
    dGeomSetData(geom, &with_ground_.back());
    dGeomSetCategoryBits(geom, bit);
    dGeomSetCollideBits(geom, 0);
  }

  /// Creates a height field. ODE's fields have y up and rows along z: rotated about x by a quarter
  /// turn, with the last row first.
  dGeomID FieldOf(const HeightFieldDef& field) {
    std::vector<double> heights;
    for (auto end = field.height_m.end(); end != field.height_m.begin(); end -= field.columns) {
      heights.insert(heights.end(), end - field.columns, end);
    }
    heights_ = dGeomHeightfieldDataCreate();
    dGeomHeightfieldDataBuildDouble(heights_, heights.data(), 1, (field.columns - 1) * field.cell_m,
                                    (field.rows - 1) * field.cell_m, field.columns, field.rows, 1,
                                    0, 1, 0);
    const dGeomID geom = dCreateHeightfield(space_, heights_, 1);
    const dMatrix3 turn = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0};
    dGeomSetRotation(geom, turn);
    dGeomSetPosition(geom, field.origin_m.x, field.origin_m.y, field.origin_m.z);
    return geom;
  }

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
    const dSpaceID own = dSimpleSpaceCreate(space_);  // skips pairs of the same body early
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
    std::array<dContact, 64> found;  // more than two boxes or a rod on hills have
    const int count =
        dCollide(a, b, static_cast<int>(found.size()), &found[0].geom, sizeof(dContact));
    const void* const ground = dGeomGetData(a) != nullptr ? dGeomGetData(a) : dGeomGetData(b);
    const Contact& how = ground != nullptr ? *static_cast<const Contact*>(ground) : between_bodies_;
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
  int contact_count_ = 0, unsolved_ = 0;
  Contact between_bodies_;
  std::vector<Contact> with_ground_;
  dHeightfieldDataID heights_ = nullptr;
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
  // ODE has no version function; the package's name contains the version (peers/CMakeLists.txt).
  return TAUT_PEER_ODE;
}

}  // namespace taut::peers
