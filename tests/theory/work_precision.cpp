/// Prints work and precision of integration schemes of cables as CSV, from which
/// script/work_precision makes the figure of docs/theory/work_precision.md. The output is
/// independent of clocks.

#include <cstdio>

#include "tests/theory/work_precision.h"

int main() {
  std::printf("problem;scheme;step_s;visits_per_s;error\n");
  for (const auto& points : {taut::test::MeasureSoft(), taut::test::MeasureStiff()}) {
    for (const taut::test::WorkPoint& point : points) {
      std::printf("%s;%s;%.6g;%.6g;%.3g\n", point.problem.c_str(), point.scheme.c_str(),
                  point.step_s, point.visits_per_s, point.error);
    }
  }
}
