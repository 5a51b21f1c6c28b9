// Example of a user-defined friction law: a floor with a wet patch.
//
//   own_friction
//
// A block slides over a dry floor into a patch of oil, 0.5 m long, and out of it again. The law is
// a class: each step calls it for the coefficients of all contacts (taut/friction.h). The example
// asserts that the block comes to rest at the distance that follows from energy, v0^2 / 2 g = sum
// of mu times distance, that it stops before the patch without the class, and that eight worlds on
// two threads have the same bits as one.
#include <cmath>
#include <cstdio>
#include <memory>

#include "taut/friction.h"
#include "taut/world_batch.h"

namespace {

constexpr double kDry = 0.4, kWet = 0.05;     // coefficients of friction
constexpr double kFrom_m = 1.0, kTo_m = 1.5;  // the patch, along x
constexpr double kSpeed_m_per_s = 3.2, kG = 9.81;

class WetPatch final : public taut::ContactFriction {
 public:
  double Coefficient(const taut::FrictionContact& contact) const noexcept override {
    const double x = contact.point_m.x;
    return x > kFrom_m && x < kTo_m ? kWet : contact.kinetic_friction;
  }
};

taut::ModelDef Block() {
  taut::ModelDef def;
  const taut::Vec3 half{0.05, 0.05, 0.01};
  const double mass = 1, third = mass / 3;
  taut::BodyDef body;
  body.name = "block";
  body.mass_kg = mass;
  body.com_m = {0, 0, half.z};
  body.inertia_kg_m2.xx = body.inertia_kg_m2.yy = third * (half.x * half.x + half.z * half.z);
  body.inertia_kg_m2.zz = third * 2 * half.x * half.x;
  body.velocity_m_per_s = {kSpeed_m_per_s, 0, 0};
  def.bodies.push_back(body);
  def.boxes.push_back({"block", 0, body.com_m, {}, half, {kDry, kDry, 0}});
  def.planes.push_back({"floor", {0, 0, 1}, {}, {kDry, kDry, 0}});
  return def;
}

/// Returns the stopping distance [m] of the last world; `hash` receives its hash.
double Way(std::shared_ptr<const taut::ContactFriction> law, int worlds, std::uint64_t& hash) {
  taut::Diagnostics complaints;
  const auto model = taut::Model::Compile(Block(), complaints);
  if (!model) {
    std::fputs(complaints.Format().c_str(), stderr);
    return std::nan("");
  }
  taut::WorldBatchOptions options;
  options.worlds = worlds;
  options.threads = worlds > 1 ? 2 : 1;
  options.friction = std::move(law);
  taut::WorldBatch batch(model, options);
  batch.Step(1e-3, 2000);
  hash = batch.Hash(worlds - 1);
  return batch.Body(worlds - 1, 0).position_m.x;
}

}  // namespace

int main() {
  std::uint64_t alone = 0, beside = 0;
  const auto law = std::make_shared<const WetPatch>();
  const double dry = Way(nullptr, 1, alone), wet = Way(law, 1, alone), again = Way(law, 8, beside);
  const double energy = kSpeed_m_per_s * kSpeed_m_per_s / (2 * kG);  // a height [m]
  const double patch = kTo_m - kFrom_m;
  const double expected = energy > kDry * kFrom_m + kWet * patch
                              ? kTo_m + (energy - kDry * kFrom_m - kWet * patch) / kDry
                              : kFrom_m + (energy - kDry * kFrom_m) / kWet;
  std::printf("stops after %.4f m; with a wet patch after %.4f m, by energy %.4f m\n", dry, wet,
              expected);
  // A block is not a point: it leans on its front, by its height times mu.
  const bool good = std::abs(dry - energy / kDry) < 1e-5 && std::abs(wet - expected) < 0.02 &&
                    wet == again && alone == beside;
  if (!good) std::puts("not as expected");
  return good ? 0 : 1;
}
