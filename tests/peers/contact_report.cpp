// Robots on the ground in taut, MuJoCo, Bullet and ODE: prints the data of docs/validation/peers.md
// as JSON. Not a test: the engines' contact laws differ by design.
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>

#include "benchmarks/peers/settings.h"
#include "math/vec.h"
#include "tests/peers/peers_robots.h"
#include "tests/peers/sled.h"

namespace taut::peers {
namespace {

using nlohmann::json;
constexpr double kStepS = 0.001;

/// taut behind the interface of the other engines.
class Ours final : public World {
 public:
  explicit Ours(const ModelDef& def) : batch_(Compiled(def), {}) {}
  void Step(double step_s, int count) override { batch_.Step(step_s, count); }
  void SetRestLength(int cable, double rest_length_m) override {
    batch_.SetRestLength(0, cable, rest_length_m);
  }
  CableState Cable(int cable) const override { return batch_.Cable(0, cable); }
  BodyState Body(int body) const override { return batch_.Body(0, body); }
  MassState Mass(int) const override { return {}; }
  int ContactCount() const override { return static_cast<int>(batch_.Contacts(0).size()); }

 private:
  static std::shared_ptr<const Model> Compiled(const ModelDef& def) {
    Diagnostics complaints;
    auto model = Model::Compile(def, complaints);
    if (model == nullptr) throw std::runtime_error(complaints.Format());
    return model;
  }
  WorldBatch batch_;
};

/// Runs a test on every engine and setting; returns the results by name.
json Each(const ModelDef& def, const std::function<json(World&)>& run) {
  json out = json::object();
  Ours ours(def);
  out["taut/default"] = run(ours);
  for (const Setting& setting : kSettings) {
    if (!Available(setting.engine)) continue;
    const auto world = MakeWorld(setting.engine, def, setting.options);
    out[std::string(Name(setting.engine)) + "/" + setting.name] = run(*world);
  }
  return out;
}

Vec3 Centre(const ModelDef& def, const World& world) {
  Vec3 sum;
  double mass_kg = 0;
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    sum = sum + def.bodies[b].mass_kg * world.Body(static_cast<int>(b)).position_m;
    mass_kg += def.bodies[b].mass_kg;
  }
  return (1 / mass_kg) * sum;
}

/// Returns height, tensions and contacts after 20 s, and the motion of the center in the next 5 s.
json Stand(const ModelDef& def, World& world) {
  world.Step(kStepS, 20000);
  const Vec3 before = Centre(def, world);
  json tensions = json::array();
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    tensions.push_back(world.Cable(static_cast<int>(c)).tension_n);
  }
  const int contacts = world.ContactCount();
  world.Step(kStepS, 5000);
  const Vec3 way = Centre(def, world) - before;
  return {{"height_m", before.z},
          {"tensions_n", tensions},
          {"contacts", contacts},
          {"creep_m_per_s", std::hypot(way.x, way.y) / 5}};
}

/// Returns the model with gravity inclined by 10 degrees towards `heading_rad`, which is equivalent
/// to a slope.
ModelDef Leaning(ModelDef def, double heading_rad) {
  const double lean = 10 * std::numbers::pi / 180, g = 9.81;
  def.gravity_m_per_s2 = {g * std::sin(lean) * std::cos(heading_rad),
                          g * std::sin(lean) * std::sin(heading_rad), -g * std::cos(lean)};
  return def;
}

json Slide(World& world) {
  world.Step(kStepS, 2000);
  const Vec3 p = world.Body(0).position_m;
  return std::hypot(p.x, p.y);
}

json Report() {
  json out;
  for (const char* robot : {"tetraspine3", "six_strut"}) {
    ModelDef def = test::OnGround(test::Robot(robot));
    // Six struts dropped upright would balance on two ends until rounding errors break the
    // symmetry.
    for (BodyDef& body : def.bodies) body.velocity_m_per_s = {0.1, 0.05, 0};
    json names = json::array();
    for (const CableDef& cable : def.cables) names.push_back(cable.name);
    out["cables"][robot] = names;
    out["stand"][robot] = Each(def, [&](World& world) { return Stand(def, world); });
  }
  for (const int degrees : {0, 45, 90}) {
    const double heading_rad = degrees * std::numbers::pi / 180;
    // On ground of 0.5 the product is 0.5.
    const ModelDef slope =
        Leaning(test::OnGround(test::Robot("tetraspine3", {{"friction", "1"}})), heading_rad);
    out["slope"][std::to_string(degrees)] =
        Each(slope, [&](World& world) { return Stand(slope, world)["creep_m_per_s"]; });
    out["slide"][std::to_string(degrees)] = Each(test::Sled(1, heading_rad), Slide);
  }
  for (const Engine engine : kEngines) out["versions"][Name(engine)] = Version(engine);
  return out;
}

}  // namespace
}  // namespace taut::peers

int main() {
  std::printf("%s\n", taut::peers::Report().dump(1).c_str());
  return 0;
}
