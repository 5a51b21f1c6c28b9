// The Python module taut._core; taut/__init__.py exports its public names.
#include <new>

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

/// Finds the bases of a class and keeps their list. Otherwise pybind11 would allocate it for the
/// first object of a subclass, where the interpreter cannot handle an exception.
void KeepBases(PyTypeObject* type) {
  try {
    py::detail::all_type_info(type);
  } catch (...) {
    py::detail::get_internals().registered_types_py.erase(type);  // the list of bases is incomplete
    throw;
  }
}

/// Prepares the classes of the module for objects without memory and without `__init__`.
void PrepareClasses(const py::module_& module) {
  const py::object super = py::module_::import("builtins").attr("super");
  for (const auto& [name, value] : module.attr("__dict__").cast<py::dict>()) {
    if (!PyType_Check(value.ptr())) continue;
    auto* const type = reinterpret_cast<PyTypeObject*>(value.ptr());
    KeepBases(type);
    const auto& bases = py::detail::all_type_info(type);
    if (bases.empty()) continue;  // the class is not one of pybind11
    for (py::detail::type_info* info : bases) info->operator_new = RaiseNotInitialized;
    const py::handle own = value;
    const py::cpp_function of_subclass([super, own](const py::type& made, const py::kwargs& more) {
      KeepBases(reinterpret_cast<PyTypeObject*>(made.ptr()));
      super(own, made).attr("__init_subclass__")(**more);
    });
    py::setattr(own, "__init_subclass__",
                py::reinterpret_steal<py::object>(PyClassMethod_New(of_subclass.ptr())));
  }
}

void Define(py::module_& module) {
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
  taut::python::AddLiveViews(module);
#ifdef TAUT_WITH_COMMAND
  taut::python::AddCommand(module);
#endif
  PrepareClasses(module);
  taut::python::EndOfProgram::Register();
}

}  // namespace

/// Replaces PYBIND11_MODULE, which turns every exception into an ImportError.
// NOLINTNEXTLINE(bugprone-reserved-identifier): the interpreter defines the name
extern "C" PYBIND11_EXPORT PyObject* PyInit__core() {
  PYBIND11_CHECK_PYTHON_VERSION
  try {
    PYBIND11_ENSURE_INTERNALS_READY
    static py::module_::module_def definition;
    py::module_ module = py::module_::create_extension_module("_core", nullptr, &definition);
    Define(module);
    return module.ptr();  // Python takes the reference that `module` only borrows
  } catch (py::error_already_set& error) {
    error.restore();
  } catch (const std::bad_alloc&) {
    PyErr_NoMemory();
  } catch (const std::exception& error) {
    PyErr_SetString(PyExc_ImportError, error.what());
  }
  return nullptr;
}
