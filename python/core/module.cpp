// The Python module taut._core; taut/__init__.py exports its public names.
#include "gil.h"
#include "taut/version.h"
#include "text.h"

namespace {

namespace py = pybind11;

/// Raises an exception for uninitialized objects: if an object was created by `__new__` alone, or
/// its subclass has not called `super().__init__()` yet, pybind11 would allocate memory through
/// this hook and use its contents as the object.
void* RaiseNotInitialized(std::size_t) {
  throw py::type_error("this object is not initialized: its __init__() has not been called");
}

void RefuseWhatIsNotInitialized(const py::module_& module) {
  for (const auto& [name, value] : module.attr("__dict__").cast<py::dict>()) {
    if (!PyType_Check(value.ptr())) continue;
    auto* const type = reinterpret_cast<PyTypeObject*>(value.ptr());
    for (py::detail::type_info* info : py::detail::all_type_info(type)) {
      info->operator_new = RaiseNotInitialized;
    }
  }
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  module.doc() = "C++ part of the simulator; use it through `import taut`.";
  module.attr("version") = taut::kVersion;
  // Before 2.12, pybind11 reads the layout of NumPy 1. With NumPy 2, it would silently return
  // arrays whose elements are all the first one.
  module.attr("supports_numpy_2") = PYBIND11_VERSION_HEX >= 0x020C0000;
  taut::python::AddDescriptions(module);
  taut::python::AddBatch(module);
  taut::python::AddControllers(module);
  taut::python::AddSimulation(module);
  taut::python::AddRuns(module);
  taut::python::AddEnvironments(module);
  taut::python::AddRollouts(module);
  taut::python::AddStudies(module);
  taut::python::AddFits(module);
  taut::python::AddAnalyses(module);
  taut::python::AddLinear(module);
#ifdef TAUT_WITH_COMMAND
  taut::python::AddCommand(module);
#endif
  RefuseWhatIsNotInitialized(module);
  taut::python::EndOfProgram::Register();
}
