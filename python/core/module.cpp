// The Python module taut._core; taut/__init__.py says what of it people see.
#include "taut/version.h"
#include "text.h"

PYBIND11_MODULE(_core, module) {
  module.doc() = "The simulator; use it through `import taut`.";
  module.attr("version") = taut::kVersion;
  taut::python::AddDescriptions(module);
  taut::python::AddBatch(module);
  taut::python::AddRuns(module);
  taut::python::AddEnvironments(module);
  taut::python::AddRollouts(module);
  taut::python::AddStudies(module);
  taut::python::AddFits(module);
  taut::python::AddAnalyses(module);
  taut::python::AddLinear(module);
}
