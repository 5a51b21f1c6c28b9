#include "gil.h"

#include <pthread.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace taut::python {

namespace {

/// Longest waits at the end of the program: for computing threads, and for callbacks, which may
/// sleep forever.
constexpr std::chrono::seconds kLongestWork{10}, kLongestCall{1};

std::atomic<int> computing{0}, calling{0};
std::atomic<std::thread::id> ends_it;  ///< Thread that ends the program; no thread before the
                                       ///< program ends.

}  // namespace

bool EndOfProgram::Reached() {
  const std::thread::id thread = ends_it.load();
  return thread != std::thread::id() && thread != std::this_thread::get_id();
}

void EndOfProgram::Compute(int change) { computing += change; }

void EndOfProgram::Call(int change) { calling += change; }

void EndOfProgram::Sleep() {
  for (;;) pause();
}

void EndOfProgram::Begin() {
  ends_it.store(std::this_thread::get_id());  // with the GIL: no thread starts to compute later
  PyThreadState* const state = PyEval_SaveThread();
  const auto start = std::chrono::steady_clock::now();
  const auto within = [start](std::chrono::seconds limit) {
    return std::chrono::steady_clock::now() - start < limit;
  };
  while ((computing > 0 && within(kLongestWork)) || (calling > 0 && within(kLongestCall))) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  PyEval_RestoreThread(state);
}

void EndOfProgram::Register() {
  // Computing threads do not exist in a forked child.
  pthread_atfork(nullptr, nullptr, [] { computing = calling = 0; });
  pybind11::module_::import("atexit").attr("register")(pybind11::cpp_function(&Begin));
}

}  // namespace taut::python
