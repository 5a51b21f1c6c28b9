// Example of a browser page of a program: two worlds side by side.
//
//   watch share/models/prism3.yaml            open the address that it prints
//   watch share/models/prism3.yaml 0          without waiting, for tests
//
// One prism slides over rough ground, another over ice. The page shows both, their cables'
// tensions, their ground and their distances. Pausing in the page pauses the program. The example
// asserts that the prism on ice slides farther.
#include <cstdio>
#include <cstdlib>

#include "taut/page.h"
#include "taut/spec.h"

namespace {

constexpr int kRough = 0, kIce = 1;
constexpr double kStepS = 0.001, kDurationS = 3.0;

double WayM(const taut::WorldBatch& batch, int world) { return batch.Body(world, 0).position_m.x; }

}  // namespace

int main(int argc, char** argv) {
  taut::Diagnostics out;
  auto robot = argc >= 2 ? taut::LoadRobot(argv[1], {}, out) : std::nullopt;
  if (!robot) {
    std::fprintf(stderr, "usage: watch share/models/prism3.yaml [SPEED]\n%s", out.Format().c_str());
    return 2;
  }
  robot->def.planes.emplace_back().name = "ground";
  for (taut::BodyDef& body : robot->def.bodies) body.velocity_m_per_s = {1.0, 0.0, 0.0};
  const auto model = taut::Model::Compile(robot->def, out);
  taut::PageOptions options;
  options.title = "rough and ice";
  options.speed = argc > 2 ? std::atof(argv[2]) : 1.0;
  const auto page = model ? taut::Page::Open(options, out) : nullptr;
  if (!page) {
    std::fputs(out.Format().c_str(), stderr);
    return 1;
  }
  std::printf("Open %s\n", page->url().c_str());
  std::fflush(stdout);

  taut::WorldBatchOptions two;
  two.worlds = 2;
  taut::WorldBatch batch(model, two);
  batch.SetParameter(kIce, taut::Parameter::kFrictionScale, 0, 0.1);
  const int rough = page->Add(model->def(), "rough");
  const int ice = page->Add(model->def(), "ice", {0.0, 0.5, 0.0});
  while (batch.Time(0) < kDurationS) {
    batch.Step(kStepS);
    page->Set(rough, batch, kRough);
    page->Set(ice, batch, kIce);
    page->Plot("ahead_m", "m", WayM(batch, kIce) - WayM(batch, kRough));
    page->Show(batch.Time(0));
  }
  std::printf("rough: %.3f m, ice: %.3f m\n", WayM(batch, kRough), WayM(batch, kIce));
  return WayM(batch, kIce) > WayM(batch, kRough) ? 0 : 1;
}
