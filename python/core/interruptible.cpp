#include "interruptible.h"

#include <pybind11/pybind11.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "gil.h"

namespace taut::python {

namespace py = pybind11;

void Interruptible(const std::function<void(const std::atomic<bool>& stop)>& work,
                   const std::function<void()>& look) {
  std::atomic<bool> stop{false};
  std::exception_ptr raised, failed;
  {
    const Released others;
    std::mutex mutex;
    std::condition_variable changed;
    bool done = false;
    std::thread worker([&] {
      try {
        work(stop);
      } catch (...) {
        failed = std::current_exception();
      }
      const std::lock_guard lock(mutex);
      done = true;
      changed.notify_all();
    });
    for (;;) {
      {
        std::unique_lock lock(mutex);
        if (changed.wait_for(lock, std::chrono::milliseconds(100), [&] { return done; })) break;
      }
      if (EndOfProgram::Reached()) stop = true;
      if (stop) continue;
      const Acquired mine;
      try {
        if (SignalRaised()) throw py::error_already_set();
        if (look) look();
      } catch (const abi::__forced_unwind&) {  // end of the thread, not an exception
        EndOfProgram::Sleep();
      } catch (...) {  // the worker must end before this function returns, whatever the exception
        raised = std::current_exception();
        stop = true;
      }
    }
    worker.join();
  }
  if (raised) std::rethrow_exception(raised);
  if (failed) std::rethrow_exception(failed);
}

}  // namespace taut::python
