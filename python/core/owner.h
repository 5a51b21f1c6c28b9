/// Exclusive ownership of a C++ object that one thread at a time may use, shared by all Python
/// threads.
#pragma once

#include <pybind11/pybind11.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdint>
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
    return Locked([&](T& owned) {
      const Change change(changes_);
      return f(owned);
    });
  }

  /// Calls f for reading only, which is also allowed in callbacks and signal handlers.
  template <class F>
  auto Look(F f) {
    CheckProcess();
    return InUseHere() ? f(*owned_) : Locked(f);
  }

  /// Calls f(T&), which only reads, without the GIL and from any thread of C++. Returns false
  /// instead if another thread has access at present.
  template <class F>
  bool TryLook(F f) {
    const std::unique_lock alone(mutex_, std::try_to_lock);
    if (!alone.owns_lock()) return false;
    f(*owned_);
    return true;
  }

  /// Returns a number that every call of `With` changes; odd during the call.
  std::uint64_t changes() const { return changes_.load(std::memory_order_relaxed); }

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
  /// Counts the start and the end of a call of `With`. Only the thread with access writes.
  class Change {
   public:
    explicit Change(std::atomic<std::uint64_t>& count) : count_(count) { Add(); }
    ~Change() { Add(); }
    Change(const Change&) = delete;
    Change& operator=(const Change&) = delete;

   private:
    void Add() {
      count_.store(count_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    }
    std::atomic<std::uint64_t>& count_;
  };

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
  std::atomic<std::uint64_t> changes_{0};
  const char* what_;
  const pid_t pid_ = getpid();
};

}  // namespace taut::python
