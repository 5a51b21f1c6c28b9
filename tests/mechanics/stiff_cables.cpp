/// Stiff and tight cables: drops, free motion, light nodes (docs/theory/cables.md, section 3).

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "taut/cable_scheme.h"
#include "tests/mechanics/known_scene.h"
#include "tests/physics/world.h"
#include "tests/scenes/six_strut.h"

namespace taut::mechanics {
namespace {

using test::EnergyOf;
using test::MakeBatch;
using test::Norm;
using test::StepsIn;

/// Pseudorandom numbers from -1 to 1 that are the same on every machine.
class Chance {
 public:
  explicit Chance(unsigned seed) : state_(seed) {}
  double operator()() {
    state_ = 1664525u * state_ + 1013904223u;
    return static_cast<double>(state_) / 2147483648.0 - 1;
  }

 private:
  unsigned state_;
};

/// Returns a robot with rods of 0.6 m and 0.1 kg.
scenes::SixStrut Robot(double stiffness_n_per_m, double damping_n_s_per_m) {
  scenes::SixStrut robot;
  robot.length_m = 0.6;
  robot.rod_mass_kg = 0.1;
  robot.stiffness_n_per_m = stiffness_n_per_m;
  robot.damping_n_s_per_m = damping_n_s_per_m;
  robot.material = {1, 1, 0};
  return robot;
}

struct Drop {
  double tension_n;  ///< Tension of the cables; 0: cables stretched by a tenth.
  double stiffness_n_per_m, damping_n_s_per_m, step_s;
  unsigned tumble;  ///< Seed of attitude and angular velocity; 0: upright and without rotation.
  double time_s;
};

/// Returns the energy of the common translation. Three rods may stand on their round ends, spin
/// about their tilted axes and carry the robot along as wheels: there is no rolling friction.
double RollingJ(const WorldBatch& world, const ModelDef& def) {
  double mass = 0;
  for (const BodyDef& body : def.bodies) mass += body.mass_kg;
  const Vec3 momentum = world.Momentum(0);
  return 0.5 * Dot(momentum, momentum) / mass;
}

struct Fall {
  double gained = 0;  ///< Largest energy gain as a share of the initial energy.
  unsigned bits = 0;
  double height_m = 0;
  double kinetic_j = 0;  ///< Kinetic energy without undamped motions (AxialSpinJ, RollingJ).
                         ///< AxialSpinJ, RollingJ.
};

/// Returns the energy of the rods' spin about their axes. Cables pull at the ends of the axes, so
/// nothing stops a rod above the ground that a contact has spun.
double AxialSpinJ(const WorldBatch& world, const ModelDef& def) {
  double sum = 0;
  for (const CapsuleDef& rod : def.capsules) {
    const Vec3 axis = (1 / test::Distance(rod.from_m, rod.to_m)) * (rod.to_m - rod.from_m);
    const BodyState state = world.Body(0, rod.body);
    const double spin = Dot(state.angular_velocity_rad_per_s, Rotate(state.orientation, axis));
    const Inertia& I = def.bodies[static_cast<std::size_t>(rod.body)].inertia_kg_m2;
    const double moment =
        I.xx * axis.x * axis.x + I.yy * axis.y * axis.y + I.zz * axis.z * axis.z +
        2 * (I.xy * axis.x * axis.y + I.xz * axis.x * axis.z + I.yz * axis.y * axis.z);
    sum += 0.5 * moment * spin * spin;
  }
  return sum;
}

Fall Run(const Drop& drop) {
  scenes::SixStrut robot = Robot(drop.stiffness_n_per_m, drop.damping_n_s_per_m);
  robot.center_m = {0, 0, 0.45};
  robot.tension_n =
      drop.tension_n > 0 ? drop.tension_n : 0.1 * robot.cable_m() * robot.stiffness_n_per_m;
  Chance chance(drop.tumble);
  Vec3 spin, speed;
  if (drop.tumble > 0) {
    const Vec3 axis{chance(), chance(), chance()};
    const double half = 1.5 * chance(), s = std::sin(half) / Norm(axis);
    robot.orientation = {std::cos(half), s * axis.x, s * axis.y, s * axis.z};
    spin = {2 * chance(), 2 * chance(), 2 * chance()};
    speed = {chance(), chance(), 0};
  }
  ModelDef def = robot.Def();
  PlaneDef ground;
  ground.name = "ground";
  ground.material = robot.material;
  def.planes.push_back(ground);
  for (BodyDef& body : def.bodies) {
    body.velocity_m_per_s = speed + Cross(spin, body.com_m - robot.center_m);
    body.angular_velocity_rad_per_s = spin;
  }
  WorldBatch world = MakeBatch(def);
  const double start = EnergyOf(world);
  Fall fall;
  for (int n = StepsIn(drop.time_s, drop.step_s); n > 0; --n) {
    world.Step(drop.step_s);
    fall.gained = std::max(fall.gained, (EnergyOf(world) - start) / start);
  }
  fall.bits = world.Status(0).bits;
  fall.kinetic_j = world.TotalEnergy(0).kinetic_j - AxialSpinJ(world, def) - RollingJ(world, def);
  for (int b = 0; b < 6; ++b) fall.height_m += world.Body(0, b).position_m.z / 6;
  return fall;
}

void Drops(Report& report) {
  std::vector<Drop> drops;
  if (report.IsFull()) {
    for (const double tension : {30.0, 100.0, 300.0, 1000.0, 0.0}) {
      for (const double k : {3e4, 1e6, 1e8}) {
        for (const double b : {0.0, 20.0, 200.0}) {
          for (const double h : {1e-3, 4e-3}) {
            for (const unsigned tumble : {0u, 1u, 2u})
              drops.push_back({tension, k, b, h, tumble, 3});
          }
        }
      }
    }
  } else {
    drops = {{100, 1e6, 0, 4e-3, 1, 1.2},
             {1000, 1e8, 20, 4e-3, 2, 0.8},
             {0, 1e8, 200, 4e-3, 0, 0.8},
             {1000, 1e8, 20, 1e-3, 1, 0.4},
             {30, 3e4, 0, 1e-3, 2, 0.4},
             // In one step a contact solve fails, and its substeps have no contact.
             {30, 1e8, 0, 4e-3, 1, 3}};
  }
  double gained = 0, lowest = 1, highest = 0, fastest = 0;
  int with_status = 0;
  for (const Drop& drop : drops) {
    const Fall fall = Run(drop);
    gained = std::max(gained, fall.gained);
    lowest = std::min(lowest, fall.height_m), highest = std::max(highest, fall.height_m);
    fastest = std::max(fastest, fall.kinetic_j);
    with_status += fall.bits != kStatusOk;
  }
  const std::string all = std::to_string(drops.size()) + " drops of 0.45 m";
  report.AtMost(all + ", largest gain of energy", "1", gained, 1e-6);
  report.AtMost(all + " with a status bit", "1", with_status, 0);
  // The robot stands on three rods or has rolled over, bouncing by a few centimeters at most.
  report.AtMost(all + ", largest height of the center of mass at the end", "m", highest, 0.36);
  report.AtMost(all + ", 0.26 m minus the smallest height of the center of mass at the end", "m",
                0.26 - lowest, 0);
  report.AtMost(all + ", kinetic energy at the end without axial spin and rolling", "J", fastest,
                report.IsFull() ? 0.05 : 0.5);
}

const SceneEntry kDrops("stiff cables", "Six-strut that falls, straight and tumbling",
                        "energy does not increase; the robot comes to rest", Drops);

/// Stretched by a tenth, without gravity. `kicked`: random velocities of the rods; otherwise
/// parallel rods start too far apart.
void KeepsEnergy(Report& report, double k, double h, bool kicked, double time_s) {
  scenes::SixStrut robot = Robot(k, 0);
  robot.tension_n = 0.1 * robot.cable_m() * k;
  // The energy error is relative to the energy above the minimal elastic energy.
  const double least = 24 * 0.5 * robot.tension_n * robot.tension_n / k;
  if (!kicked) robot.spacing = 0.54;
  ModelDef def = robot.Def();
  def.gravity_m_per_s2 = {0, 0, 0};
  for (CapsuleDef& rod : def.capsules) rod.collides = false;
  Chance chance(7);
  for (BodyDef& body : def.bodies) {
    if (!kicked) break;
    body.velocity_m_per_s = {chance(), chance(), chance()};
    body.angular_velocity_rad_per_s = {4 * chance(), 4 * chance(), 4 * chance()};
  }
  WorldBatch world = MakeBatch(def);
  const double start = EnergyOf(world) - least;
  const Vec3 momentum = world.AngularMomentum(0);
  double off = 0;
  for (int n = StepsIn(time_s, h); n > 0; --n) {
    world.Step(h);
    off = std::max(off, std::fabs((EnergyOf(world) - least) / start - 1));
  }
  const std::string what = std::string(kicked ? "kicked" : "symmetric") + ", " +
                           std::to_string(static_cast<int>(k)) + " N/m, " +
                           std::to_string(static_cast<int>(1e3 * h)) + " ms: ";
  report.AtMost(what + "error of the energy (relative)", "1", off, 1e-3);
  report.AtMost(what + "error of the angular momentum", "kg m^2/s",
                Norm(world.AngularMomentum(0) - momentum), 1e-9);
}

void FreeMotion(Report& report) {
  for (const double k : {5e3, 1e5, 1e7}) {
    for (const double h : {1e-3, 4e-3}) {
      for (const bool kicked : {false, true}) {
        if (report.IsFull() || h > 2e-3) KeepsEnergy(report, k, h, kicked, report.IsFull() ? 5 : 1);
      }
    }
  }
}

const SceneEntry kFreeMotion("stiff cables", "Six-strut that vibrates and tumbles, undamped",
                             "energy and angular momentum are conserved", FreeMotion);

/// Simulates a weight with frequency `wh` on one cable, released at zero stretch. Returns the step
/// after which the tension is within 1 %.
int StepsUntilRight(double wh, double zeta) {
  const double h = 1e-3, k = 1e6, g = 9.81, m = k * h * h / (wh * wh);
  ModelDef def;
  BodyDef knot;
  knot.name = "knot";
  knot.mass_kg = m;
  knot.inertia_kg_m2 = {m * 1e-6, m * 1e-6, m * 1e-6, 0, 0, 0};
  def.bodies.push_back(knot);
  CableDef cable;
  cable.name = "cable";
  cable.attachments = {{kWorld, {0, 0, 0.2}}, {0, {0, 0, 0}}};
  cable.stiffness_n_per_m = k;
  cable.damping_n_s_per_m = 2 * zeta * std::sqrt(k * m);
  cable.rest_length_m = 0.2;
  def.cables.push_back(cable);
  def.gravity_m_per_s2 = {0, 0, -g};
  WorldBatch world = MakeBatch(def);
  int last = 0;
  for (int n = 1; n <= 400; ++n) {
    world.Step(h);
    if (!(std::fabs(world.Cable(0, 0).tension_n / (m * g) - 1) < 0.01)) last = n;
  }
  return last;
}

void LightNodes(Report& report) {
  for (const double wh : {3.0, 10.0, 100.0, 1000.0}) {
    for (const double zeta : {0.05, 0.5, 1.0}) {
      // Ten time constants or five steps; eight steps where a step is about one time constant.
      const double limit = std::max(10 / (zeta * wh), wh < 5 ? 8.0 : 5.0);
      report.AtMost("w h = " + std::to_string(static_cast<int>(wh)) + ", damping ratio " +
                        std::to_string(zeta).substr(0, 4) + ": steps until 1 %",
                    "1", StepsUntilRight(wh, zeta), std::ceil(limit));
    }
  }
}

const SceneEntry kLightNodes("stiff cables", "Light node that comes to hang on a damped cable",
                             "weight of the node", LightNodes);

/// Returns three bodies in flight, on one cable through an eyelet and on another between two of
/// them.
ModelDef Eyelets(double stiffness_n_per_m, double damping_n_s_per_m) {
  ModelDef def;
  def.gravity_m_per_s2 = {0, 0, 0};
  const Vec3 centers[3] = {{0, 0, 0}, {0.6, 0.1, 0}, {1, -0.2, 0.3}};
  for (int i = 0; i < 3; ++i) {
    BodyDef body;
    body.name = "body" + std::to_string(i);
    body.mass_kg = 0.5;
    body.com_m = centers[i];
    body.inertia_kg_m2 = {0.001, 0.002, 0.0025, 0, 0, 0};
    body.velocity_m_per_s = {0.1 * i, 0.2, -0.1 * i};
    def.bodies.push_back(body);
  }
  CableDef cable;
  cable.name = "through";
  cable.attachments = {{0, centers[0] + Vec3{0.05, 0.02, 0}},
                       {1, centers[1] + Vec3{0, 0.03, 0.04}},
                       {2, centers[2] + Vec3{-0.02, 0, 0.05}}};
  cable.stiffness_n_per_m = stiffness_n_per_m;
  cable.damping_n_s_per_m = damping_n_s_per_m;
  cable.rest_length_m = 1.1;
  def.cables.push_back(cable);
  cable.name = "between";
  cable.attachments = {{0, centers[0] + Vec3{0, 0, 0.05}}, {2, centers[2] + Vec3{0, 0, -0.05}}};
  cable.rest_length_m = 1.05;
  def.cables.push_back(cable);
  return def;
}

void ThroughEyelets(Report& report) {
  for (const double h : {1e-3, 4e-3}) {
    for (const double b : {0.0, 10.0}) {
      WorldBatch world = MakeBatch(Eyelets(1e6, b));
      const double start = EnergyOf(world);
      const Vec3 spin = world.AngularMomentum(0), momentum = world.Momentum(0);
      double most = 0, off = 0;
      for (int n = StepsIn(2, h); n > 0; --n) {
        world.Step(h);
        most = std::max(most, EnergyOf(world) / start - 1);
        off = std::max(off, std::fabs(EnergyOf(world) / start - 1));
      }
      const std::string what = std::to_string(static_cast<int>(1e3 * h)) + " ms, " +
                               std::to_string(static_cast<int>(b)) + " N s/m: ";
      if (b > 0) {
        report.AtMost(what + "energy gained", "1", most, 1e-6);
      } else {
        report.AtMost(what + "error of the energy (relative)", "1", off, 1e-6);
      }
      report.AtMost(what + "error of the angular momentum", "kg m^2/s",
                    Norm(world.AngularMomentum(0) - spin), 1e-9);
      report.AtMost(what + "error of the momentum", "kg m/s", Norm(world.Momentum(0) - momentum),
                    1e-9);
    }
  }
}

const SceneEntry kEyelets("stiff cables", "Three bodies in flight on a cable through an eyelet",
                          "energy and momenta are conserved", ThroughEyelets);

/// A stiff robot of elastic rods: it rebounds without a gain of energy.
void Rebound(Report& report) {
  scenes::SixStrut robot = Robot(1e6, 0);
  robot.tension_n = 300;
  robot.center_m = {0, 0, 0.45};
  robot.material = {0.5, 0.5, 0.7};
  ModelDef def = robot.Def();
  PlaneDef ground;
  ground.name = "ground";
  ground.material = robot.material;
  def.planes.push_back(ground);
  for (BodyDef& body : def.bodies) body.angular_velocity_rad_per_s = {0, 0, 0};
  WorldBatch world = MakeBatch(def);
  const double start = EnergyOf(world);
  double gained = 0;
  for (int n = StepsIn(report.IsFull() ? 3 : 1, 1e-3); n > 0; --n) {
    world.Step(1e-3);
    gained = std::max(gained, EnergyOf(world) / start - 1);
  }
  report.AtMost("restitution 0.7: gain of energy", "1", gained, 1e-6);
  report.AtMost("restitution 0.7: status bits", "1", world.Status(0).bits, 0);
}

const SceneEntry kRebound("stiff cables", "Six-strut of elastic rods that rebounds",
                          "energy does not increase", Rebound);

/// Thresholds of the cable schemes: h^2 K = 0.1; with dampers h^2 K = 4; and unsupported elements.
void Schemes(Report& report) {
  const auto count = [](double k, double b, double h, CableScheme scheme, bool touches = false) {
    scenes::SixStrut robot = Robot(k, b);
    robot.tension_n = 5;
    ModelDef def = robot.Def();
    if (touches) {
      def.cables[0].touches = CableTouches::kTerrain;
      def.cables[0].radius_m = 1e-3;
    }
    Diagnostics complaints;
    const auto model = Model::Compile(def, complaints);
    const auto schemes = CableSchemes(*model, h);
    return static_cast<double>(std::count(schemes.begin(), schemes.end(), scheme));
  };
  report.Near("100 N/m, 1 ms: explicit", "1", count(100, 1, 1e-3, CableScheme::kExplicit), 24, 0);
  report.Near("1e6 N/m, 1 ms: implicit", "1", count(1e6, 0, 1e-3, CableScheme::kImplicit), 24, 0);
  report.Near("1e6 N/m with dampers, 1 ms: two stages", "1",
              count(1e6, 20, 1e-3, CableScheme::kImplicitDamped), 24, 0);
  report.Near("1e4 N/m with dampers, 1 ms: implicit", "1",
              count(1e4, 20, 1e-3, CableScheme::kImplicit), 24, 0);
  report.Near("one cable touches terrain: explicit, in substeps", "1",
              count(1e6, 20, 1e-3, CableScheme::kExplicit, true), 24, 0);
}

const SceneEntry kSchemes("stiff cables", "Scheme of a six-strut's cables",
                          "rule of theory/cables.md, section 3", Schemes);

}  // namespace
}  // namespace taut::mechanics
