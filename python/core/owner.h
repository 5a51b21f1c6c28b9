/// Exclusive ownership of a C++ object that one thread at a time may use, shared by all Python
/// threads.
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
  /// `what`: subject and verb for error messages: "this batch was".
  Owner(std::unique_ptr<T> owned, const char* what) : owned_(std::move(owned)), what_(what) {}
  /// A forked child does not destroy its copy: the threads that the destructor waits for do not
  /// exist there.
  ~Owner() {
    if (Forked()) static_cast<void>(owned_.release());
  }
  Owner(const Owner&) = delete;
  Owner& operator=(const Owner&) = delete;

  /// Calls f(T&) with exclusive access, while other Python threads run. Ctrl-C ends the wait for
  /// access. Raises RuntimeError within a callback or a signal handler of a call that already has
  /// access. The GIL must be held.
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

  /// Calls f for reading only, which is also allowed in callbacks and signal handlers.
  template <class F>
  auto Look(F f) {
    CheckProcess();
    return InUseHere() ? f(*owned_) : Locked(f);
  }

  /// Returns the object for access to its constant parts.
  const T& peek() const { return *owned_; }

  /// Returns whether this process is a child of the process that created the object.
  bool Forked() const { return getpid() != pid_; }

  /// Throws in a forked child: the object's threads do not exist there, and a lock that they held
  /// is held forever.
  void CheckProcess() const {
    if (!Forked()) return;
    throw std::runtime_error(std::string(what_) +
                             " made before fork(): make a new one in the child, or start "
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
  std::atomic<std::thread::id> user_;  ///< Thread that holds the mutex, or the id of no thread.
  const char* what_;
  const pid_t pid_ = getpid();
};

}  // namespace taut::python
