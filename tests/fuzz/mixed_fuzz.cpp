// Fuzz target that mixes all features of a step in a random model: cables that touch rods and
// terrain, stiff and soft, with and without friction, pulleys and eyelets, motors, joints, hulls,
// kinematic bodies, height fields and meshes; eight worlds, slightly displaced from each other,
// with every instruction set. Checks: no step exceeds its work limit, non-finite values have a
// status, all sets have the same bits, and touching cables alone create no energy.
#include <string>

#include "fuzz/finite.h"
#include "fuzz/fuzz_folder.h"
#include "fuzz/random_input.h"

namespace taut::fuzz {
namespace {

constexpr int kWorlds = 8, kSteps = 60, kStepsPerStretch = 10;
/// Limit of linear systems per step and island, and in all worlds of an input.
constexpr int kMaxLinearSolves = 50;
constexpr long kEnough = 20'000;

struct Mix {
  ModelDef def;
  bool conserves = false;  ///< Whether only frictionless touching cables act.
};

Material Surface(Draw& draw, bool rough) {
  Material m = draw.Surface();
  if (!rough) m.static_friction = m.kinetic_friction = 0;
  return m;
}

/// Adds a rod, a ball, a box or a hull at a random place in a room of 2 m.
void AddBody(ModelDef& def, Draw& draw) {
  const int index = static_cast<int>(def.bodies.size());
  const Vec3 center = draw.Point(0.5) + Vec3{0, 0, 0.8}, along = draw.Direction();
  const double half_m = draw.Between(0.05, 0.5), radius_m = draw.Scale(2e-3, 0.05);
  BodyDef body;
  body.name = "body_" + std::to_string(index);
  body.mass_kg = draw.Scale(0.02, 5);
  body.com_m = center;
  body.inertia_kg_m2 = scenes::BoxInertia(body.mass_kg, {half_m, half_m, half_m});
  body.velocity_m_per_s = draw.Point(draw.Coin() ? 1 : 15);
  body.angular_velocity_rad_per_s = draw.Point(draw.Coin() ? 1 : 20);
  body.fixed = draw.Int(0, 11) == 0;
  const std::string name = body.name;
  const Material surface = Surface(draw, draw.Coin());
  def.bodies.push_back(body);
  switch (draw.Int(0, 5)) {
    case 0:
      def.spheres.push_back({name, index, center, 4 * radius_m, surface});
      break;
    case 1:
      def.boxes.push_back(
          {name, index, center, draw.Turn(), {half_m, radius_m, 0.5 * half_m}, surface});
      break;
    case 2: {
      HullDef hull{name, index, {}, surface};
      for (int i = draw.Int(4, 12); i > 0; --i)
        hull.corners_m.push_back(center + draw.Point(half_m));
      def.hulls.push_back(hull);
      break;
    }
    default:  // mostly rods, which cables touch
      def.capsules.push_back(
          {name, index, center - half_m * along, center + half_m * along, radius_m, surface});
  }
  if (!body.fixed || draw.Coin()) return;
  MotionDef motion;
  motion.name = name;
  motion.body = index;
  motion.direction = draw.Direction();
  motion.slide.amplitude = draw.Between(0, 0.1);
  motion.slide.frequency_hz = draw.Between(0, 20);
  motion.axis = draw.Direction();
  motion.center_m = center;
  motion.turn.speed = {{0.0, 0.0}, {0.02, draw.Between(-10, 10)}};
  def.motions.push_back(motion);
}

AttachmentDef At(const ModelDef& def, Draw& draw) {
  const int body = draw.Body(def);
  if (body == kWorld) return {kWorld, draw.Point(0.8) + Vec3{0, 0, 0.8}};
  return {body, def.bodies[static_cast<std::size_t>(body)].com_m + draw.Point(0.05)};
}

double LengthOf(const CableDef& cable) {
  double sum = 0;
  for (std::size_t i = 1; i < cable.attachments.size(); ++i) {
    sum += scenes::LengthOf(cable.attachments[i].position_m - cable.attachments[i - 1].position_m);
  }
  return sum;
}

DcMotorDef Motor(Draw& draw) {
  DcMotorDef motor;
  motor.resistance_ohm = draw.Scale(0.1, 10);
  motor.torque_constant_n_m_per_a = draw.Scale(1e-3, 0.1);
  motor.rotor_inertia_kg_m2 = draw.Scale(1e-8, 1e-5);
  motor.gear_ratio = draw.Scale(1, 100);
  motor.spool_radius_m = draw.Scale(3e-3, 3e-2);
  motor.supply = "one";
  motor.supply_resistance_ohm = 0.5;
  motor.servo_gain_per_m = draw.Scale(10, 1e3);
  return motor;
}

void AddCable(Mix& mix, Draw& draw) {
  ModelDef& def = mix.def;
  CableDef cable;
  cable.name = "cable_" + std::to_string(def.cables.size());
  cable.stiffness_n_per_m = draw.Scale(10, 1e7);
  cable.damping_n_s_per_m = draw.Coin() ? 0 : draw.Scale(1e-2, 1e3);
  const AttachmentDef from = At(def, draw), to = At(def, draw);
  cable.attachments = {from, to};
  const bool touches = draw.Int(0, 3) > 0;
  if (touches) {
    cable.touches = static_cast<CableTouches>(draw.Int(1, 3));
    cable.radius_m = draw.Scale(1e-4, 5e-3);
    cable.touch_friction = draw.Coin() ? 0 : draw.Between(0, 0.8);
  } else {
    for (int i = draw.Int(0, 3); i > 0; --i) {
      AttachmentDef middle = At(def, draw);
      middle.friction = draw.Coin() ? 0 : draw.Between(0, 0.5);
      if (draw.Coin()) {
        middle.wheel =
            WheelDef{draw.Direction(), draw.Scale(5e-3, 0.05), draw.Coin(), draw.Int(0, 1)};
      }
      cable.attachments.insert(cable.attachments.end() - 1, middle);
    }
  }
  cable.rest_length_m = draw.Between(0.6, 1.2) * LengthOf(cable) + 1e-3;
  const bool rough = HasFriction(cable);
  ActuatorDef& actuator = cable.actuator;
  actuator.kind = draw.Coin() ? ActuatorDef::Kind::kNone
                              : static_cast<ActuatorDef::Kind>(draw.Int(0, rough ? 2 : 3));
  if (actuator.kind == ActuatorDef::Kind::kDcMotor) actuator.dc_motor = Motor(draw);
  if (actuator.kind != ActuatorDef::Kind::kIdeal) {
    actuator.max_speed_m_per_s = draw.Scale(0.01, 1);
    actuator.max_acceleration_m_per_s2 = draw.Scale(1, 100);
  }
  mix.conserves = mix.conserves && touches && actuator.kind == ActuatorDef::Kind::kNone &&
                  cable.touch_friction == 0 && cable.stiffness_n_per_m < 2e3;
  def.cables.push_back(cable);
}

void AddJoint(ModelDef& def, Draw& draw) {
  JointDef joint;
  joint.name = "joint_" + std::to_string(def.joints.size());
  joint.kind = static_cast<JointKind>(draw.Int(0, 8));
  joint.body_a = draw.Body(def);
  joint.body_b = draw.Int(0, static_cast<int>(def.bodies.size()) - 1);
  if (joint.body_a == joint.body_b) joint.body_a = kWorld;
  const Vec3 at = def.bodies[static_cast<std::size_t>(joint.body_b)].com_m + draw.Point(0.3);
  joint.from_m = joint.to_m = at;
  if (joint.kind == JointKind::kDistance) joint.from_m = at + draw.Point(0.3) + Vec3{0, 0, 0.4};
  joint.axis = draw.Direction();
  joint.collides = draw.Coin();
  if (HasCoordinate(joint.kind) && draw.Coin()) {
    joint.stiffness = draw.Scale(0.1, 1e4);
    joint.damping = draw.Coin() ? 0 : draw.Scale(1e-2, 10);
    if (joint.kind != JointKind::kBall && joint.kind != JointKind::kDistance) joint.rest = 0.1;
    joint.friction = draw.Coin() ? 0 : draw.Scale(1e-2, 1);
  }
  def.joints.push_back(joint);
}

void AddTerrain(ModelDef& def, Draw& draw) {
  const Material surface = Surface(draw, draw.Coin());
  switch (draw.Int(0, 4)) {
    case 0:
      def.planes.push_back({"plane", {0, 0, 1}, {0, 0, draw.Between(-0.2, 0.2)}, surface});
      break;
    case 1:
      for (int i = draw.Int(1, 12); i > 0; --i) {
        def.terrain_boxes.push_back({"box_" + std::to_string(i),
                                     draw.Point(1),
                                     draw.Turn(),
                                     {draw.Scale(0.05, 1), draw.Scale(0.05, 0.5), 0.2},
                                     surface});
      }
      break;
    case 2: {
      HeightFieldDef field;
      field.name = "field";
      field.columns = draw.Int(3, 8), field.rows = draw.Int(3, 8);
      field.cell_m = draw.Between(0.2, 0.6);
      for (int i = 0; i < field.columns * field.rows; ++i) {
        field.height_m.push_back(draw.Between(-0.1, 0.2));
      }
      field.material = surface;
      def.height_fields.push_back(field);
      break;
    }
    case 3: {
      TerrainMeshDef mesh;
      mesh.name = "mesh";
      const Vec3 low = draw.Point(0.5),
                 high = low + Vec3{draw.Between(0.1, 1), 1, draw.Between(0.1, 0.6)};
      for (int k = 0; k < 8; ++k) {
        mesh.corners_m.push_back({(k & 1) != 0 ? high.x : low.x, (k & 2) != 0 ? high.y : low.y,
                                  (k & 4) != 0 ? high.z : low.z});
      }
      mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                        {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
      mesh.material = surface;
      def.terrain_meshes.push_back(mesh);
      break;
    }
    default:
      break;  // none
  }
}

Mix RandomMix(Draw& draw) {
  Mix mix;
  ModelDef& def = mix.def;
  def.name = "mixed";
  for (int i = draw.Int(2, 8); i > 0; --i) AddBody(def, draw);
  mix.conserves = def.motions.empty();
  const bool jointed = draw.Coin();
  for (int i = jointed ? draw.Int(1, 4) : 0; i > 0; --i) AddJoint(def, draw);
  for (int i = draw.Int(1, 4); i > 0; --i) AddCable(mix, draw);
  for (int i = draw.Int(0, 2); i > 0; --i) AddTerrain(def, draw);
  mix.conserves = mix.conserves && !jointed;
  def.gravity_m_per_s2 = draw.Coin() ? Vec3{0, 0, -9.81} : Vec3{};
  def.friction_law = draw.Coin() ? FrictionLaw::kCone : FrictionLaw::kAlongSlip;
  return mix;
}

void MoveApart(WorldBatch& batch, const ModelDef& def, const Vec3& by) {
  for (int world = 0; world < batch.worlds(); ++world) {
    for (std::size_t b = 0; b < def.bodies.size(); ++b) {
      if (def.bodies[b].fixed) continue;
      const int body = static_cast<int>(b);
      BodyState state = batch.Body(world, body);
      state.position_m = state.position_m + (world * (b % 2 == 0 ? 1.0 : -1.0)) * by;
      batch.SetBodyState(world, body, state);
    }
  }
}

double EnergyOf(const WorldBatch& batch, int world) {
  const Energy e = batch.TotalEnergy(world);
  return e.kinetic_j + e.gravity_j + e.elastic_j;
}

void Run(const std::uint8_t* data, std::size_t size) {
  Draw draw(Extended(data, size));
  const double step_s = draw.Coin() ? 1e-3 : 2.5e-4;
  const Vec3 apart = draw.Point(0.02);
  const Mix mix = RandomMix(draw);
  Diagnostics refused;
  const auto model = Model::Compile(mix.def, refused);
  Must((model != nullptr) == refused.ok(), "compiled or refused");
  if (!model) return;
  std::vector<WorldBatch> sets;
  for (const Simd simd : {Simd::kScalar, Simd::kSse2, Simd::kAvx2, Simd::kAvx512}) {
    WorldBatchOptions options;
    options.worlds = kWorlds;
    options.simd = simd;
    options.max_linear_solves = kMaxLinearSolves;
    WorldBatch batch(model, options);
    const bool known = std::any_of(sets.begin(), sets.end(), [&](const WorldBatch& other) {
      return other.lanes() == batch.lanes();
    });
    if (known) continue;  // this machine or build lacks the set
    MoveApart(batch, mix.def, apart);
    sets.push_back(std::move(batch));
  }
  std::vector<double> start;
  for (int world = 0; world < kWorlds; ++world) start.push_back(EnergyOf(sets[0], world));
  long work = 0;
  for (int step = 0; step < kSteps && work < kEnough; step += kStepsPerStretch) {
    const auto so_far = [&] { return " by step " + std::to_string(step); };
    std::vector<double> targets;
    for (const CableDef& cable : mix.def.cables) {
      targets.push_back(draw.Between(0.7, 1.1) * cable.rest_length_m);
    }
    for (WorldBatch& batch : sets) {
      for (int world = 0; world < kWorlds; ++world) {
        for (std::size_t c = 0; c < targets.size(); ++c) {
          if (mix.def.cables[c].actuator.kind == ActuatorDef::Kind::kNone) continue;
          batch.SetRestLengthTarget(world, static_cast<int>(c), targets[c]);
        }
      }
      batch.Step(step_s, kStepsPerStretch);
    }
    for (int world = 0; world < kWorlds; ++world) {
      const WorldBatch& one = sets[0];
      const WorldStatus status = one.Status(world);
      work += static_cast<long>(kStepsPerStretch) * status.linear_solves;
      for (const WorldBatch& other : sets) {
        Must(other.Hash(world) == one.Hash(world),
             "other bits with " + std::to_string(other.lanes()) + " lanes in world " +
                 std::to_string(world) + so_far());
      }
      if ((status.bits & kStatusNonFinite) != 0) continue;
      const std::string lost = NotFinite(one, world);
      Must(lost.empty(), lost + " is not finite and the status has no such bit" + so_far());
      if (!mix.conserves || status.bits != 0) continue;
      const double now = EnergyOf(one, world), before = start[static_cast<std::size_t>(world)];
      const double moves = one.TotalEnergy(world).kinetic_j + one.TotalEnergy(world).elastic_j;
      Must(now - before <= 0.02 * moves + 1e-6, "energy from nothing: " + std::to_string(before) +
                                                    " J become " + std::to_string(now) + so_far());
    }
  }
}

}  // namespace
}  // namespace taut::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  taut::fuzz::Run(data, size);
  return 0;
}
