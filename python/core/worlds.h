/// C++ part of `taut.Batch`, for the files that add its methods.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "live_view.h"
#include "owner.h"
#include "taut/simulation.h"
#include "taut/world_batch.h"
#include "text.h"

namespace taut::python {

/// Raises ValueError for a number of worlds that would overflow integers.
inline void CheckWorlds(int worlds) {
  constexpr int kMost = 1'000'000'000;
  if (worlds >= 1 && worlds <= kMost) return;
  throw py::value_error(fmt::format("worlds: {}; expected 1 to {}", worlds, kMost));
}

/// Return the state of a world for a live view.
LiveView::State StateOf(WorldBatch& batch, int world);
LiveView::State StateOf(Simulation& simulation, int world);

/// Object T with worlds, which Python threads share; one thread at a time has access (`Owner`).
template <class T>
class OwnedWorlds {
 public:
  OwnedWorlds() = default;
  ~OwnedWorlds() {
    for (const Viewed& viewed : views_) viewed.view->Detach();
  }
  OwnedWorlds(const OwnedWorlds&) = delete;
  OwnedWorlds& operator=(const OwnedWorlds&) = delete;

  /// Calls f(T&), which may change the object; see `Owner`.
  template <class F>
  auto With(F f) {
    return owned_->With(f);
  }
  /// Calls f(T&), which only reads.
  template <class F>
  auto Look(F f) {
    return owned_->Look(f);
  }
  const T& peek() const { return owned_->peek(); }

  /// Opens a live view of a world, or returns an open view. Returns null, with errors in
  /// `out`, if the page cannot be opened. The GIL must be held.
  std::shared_ptr<LiveView> Show(const ExperimentSpec& experiment, int world,
                                 const LiveOptions& options, Diagnostics& out) {
    owned_->CheckProcess();
    for (const Viewed& viewed : views_) {
      if (viewed.world == world && !viewed.view->closed()) return viewed.view;
    }
    Owner<T>* const owned = owned_.get();
    const auto requested = std::make_shared<std::atomic<bool>>(false);
    LiveView::Source source;
    source.changes = [owned] { return owned->changes(); };
    source.read = [owned, world](LiveView::State& state) {
      return owned->TryLook([&](T& t) { state = StateOf(t, world); });
    };
    source.request = [this, requested] {
      requested->store(true);
      any_requested_.store(true, std::memory_order_release);
    };
    auto view = LiveView::Open(experiment, std::move(source), options, out);
    if (!view) return nullptr;
    const std::lock_guard lock(views_mutex_);
    std::erase_if(views_, [](const Viewed& viewed) { return viewed.view->closed(); });
    views_.push_back({view, world, requested});
    was_viewed_ = true;
    return view;
  }
  /// Returns whether a live view is open; then long calls should be divided into short pieces.
  bool is_viewed() {
    if (!was_viewed_.load(std::memory_order_relaxed)) return false;
    const std::lock_guard lock(views_mutex_);
    return std::any_of(views_.begin(), views_.end(),
                       [](const Viewed& viewed) { return !viewed.view->closed(); });
  }
  /// Shows the present states if a live view has requested them. To be called between two steps by
  /// the thread that has access.
  void ShowIfRequested(T& t) {
    if (!any_requested_.load(std::memory_order_relaxed)) return;
    any_requested_.exchange(false, std::memory_order_acquire);
    const std::lock_guard lock(views_mutex_);
    for (const Viewed& viewed : views_) {
      if (viewed.requested->exchange(false)) viewed.view->Take(StateOf(t, viewed.world));
    }
  }

  int worlds() const { return peek().worlds(); }
  /// Returns the index of a world; raises IndexError.
  int World(py::ssize_t world) const { return Index(world, worlds(), "world"); }
  /// Returns the range [first, last) of worlds that an argument selects: one, or all for None.
  std::pair<int, int> Range(std::optional<py::ssize_t> world) const {
    if (!world) return {0, worlds()};
    const int first = World(*world);
    return {first, first + 1};
  }

 protected:
  std::unique_ptr<Owner<T>> owned_;

 private:
  struct Viewed {
    std::shared_ptr<LiveView> view;
    int world;
    std::shared_ptr<std::atomic<bool>> requested;
  };
  std::atomic<bool> was_viewed_{false}, any_requested_{false};
  std::mutex views_mutex_;  ///< Changes of `views_` need the GIL, too.
  std::vector<Viewed> views_;
};

/// Worlds of a batch. Thread-safe: calls from several Python threads wait for each other.
class Worlds : public OwnedWorlds<WorldBatch> {
 public:
  Worlds(const ModelDef& def, int worlds, int threads, const std::optional<std::string>& simd) {
    CheckWorlds(worlds);
    WorldBatchOptions options;
    options.worlds = worlds;
    options.threads = Threads(threads);
    options.simd = SimdOf(simd);
    Diagnostics said;
    std::unique_ptr<WorldBatch> batch;
    {
      const Released others;
      if (auto model = Model::Compile(def, said)) {
        batch = std::make_unique<WorldBatch>(std::move(model), options);
      }
    }
    if (!batch) Refuse(said);
    Tell(said);
    owned_ = std::make_unique<Owner<WorldBatch>>(std::move(batch), "this batch was");
  }

  const ModelDef& def() const { return peek().model().def(); }
  int lanes() const { return peek().lanes(); }
  py::ssize_t bodies() const { return static_cast<py::ssize_t>(def().bodies.size()); }
  py::ssize_t cables() const { return static_cast<py::ssize_t>(def().cables.size()); }
  py::ssize_t nodes() const { return static_cast<py::ssize_t>(def().nodes.size()); }

  /// Returns an array (worlds, count, width), or (worlds, count) if the width is 1, filled by
  /// put(batch, world, index, numbers).
  template <class Put>
  py::array_t<double> Read(const py::object& out, py::ssize_t count, py::ssize_t width, Put put) {
    std::vector<py::ssize_t> shape{worlds(), count};
    if (width > 1) shape.push_back(width);
    py::array_t<double> a = Output(out, shape);
    double* to = a.mutable_data();
    Look([&](WorldBatch& batch) {
      for (int w = 0; w < batch.worlds(); ++w) {
        for (int i = 0; i < static_cast<int>(count); ++i, to += width) put(batch, w, i, to);
      }
    });
    return a;
  }
};

/// Runs Python's signal handlers, at most ten times per second.
class Signals {
 public:
  /// Returns whether a handler raised (Ctrl-C), with its exception set. The GIL must not be held.
  bool Raised();

 private:
  static constexpr std::chrono::milliseconds kBetween{100};
  std::chrono::steady_clock::time_point next_ = std::chrono::steady_clock::now() + kBetween;
};

/// Steps the batch in pieces of a fraction of a second, bit-identically to `WorldBatch::Step`,
/// under `targets_m` (worlds, cables), or under the present targets if it is empty. Returns false
/// if a signal handler raised between two pieces: the worlds have then made fewer than `count`
/// steps. The GIL must not be held. `between`: called between two pieces, which are then at most
/// some milliseconds long.
bool StepUntilSignal(WorldBatch& batch, double step_s, int count, std::span<const double> targets_m,
                     Signals& signals, const std::function<void()>& between = {});

using BatchType = py::class_<Worlds, std::shared_ptr<Worlds>>;

/// `AddRows` adds the views of memory to the type, `AddSequences` the rollout of target sequences.
void AddRows(py::module_& module, BatchType& type);
void AddSequences(BatchType& type);

}  // namespace taut::python
