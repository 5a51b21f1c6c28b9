/// The interpreter's lock (GIL), released and taken back, also while the interpreter ends. Stands
/// in for pybind11's gil_scoped_release and gil_scoped_acquire, by which a daemon thread that is at
/// work when the program ends aborts it.
#pragma once

#include <cxxabi.h>
#include <pybind11/pybind11.h>
#include <unistd.h>

namespace taut::python {

/// Returns f(), which calls C functions of Python and makes no objects with destructors. Up to 3.13
/// CPython ends a thread by pthread_exit() if it wants the lock while the interpreter ends. That
/// unwinds the stack, through destructors that are noexcept or need the lock. Such a thread sleeps
/// instead until the process is gone, as it does from 3.14 on.
template <class F>
auto OrSleep(F f) {
  try {
    return f();
  } catch (const abi::__forced_unwind&) {
    for (;;) pause();
  }
}

/// Other Python threads run during its lifetime. The GIL must be held.
class Released {
 public:
  Released() : state_(PyEval_SaveThread()) {}
  ~Released() {
    OrSleep([this] { PyEval_RestoreThread(state_); });
  }
  Released(const Released&) = delete;
  Released& operator=(const Released&) = delete;

 private:
  PyThreadState* const state_;
};

/// Holds the GIL during its lifetime, on a thread that called from Python.
class Acquired {
 public:
  Acquired() : state_(OrSleep([] { return PyGILState_Ensure(); })) {}
  ~Acquired() { PyGILState_Release(state_); }
  Acquired(const Acquired&) = delete;
  Acquired& operator=(const Acquired&) = delete;

 private:
  const PyGILState_STATE state_;
};

/// f(arguments...); throws error_already_set if it raises. The GIL must be held.
template <class... Arguments>
pybind11::object CallPython(const pybind11::object& f, Arguments&&... arguments) {
  const pybind11::tuple all = pybind11::make_tuple(std::forward<Arguments>(arguments)...);
  PyObject* const result = OrSleep([&] { return PyObject_CallObject(f.ptr(), all.ptr()); });
  if (result == nullptr) throw pybind11::error_already_set();
  return pybind11::reinterpret_steal<pybind11::object>(result);
}

/// Runs handlers of signals that have come. True if one raised (Ctrl-C): its exception is set. The
/// GIL must be held.
inline bool SignalRaised() {
  return OrSleep([] { return PyErr_CheckSignals(); }) != 0;
}

}  // namespace taut::python
