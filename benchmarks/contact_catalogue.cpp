#include "benchmarks/contact_catalogue.h"

#include <numbers>

#include "benchmarks/robots.h"
#include "tests/scenes/chance.h"
#include "tests/scenes/heap.h"
#include "tests/scenes/many_rows.h"
#include "tests/scenes/prism_tower.h"
#include "tests/scenes/single_rod.h"
#include "tests/scenes/spine_on_rubble.h"
#include "tests/scenes/stacks.h"

namespace taut::bench {
namespace {

using Seed = std::uint64_t;

void AddHeaps(std::vector<ContactScene>& all) {
  const auto heap = [&](const std::string& name, int rods, double friction) {
    all.push_back({name, [=](Seed seed) {
                     scenes::RodHeap scene;
                     scene.rods = rods;
                     scene.friction = friction;
                     scene.seed = seed;
                     return scene.Def();
                   }});
  };
  for (const int rods : {10, 20, 40}) heap("pile_" + std::to_string(rods), rods, 0.5);
  heap("pile_20_mu.8", 20, 0.8);
}

void AddStacks(std::vector<ContactScene>& all) {
  for (const int boxes : {3, 6, 10}) {
    all.push_back({"boxes_" + std::to_string(boxes), [=](Seed seed) {
                     scenes::BoxStack stack;
                     stack.boxes = boxes;
                     stack.seed = seed;
                     return stack.Def();
                   }});
  }
  all.push_back({"logs_20",
                 [](Seed seed) {
                   scenes::LogPile pile;
                   pile.seed = seed;
                   return pile.Def();
                 },
                 1000});
  for (const int power : {2, 4, 6}) {
    all.push_back({"slab_1e" + std::to_string(power),
                   [=](Seed seed) {
                     scenes::SlabOnRods slab;
                     slab.mass_ratio = std::pow(10.0, power);
                     slab.seed = seed;
                     return slab.Def();
                   },
                   1000});
  }
}

void AddManyRows(std::vector<ContactScene>& all) {
  for (const int feet : {8, 16, 32, 64, 128, 256}) {
    all.push_back({.name = "feet_" + std::to_string(feet),
                   .def =
                       [=](Seed seed) {
                         scenes::FootedDisc disc;
                         disc.feet = feet;
                         disc.left_m = 0.2 * static_cast<double>(seed);
                         return disc.Def();
                       },
                   .steps = 1500,
                   .moves = true});
  }
  const auto net = [&](const std::string& name, double stiffness, double damping) {
    all.push_back({.name = name,
                   .def =
                       [=](Seed seed) {
                         scenes::BallInNet scene;
                         scene.stiffness_n_per_m = stiffness;
                         scene.damping_n_s_per_m = damping;
                         scene.seed = seed;
                         return scene.Def();
                       },
                   .steps = 1000,
                   .for_peers = false});
  };
  for (const int power : {4, 5, 6, 7})
    net("net_1e" + std::to_string(power), std::pow(10, power), 0);
  net("net_1e7b1e4", 1e7, 1e4);
}

void AddHeldOut(std::vector<ContactScene>& all) {
  const auto add = [&](const std::string& name, auto scene) {
    all.push_back({.name = name,
                   .def =
                       [=](Seed seed) {
                         auto own = scene;
                         own.seed = seed;
                         return own.Def();
                       },
                   .steps = 2000,
                   .held_out = true});
  };
  add("bricks_14", scenes::BrickWall());
  add("mixed_20", scenes::MixedHeap());
  add("prisms_4", scenes::PrismTower());
  add("rubble", scenes::SpineOnRubble());
}

}  // namespace

std::vector<ContactScene> ContactScenes() {
  std::vector<ContactScene> all;
  // Reference for the others: a robot that walks on flat ground.
  all.push_back(
      {.name = "tetraspine3", .def = [](Seed) { return OnGround("tetraspine3"); }, .moves = true});
  AddHeaps(all);
  AddStacks(all);
  AddManyRows(all);
  all.push_back({"wedge", [](Seed seed) {
                   scenes::Chance chance(seed);
                   scenes::RodInWedge rod;
                   rod.tilt_rad = chance.Within(-0.4, 0.4);
                   return rod.Def();
                 }});
  AddHeldOut(all);
  return all;
}

std::vector<ModelDef> PainleveGrid() {
  std::vector<ModelDef> grid;
  for (int mu = 4; mu < 40; mu += 2) {              // tenths
    for (int angle = 15; angle < 88; angle += 6) {  // degrees
      for (const double velocity : {3.0, -3.0}) {
        scenes::PainleveRod rod;
        rod.friction = 0.1 * mu;
        rod.angle_rad = angle * std::numbers::pi / 180;
        rod.velocity_m_per_s = velocity;
        grid.push_back(rod.Def());
      }
    }
  }
  return grid;
}

}  // namespace taut::bench
