/// Something of C++ that one thread at a time may use, for all threads of Python.
#pragma once

#include <pybind11/pybind11.h>
#include <unistd.h>

#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

namespace taut::python {

template <class T>
class Owner {
 public:
  /// `what`, with its verb, is how errors call it: "this batch was".
  Owner(std::unique_ptr<T> owned, const char* what) : owned_(std::move(owned)), what_(what) {}

  /// f(T&) with it for itself, while other Python threads go on. The GIL must be held.
  template <class F>
  auto With(F f) {
    // A forked child has none of the threads, and whatever they held would be held for ever.
    if (getpid() != pid_) {
      throw std::runtime_error(std::string(what_) +
                               " made before fork(): make it anew in the child, or start workers "
                               "with multiprocessing's \"spawn\"");
    }
    const pybind11::gil_scoped_release others;
    const std::lock_guard<std::mutex> alone(mutex_);
    return f(*owned_);
  }

  /// For what never changes.
  const T& peek() const { return *owned_; }

 private:
  std::unique_ptr<T> owned_;
  std::mutex mutex_;
  const char* what_;
  const pid_t pid_ = getpid();
};

}  // namespace taut::python
