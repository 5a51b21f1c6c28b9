/// Bullet adapter: one compound shape per body; cables are forces on the bodies before each step.
#include <BulletCollision/CollisionDispatch/btCompoundCompoundCollisionAlgorithm.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <stdexcept>

#include "benchmarks/peers/adapters.h"
#include "math/principal_axes.h"
#include "math/vec.h"
#include "mechanics/height_range.h"

namespace taut::peers {
namespace {

constexpr int kPlaneBit = 1, kBodyBit = 2;  // of btCollisionShape's user index

btVector3 Bt(const Vec3& v) { return {v.x, v.y, v.z}; }
Vec3 Ours(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
btMatrix3x3 Bt(const Rotation& r) {
  const double* const m = r.m;
  return {m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]};
}
Rotation Ours(const btMatrix3x3& m) {
  Rotation r;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) r.m[3 * i + j] = m[i][j];
  }
  return r;
}

/// Collision filter of Bullet for ground and a part of a compound, and for parts of two compounds.
bool Meets(const btCollisionShape* a, const btCollisionShape* b) {
  const bool plane =
      a->getShapeType() == STATIC_PLANE_PROXYTYPE || b->getShapeType() == STATIC_PLANE_PROXYTYPE;
  const int bit = plane ? kPlaneBit : kBodyBit;
  return (a->getUserIndex() & b->getUserIndex() & bit) != 0;
}

/// Coefficients of surfaces from coefficients of contacts, since Bullet multiplies the two
/// surfaces.
struct Factors {
  double body = 0, ground = 0;
};
Factors Split(double bodies, double with_ground) {
  const double body = std::sqrt(bodies);
  if (body == 0 && with_ground != 0) {
    throw std::invalid_argument(
        "Bullet cannot combine a coefficient of 0 between bodies with another one on the ground");
  }
  return {body, body == 0 ? 0 : with_ground / body};
}

class Bullet final : public World {
 public:
  Bullet(const ModelDef& def, const Options& options)
      : dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &solver_, &configuration_),
        springs_(def),
        poses_(def.bodies.size()),
        loads_(def.bodies.size()) {
    gCompoundChildShapePairCallback = Meets;
    gCompoundCompoundChildShapePairCallback = Meets;
    world_.setGravity(Bt(def.gravity_m_per_s2));
    world_.getSolverInfo().m_numIterations = options.iterations;
    if (options.two_directions) {
      world_.getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
    }
    const std::vector<Shape> shapes = ShapesOf(def);
    for (const PlaneDef& p : def.planes) {
      AddGround(def, p.material, {0, 0, 0}, kPlaneBit,
                std::make_unique<btStaticPlaneShape>(Bt(p.normal), Dot(p.normal, p.point_m)));
    }
    for (const HeightFieldDef& f : def.height_fields) AddField(def, f);
    for (std::size_t b = 0; b < def.bodies.size(); ++b) AddBody(def, static_cast<int>(b), shapes);
    Look();
  }
  Bullet(const Bullet&) = delete;
  Bullet& operator=(const Bullet&) = delete;
  ~Bullet() override {
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
    for (const auto& ground : grounds_) world_.removeRigidBody(ground.get());
  }

  void Step(double step_s, int count) override {
    for (int i = 0; i < count; ++i) {
      springs_.Pull(poses_, loads_);
      for (std::size_t b = 0; b < bodies_.size(); ++b) {
        bodies_[b]->applyCentralForce(Bt(loads_[b].force_n));
        bodies_[b]->applyTorque(Bt(loads_[b].torque_n_m));
      }
      world_.stepSimulation(step_s, 0);  // 0: one step of this size
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
    const btRigidBody& b = *bodies_[static_cast<std::size_t>(body)];
    const btVector3 inverse = b.getInvInertiaDiagLocal();
    const Vec3 moments{1 / inverse.x(), 1 / inverse.y(), 1 / inverse.z()};
    const btTransform& at = b.getCenterOfMassTransform();
    return {1 / b.getInvMass(), Ours(at.getOrigin()), Turned(Ours(at.getBasis()), moments)};
  }
  int ContactCount() const override {
    int count = 0;
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
      const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(i);
      for (int k = 0; k < manifold.getNumContacts(); ++k) {
        if (manifold.getContactPoint(k).getDistance() <= 0) ++count;
      }
    }
    return count;
  }

 private:
  void AddGround(const ModelDef& def, const Material& material, const Vec3& at_m, int bit,
                 std::unique_ptr<btCollisionShape> shape) {
    shape->setUserIndex(bit);
    btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, shape.get());
    info.m_startWorldTransform.setOrigin(Bt(at_m));
    const Contact bodies = BetweenBodies(def), ground = WithGround(def, material);
    info.m_friction = Split(bodies.friction, ground.friction).ground;
    info.m_restitution = Split(bodies.restitution, ground.restitution).ground;
    grounds_.push_back(std::make_unique<btRigidBody>(info));
    shapes_.push_back(std::move(shape));
    world_.addRigidBody(grounds_.back().get());
  }

  /// Adds a height field. Bullet does not copy the heights, and places the middle of their range at
  /// the body's position.
  void AddField(const ModelDef& def, const HeightFieldDef& field) {
    heights_ = field.height_m;
    const mechanics::HeightRange range = mechanics::HeightsOf(field);
    auto shape = std::make_unique<btHeightfieldTerrainShape>(
        field.columns, field.rows, heights_.data(), range.least_m, range.most_m, 2, true);
    shape->setLocalScaling({field.cell_m, field.cell_m, 1});
    const double middle_m = 0.5 * (range.least_m + range.most_m);
    AddGround(def, field.material, field.origin_m + Vec3{0, 0, middle_m}, kBodyBit,
              std::move(shape));
  }

  void AddBody(const ModelDef& def, int index, const std::vector<Shape>& shapes) {
    const BodyDef& body = def.bodies[static_cast<std::size_t>(index)];
    Rotation axes;
    double moments[3];
    PrincipalAxes(body.inertia_kg_m2, axes.m, moments);
    start_.push_back(Transposed(axes));
    auto compound = std::make_unique<btCompoundShape>();
    for (const Shape& s : shapes) {
      if (s.body != index) continue;
      std::unique_ptr<btCollisionShape> part;
      if (s.kind == Shape::Kind::kSphere) {
        part = std::make_unique<btSphereShape>(s.radius_m);
      } else if (s.kind == Shape::Kind::kCapsule) {
        part = std::make_unique<btCapsuleShapeZ>(s.radius_m, 2 * s.half_length_m);
      } else {
        part = std::make_unique<btBoxShape>(Bt(s.half_extents_m));
      }
      part->setUserIndex((s.meets_planes ? kPlaneBit : 0) | (s.meets_bodies ? kBodyBit : 0));
      compound->addChildShape(
          btTransform(Bt(start_.back() * s.turn), Bt(start_.back() * s.center_m)), part.get());
      shapes_.push_back(std::move(part));
    }
    btRigidBody::btRigidBodyConstructionInfo info(body.mass_kg, nullptr, compound.get(),
                                                  {moments[0], moments[1], moments[2]});
    info.m_startWorldTransform = btTransform(Bt(axes), Bt(body.com_m));
    const Contact contact = BetweenBodies(def);
    info.m_friction = std::sqrt(contact.friction);
    info.m_restitution = std::sqrt(contact.restitution);
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    bodies_.back()->setLinearVelocity(Bt(body.velocity_m_per_s));
    bodies_.back()->setAngularVelocity(Bt(body.angular_velocity_rad_per_s));
    bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
    shapes_.push_back(std::move(compound));
    world_.addRigidBody(bodies_.back().get());
  }

  void Look() {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const btTransform& at = bodies_[b]->getCenterOfMassTransform();
      poses_[b] = {Ours(at.getBasis()) * start_[b], Ours(at.getOrigin()),
                   Ours(bodies_[b]->getLinearVelocity()), Ours(bodies_[b]->getAngularVelocity())};
    }
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_, grounds_;
  std::vector<double> heights_;  ///< Heights of the height field.
  std::vector<Rotation> start_;  ///< Rotation from the axes at the start to principal axes.
  Springs springs_;
  std::vector<Pose> poses_;
  std::vector<Load> loads_;
};

}  // namespace

std::unique_ptr<World> MakeBullet(const ModelDef& def, const Options& options) {
  return std::make_unique<Bullet>(def, options);
}

std::string BulletVersion() {
  return std::to_string(btGetVersion() / 100) + "." + std::to_string(btGetVersion() % 100);
}

}  // namespace taut::peers
