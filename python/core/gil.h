/// Release and acquisition of the interpreter's lock (GIL), safe also during interpreter shutdown.
/// Replaces pybind11's gil_scoped_release and gil_scoped_acquire, with which a daemon thread at
/// work when the program ends aborts it.
#pragma once

#include <cxxabi.h>
#include <pybind11/pybind11.h>
#include <unistd.h>

namespace taut::python {

/// Shutdown of a program while its daemon threads compute. They use static variables and the
/// interpreter, which are then destroyed. Therefore Python's atexit calls EndOfProgram::Begin(),
/// which waits for these threads; each of them sleeps as soon as it next releases or takes the GIL.
class EndOfProgram {
 public:
  /// Registers Begin() with Python's module atexit. The GIL must be held.
  static void Register();
  /// Returns whether another thread is ending the program.
  static bool Reached();
  /// Change the counts of threads that compute without the GIL, and of threads in callbacks.
  static void Compute(int change);
  static void Call(int change);
  /// Sleeps until the process has ended.
  [[noreturn]] static void Sleep();
  /// To be called at the end of a thread's work: puts it to sleep if the program is ending.
  static void SleepIfReached() {
    if (!Reached()) return;
    Compute(-1);
    Sleep();
  }

 private:
  static void Begin();
};

/// Returns f(); f calls C functions of Python and makes no objects with destructors. Up to 3.13
/// CPython ends a thread by pthread_exit() if it requests the lock while the interpreter ends. This
/// unwinds the stack, through destructors that are noexcept or need the lock. Such a thread sleeps
/// instead, as it does from 3.14 on.
template <class F>
auto OrSleep(F f) {
  try {
    return f();
  } catch (const abi::__forced_unwind&) {
    EndOfProgram::Sleep();
  }
}

/// Releases the GIL during its lifetime, so that other Python threads run. The GIL must be held.
class Released {
 public:
  Released() {
    if (EndOfProgram::Reached()) {
      PyEval_SaveThread();
      EndOfProgram::Sleep();
    }
    EndOfProgram::Compute(+1);  // before the GIL is released, so that Begin() waits
    state_ = PyEval_SaveThread();
  }
  ~Released() {
    EndOfProgram::SleepIfReached();
    OrSleep([this] { PyEval_RestoreThread(state_); });
    EndOfProgram::Compute(-1);
  }
  Released(const Released&) = delete;
  Released& operator=(const Released&) = delete;

 private:
  PyThreadState* state_;
};

/// Holds the GIL during its lifetime, within the lifetime of a Released on the same thread.
class Acquired {
 public:
  Acquired() {
    EndOfProgram::SleepIfReached();
    state_ = OrSleep([] { return PyGILState_Ensure(); });
    EndOfProgram::Call(+1);
    EndOfProgram::Compute(-1);
  }
  ~Acquired() {
    if (EndOfProgram::Reached()) {
      EndOfProgram::Call(-1);
      PyGILState_Release(state_);
      EndOfProgram::Sleep();
    }
    EndOfProgram::Compute(+1);
    EndOfProgram::Call(-1);
    PyGILState_Release(state_);
  }
  Acquired(const Acquired&) = delete;
  Acquired& operator=(const Acquired&) = delete;

 private:
  PyGILState_STATE state_;
};

/// Calls f(arguments...); throws error_already_set if it raises. The GIL must be held.
template <class... Arguments>
pybind11::object CallPython(const pybind11::object& f, Arguments&&... arguments) {
  const pybind11::tuple all = pybind11::make_tuple(std::forward<Arguments>(arguments)...);
  PyObject* const result = OrSleep([&] { return PyObject_CallObject(f.ptr(), all.ptr()); });
  if (result == nullptr) throw pybind11::error_already_set();
  return pybind11::reinterpret_steal<pybind11::object>(result);
}

/// Runs the handlers of pending signals. Returns true if one raised (Ctrl-C), with its exception
/// set. The GIL must be held.
inline bool SignalRaised() {
  return OrSleep([] { return PyErr_CheckSignals(); }) != 0;
}

}  // namespace taut::python
