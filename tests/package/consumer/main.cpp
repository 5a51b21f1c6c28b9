// Program that uses every layer of an installed taut, so that a missing library is detected: reads
// a model, steps it, computes a tension set point, writes and reads a trace.
#include <cmath>
#include <cstdio>

#include "taut/control/impedance.h"
#include "taut/spec.h"
#include "taut/trace.h"
#include "taut/version.h"
#include "taut/world_batch.h"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  taut::Diagnostics diagnostics;
  const auto robot = taut::LoadRobot(argv[1], {}, diagnostics);
  const auto model = robot ? taut::Model::Compile(robot->def, diagnostics) : nullptr;
  const auto trace =
      model ? taut::CreateHdf5Trace(argv[2], {{"cable/0/tension_n", "N"}}, {}, diagnostics)
            : nullptr;
  if (!trace) {
    std::fputs(diagnostics.Format().c_str(), stderr);
    return 1;
  }
  taut::WorldBatch batch(model, {});
  for (int step = 1; step <= 10; ++step) {
    batch.Step(0.001);
    const double tension_n = batch.Cable(0, 0).tension_n;
    if (!trace->Append(step * 0.001, &tension_n)) return 1;
  }
  if (!trace->Finish()) return 1;
  const auto read = taut::ReadTrace(argv[2], diagnostics);
  const taut::control::Impedance<double> law{7.0, 0.2, 100.0, 100.0};
  const taut::CableState cable = batch.Cable(0, 0);
  const double set_point_n =
      taut::control::ImpedanceTension(law, cable.length_m, cable.rate_m_per_s, 0.0);
  if (!read || read->values.at(0).size() != 10) return 1;
  if (!(cable.tension_n > 0.0) || !std::isfinite(set_point_n)) return 1;
  std::printf("taut %s: %zu cables, %.3f N, set point %.3f N\n", taut::kVersion,
              robot->def.cables.size(), cable.tension_n, set_point_n);
  return 0;
}
