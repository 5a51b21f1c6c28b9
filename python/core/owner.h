/// Something of C++ that one thread at a time may use, for all threads of Python.
#pragma once

#include <pybind11/pybind11.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "gil.h"

namespace taut::python {

template <class T>
class Owner {
 public:
  /// `what`, with its verb, is how errors call it: "this batch was".
  Owner(std::unique_ptr<T> owned, const char* what) : owned_(std::move(owned)), what_(what) {}
  /// A forked child leaves its copy alone: the threads that its destructor waits for are not there.
  ~Owner() {
    if (Forked()) static_cast<void>(owned_.release());
  }
  Owner(const Owner&) = delete;
  Owner& operator=(const Owner&) = delete;

  /// f(T&) with it for itself, while other Python threads go on. While it waits for its turn,
  /// Ctrl-C ends it. RuntimeError in a callback or a signal handler of a call that has it already.
  /// The GIL must be held.
  template <class F>
  auto With(F f) {
    CheckProcess();
    if (InUseHere()) {
      throw std::runtime_error(std::string(what_) +
                               " called from within a step of the same object: callbacks and "
                               "signal handlers may read it (time_s, hash ...), not change it");
    }
    return Locked(f);
  }

  /// The same for f that only reads, which callbacks and signal handlers may do, too.
  template <class F>
  auto Look(F f) {
    CheckProcess();
    return InUseHere() ? f(*owned_) : Locked(f);
  }

  /// For what never changes.
  const T& peek() const { return *owned_; }

  /// Whether this is a child process of the one that made it.
  bool Forked() const { return getpid() != pid_; }

  /// Throws in a forked child: it has none of the threads, and a lock that they held is held for
  /// ever.
  void CheckProcess() const {
    if (!Forked()) return;
    throw std::runtime_error(std::string(what_) +
                             " was made before fork(): make a new one in the child, or start "
                             "workers with multiprocessing's \"spawn\"");
  }

 private:
  bool InUseHere() const { return user_.load() == std::this_thread::get_id(); }

  template <class F>
  auto Locked(F f) {
    const Released others;
    std::unique_lock alone(mutex_, std::defer_lock);
    while (!alone.try_lock_for(std::chrono::milliseconds(100))) {
      const Acquired mine;
      if (SignalRaised()) throw pybind11::error_already_set();
    }
    const struct Use {
      std::atomic<std::thread::id>& user;
      explicit Use(std::atomic<std::thread::id>& of) : user(of) {
        user.store(std::this_thread::get_id());
      }
      ~Use() { user.store({}); }
    } use(user_);
    return f(*owned_);
  }

  std::unique_ptr<T> owned_;
  std::timed_mutex mutex_;
  std::atomic<std::thread::id> user_;  ///< Of the mutex; none: a thread's id of no thread.
  const char* what_;
  const pid_t pid_ = getpid();
};

}  // namespace taut::python
