// Fuzz target of random models of bodies, cables and terrain, stepped 1000 times with random
// commands: no step exceeds its work limit, and non-finite numbers never occur without a status
// that reports them.
#include <cmath>
#include <limits>
#include <utility>

#include "fuzz/finite.h"
#include "fuzz/fuzz_folder.h"
#include "fuzz/random_input.h"
#include "taut/cable_scheme.h"

namespace taut::fuzz {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kSteps = 1000, kStepsPerStretch = 50;

/// Limit of linear systems per step and island (WorldBatchOptions::max_linear_solves).
constexpr int kMaxLinearSolves = 50;
/// Additional limit per body for solvers in lanes: at most 10 iterations, and 4 rounds of impacts.
constexpr int kMaxInLanes = 10 * 5;
/// Limit of linear systems of a step per body. Each body is at most one island, which is solved in
/// lanes without success, then separately, then by position projection. One direction sometimes
/// takes two systems, hence one more than the limit.
constexpr int kMaxOfABody = kMaxInLanes + 2 * (kMaxLinearSolves + 1);
/// Linear systems after which an input ends.
constexpr long kEnough = 10'000;

void AddBody(ModelDef& def, Draw& draw) {
  const int index = static_cast<int>(def.bodies.size());
  BodyDef body;
  body.name = "body_" + std::to_string(index);
  body.fixed = draw.Int(0, 9) == 0;
  body.mass_kg = draw.Scale(1e-4, 1e3);
  body.com_m = draw.Point(1) + Vec3{0, 0, 1};
  body.velocity_m_per_s = draw.Point(draw.Coin() ? 1 : 100);
  body.angular_velocity_rad_per_s = draw.Point(draw.Coin() ? 1 : 300);
  const double size_m = draw.Scale(1e-3, 1);
  body.inertia_kg_m2 = scenes::BoxInertia(
      body.mass_kg, {size_m, size_m * draw.Between(0.01, 1), size_m * draw.Between(0.01, 1)});
  const std::string name = body.name;
  const Vec3 center = body.com_m;
  def.bodies.push_back(std::move(body));
  for (int i = draw.Int(0, 2); i >= 0; --i) {
    const double radius_m = draw.Scale(1e-3, 0.3);
    const Vec3 at = center + draw.Point(size_m);
    switch (draw.Int(0, 3)) {
      case 0:
        def.spheres.push_back({name, index, at, radius_m, draw.Surface()});
        break;
      case 1:
        def.capsules.push_back(
            {name, index, at, center + draw.Point(size_m), radius_m, draw.Surface()});
        break;
      case 2:
        def.boxes.push_back({name,
                             index,
                             at,
                             draw.Turn(),
                             {radius_m, radius_m * draw.Between(0.05, 1), 0.5 * radius_m},
                             draw.Surface()});
        break;
      default:
        break;  // a body without this shape
    }
    def.nodes.push_back({name + "_" + std::to_string(i), index, at});
  }
}

DcMotorDef RandomMotor(Draw& draw) {
  DcMotorDef motor;
  motor.resistance_ohm = draw.Scale(1e-2, 1e3);
  motor.torque_constant_n_m_per_a = draw.Scale(1e-4, 1);
  motor.rotor_inertia_kg_m2 = draw.Scale(1e-9, 1e-2);
  motor.friction_torque_n_m = draw.Coin() ? 0 : draw.Scale(1e-6, 1e-2);
  motor.static_friction_torque_n_m = motor.friction_torque_n_m * draw.Between(1, 3);
  motor.viscous_friction_n_m_s_per_rad = draw.Coin() ? 0 : draw.Scale(1e-9, 1e-3);
  motor.gear_ratio = draw.Scale(1, 1e3);
  motor.gear_efficiency = draw.Between(0.2, 1);
  motor.backlash_rad = draw.Coin() ? 0 : draw.Between(0, 0.2);
  motor.spool_radius_m = draw.Scale(1e-3, 1e-1);
  motor.supply = draw.Coin() ? "one" : "other";
  motor.supply_resistance_ohm = 0.5;
  motor.servo_gain_per_m = draw.Scale(1, 1e5);
  motor.servo_damping_s_per_m = draw.Coin() ? 0 : draw.Scale(1e-3, 1e3);
  return motor;
}

void AddCable(ModelDef& def, Draw& draw) {
  CableDef cable;
  cable.name = "cable_" + std::to_string(def.cables.size());
  for (int i = draw.Int(2, 4); i > 0; --i) {
    if (draw.Coin() && !def.nodes.empty()) {  // at a node, so that cables share places
      const NodeDef& node =
          def.nodes[static_cast<std::size_t>(draw.Int(0, static_cast<int>(def.nodes.size()) - 1))];
      cable.attachments.push_back({node.body, node.position_m});
    } else {
      cable.attachments.push_back({draw.Body(def), draw.Point(1)});
    }
  }
  cable.stiffness_n_per_m = draw.Scale(1e-2, 1e8);
  cable.damping_n_s_per_m = draw.Coin() ? 0 : draw.Scale(1e-3, 1e5);
  cable.rest_length_m = draw.Scale(1e-6, 3);
  cable.damping_law = draw.Coin() ? DampingLaw::kExact : DampingLaw::kClamped;
  ActuatorDef& motor = cable.actuator;
  motor.kind = static_cast<ActuatorDef::Kind>(draw.Int(0, 3));
  if (motor.kind == ActuatorDef::Kind::kDcMotor) motor.dc_motor = RandomMotor(draw);
  motor.max_speed_m_per_s = draw.Coin() ? kInfinity : draw.Scale(1e-3, 1e3);
  motor.max_acceleration_m_per_s2 = draw.Coin() ? kInfinity : draw.Scale(1e-3, 1e5);
  motor.max_force_n = draw.Coin() ? kInfinity : draw.Scale(1e-3, 1e5);
  motor.min_rest_length_m = draw.Coin() ? 0 : draw.Between(0, 1);
  motor.min_length_m = draw.Coin() ? 0 : draw.Between(0, 1);
  def.cables.push_back(std::move(cable));
}

ModelDef RandomModel(Draw& draw) {
  ModelDef def;
  def.name = "random";
  for (int i = draw.Int(1, 5); i > 0; --i) AddBody(def, draw);
  for (int i = draw.Int(0, 8); i > 0; --i) AddCable(def, draw);
  for (int i = draw.Int(0, 2); i > 0; --i) {
    def.planes.push_back(
        {"plane", draw.Coin() ? Vec3{0, 0, 1} : draw.Direction(), draw.Point(0.2), draw.Surface()});
  }
  // Longer lists of boxes use the bounding volume hierarchy.
  for (int block = draw.Coin() ? draw.Int(1, 16) : 0; block > 0; --block) {
    def.terrain_boxes.push_back({"block",
                                 draw.Point(1),
                                 draw.Turn(),
                                 {draw.Scale(0.01, 1), draw.Scale(0.01, 1), 0.2},
                                 draw.Surface()});
  }
  def.gravity_m_per_s2 = draw.Coin() ? Vec3{0, 0, -9.81} : draw.Point(30);
  def.friction_combine = static_cast<CombineRule>(draw.Int(0, 3));
  def.restitution_combine = static_cast<CombineRule>(draw.Int(0, 3));
  def.friction_law = draw.Coin() ? FrictionLaw::kCone : FrictionLaw::kAlongSlip;
  return def;
}

/// Returns mostly valid commands of a controller, and sometimes invalid ones.
double Command(Draw& draw) {
  switch (draw.Int(0, 30)) {
    case 0:
      return std::nan("");
    case 1:
      return kInfinity;
    case 2:
      return -draw.Scale(1e-3, 1e300);
    case 3:
      return draw.Scale(1e-300, 1e300);
    default:
      return draw.Between(0, 3);
  }
}

void Disturb(WorldBatch& batch, int world, Draw& draw) {
  const ModelDef& def = batch.model().def();
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    if (draw.Coin()) batch.SetRestLengthTarget(world, static_cast<int>(c), Command(draw));
    if (!def.cables[c].actuator.dc_motor) continue;
    if (draw.Coin()) batch.SetDuty(world, static_cast<int>(c), draw.Between(-1.1, 1.1));
    if (draw.Coin()) batch.SetMotorEnabled(world, static_cast<int>(c), draw.Coin());
  }
  if (!def.nodes.empty() && draw.Coin()) {
    const int node = draw.Int(0, static_cast<int>(def.nodes.size()) - 1);
    const double size_n = Command(draw);
    batch.SetNodeForce(world, node, size_n * draw.Direction());
  }
}

void Run(const std::uint8_t* data, std::size_t size) {
  Draw draw(Extended(data, size));
  const double step_s = draw.Coin() ? 1e-3 : draw.Scale(1e-9, 1);
  WorldBatchOptions options;
  options.worlds = draw.Int(1, 3);
  options.simd = static_cast<Simd>(1 << draw.Int(0, 3));
  options.max_linear_solves = kMaxLinearSolves;
  Diagnostics refused;
  const auto model = Model::Compile(RandomModel(draw), refused);
  Must((model != nullptr) == refused.ok(), "compiled or refused");
  if (!model) return;
  const int substeps = SubstepCount(*model, step_s);
  const int most = static_cast<int>(model->def().bodies.size()) * kMaxOfABody * substeps;
  WorldBatch batch(model, options);
  long work = 0;
  for (int step = 0; step == 0 || (step * substeps < kSteps && work < kEnough); ++step) {
    for (int world = 0; world < options.worlds && step % kStepsPerStretch == 0; ++world) {
      Disturb(batch, world, draw);
    }
    batch.Step(step_s, 1);
    for (int world = 0; world < options.worlds; ++world) {
      const WorldStatus status = batch.Status(world);
      work += status.linear_solves;
      const auto in_step = [&] { return " in step " + std::to_string(step); };
      Must(status.linear_solves <= most,
           std::to_string(status.linear_solves) + " linear systems" + in_step());
      if ((status.bits & kStatusNonFinite) != 0) continue;
      const std::string lost = NotFinite(batch, world);
      Must(lost.empty(), lost + " is not finite and the status does not say so" + in_step());
    }
  }
}

}  // namespace
}  // namespace taut::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  taut::fuzz::Run(data, size);
  return 0;
}
