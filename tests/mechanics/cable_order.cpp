/// Order in which a file lists cables and bodies.

#include <algorithm>
#include <random>

#include "scenes/six_strut.h"
#include "tests/mechanics/scene.h"
#include "tests/physics/world.h"

namespace taut::mechanics {
namespace {

constexpr double kStepS = 1e-3, kTimeS = 0.3;

/// A six-strut whose prestress is out of balance: its rest lengths differ by up to a tenth.
ModelDef SixStrut(double damping_n_s_per_m, const Quat& turn = {}) {
  scenes::SixStrut scene;
  scene.damping_n_s_per_m = damping_n_s_per_m;
  scene.orientation = turn;
  ModelDef def = scene.Def();
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    def.cables[c].rest_length_m *= 1 - 0.02 * static_cast<double>(c % 6);
  }
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    def.bodies[b].velocity_m_per_s = Rotate(turn, {1, 0.1 * static_cast<double>(b), 0});
    def.bodies[b].angular_velocity_rad_per_s =
        Rotate(turn, {0, 1, 0.5 * static_cast<double>(b % 2)});
  }
  return def;
}

ModelDef Floating(double damping_n_s_per_m, const Quat& turn) {
  ModelDef def = SixStrut(damping_n_s_per_m, turn);
  def.gravity_m_per_s2 = {0, 0, 0};
  return def;
}

ModelDef FloatingAsBuilt(double damping_n_s_per_m) { return Floating(damping_n_s_per_m, {}); }

/// It touches the ground after 20 ms.
ModelDef OnGround(double damping_n_s_per_m) {
  ModelDef def = SixStrut(damping_n_s_per_m);
  PlaneDef ground;
  ground.point_m.z = 0.48;
  ground.material = {0.5, 0.5, 0.0};
  def.planes.push_back(ground);
  return def;
}

void ReverseCables(ModelDef& def) { std::reverse(def.cables.begin(), def.cables.end()); }

void ShuffleCables(ModelDef& def) {
  std::mt19937 random(1);
  for (std::size_t i = def.cables.size() - 1; i > 0; --i) {
    std::swap(def.cables[i], def.cables[random() % (i + 1)]);
  }
}

void ShuffleNamelessCables(ModelDef& def) {
  ShuffleCables(def);
  for (CableDef& cable : def.cables) cable.name.clear();
}

void ReverseBodies(ModelDef& def) {
  const int last = static_cast<int>(def.bodies.size()) - 1;
  std::reverse(def.bodies.begin(), def.bodies.end());
  for (CapsuleDef& rod : def.capsules) rod.body = last - rod.body;
  std::reverse(def.capsules.begin(), def.capsules.end());
  for (CableDef& cable : def.cables) {
    for (AttachmentDef& at : cable.attachments) at.body = last - at.body;
  }
}

/// Where both ends of all rods are after kTimeS, by the rods' names.
std::vector<Vec3> PlacesAfter(const ModelDef& def, double step_s) {
  Batch world = test::MakeBatch(def);
  world.Step(step_s, test::StepsIn(kTimeS, step_s));
  std::vector<std::pair<std::string, int>> rods;
  for (const BodyDef& body : def.bodies) {
    rods.emplace_back(body.name, static_cast<int>(rods.size()));
  }
  std::sort(rods.begin(), rods.end());
  std::vector<Vec3> places;
  for (const auto& [name, body] : rods) {
    const BodyState at = world.Body(0, body);
    for (const CapsuleDef& rod : def.capsules) {
      if (rod.body != body) continue;
      const Vec3& com_m = def.bodies[static_cast<std::size_t>(body)].com_m;
      for (const Vec3& end : {rod.from_m, rod.to_m}) {
        places.push_back(at.position_m + Rotate(at.orientation, end - com_m));
      }
    }
  }
  return places;
}

double Largest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, test::Distance(a[i], b[i]));
  return most;
}

std::string Quantity(const char* where, double damping_n_s_per_m, const char* what) {
  return std::string(where) + ", b = " + (damping_n_s_per_m > 5 ? "100" : "5") + " N s/m, " + what;
}

/// `nameless`: where cables have no names, what decides is where they are attached.
void ListInAnyOrder(Report& report, const char* where, ModelDef (*scene)(double), double bound_m) {
  for (const double damping : {5.0, 100.0}) {
    ModelDef nameless = scene(damping);
    for (CableDef& cable : nameless.cables) cable.name.clear();
    const std::vector<Vec3> places = PlacesAfter(scene(damping), kStepS),
                            places_nameless = PlacesAfter(nameless, kStepS);
    const auto compare = [&](const char* what, void (*change)(ModelDef&),
                             const std::vector<Vec3>& with) {
      ModelDef other = scene(damping);
      change(other);
      report.AtMost(Quantity(where, damping, what), "m", Largest(PlacesAfter(other, kStepS), with),
                    bound_m);
    };
    compare("cables reversed", ReverseCables, places);
    compare("cables shuffled", ShuffleCables, places);
    compare("cables without names shuffled", ShuffleNamelessCables, places_nameless);
    compare("bodies reversed", ReverseBodies, places);
  }
}

void Order(Report& report) {
  const int steps = test::StepsIn(kTimeS, kStepS);
  ListInAnyOrder(report, "floating", FloatingAsBuilt, test::RoundOff(steps, 1));
  ListInAnyOrder(report, "on ground", OnGround, test::SolverError(steps) * kTimeS);
}

const SceneEntry kOrder("cables", "Six-strut with damped cables, listed in another order",
                        "the same motion", Order);

/// The order of the cables must not come from where they are, either.
void Turned(Report& report) {
  const double s = std::sin(0.35) / std::sqrt(14.0);
  const Quat turn{std::cos(0.35), s, 2 * s, 3 * s};
  const Vec3 center{0, 0, 1};
  for (const double damping : {5.0, 100.0}) {
    std::vector<Vec3> places = PlacesAfter(FloatingAsBuilt(damping), kStepS);
    for (Vec3& place : places) place = center + Rotate(turn, place - center);
    report.AtMost(Quantity("floating", damping, "turned by 0.7 rad"), "m",
                  Largest(PlacesAfter(Floating(damping, turn), kStepS), places),
                  test::RoundOff(test::StepsIn(kTimeS, kStepS), 1));
  }
}

const SceneEntry kTurned("cables", "Six-strut with damped cables, turned in space",
                         "the same motion, turned", Turned);

}  // namespace
}  // namespace taut::mechanics
