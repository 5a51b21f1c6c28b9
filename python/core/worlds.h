/// C++ part of `taut.Batch`, for the files that add its methods.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "owner.h"
#include "taut/world_batch.h"
#include "text.h"

namespace taut::python {

/// Raises ValueError for a number of worlds that would overflow integers.
inline void CheckWorlds(int worlds) {
  constexpr int kMost = 1'000'000'000;
  if (worlds >= 1 && worlds <= kMost) return;
  throw py::value_error(fmt::format("worlds: {}; expected 1 to {}", worlds, kMost));
}

/// Object T with worlds, which Python threads share; one thread at a time has access (`Owner`).
template <class T>
class OwnedWorlds {
 public:
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
/// steps. The GIL must not be held.
bool StepUntilSignal(WorldBatch& batch, double step_s, int count, std::span<const double> targets_m,
                     Signals& signals);

using BatchType = py::class_<Worlds, std::shared_ptr<Worlds>>;

/// `AddRows` adds the views of memory to the type, `AddSequences` the rollout of target sequences.
void AddRows(py::module_& module, BatchType& type);
void AddSequences(BatchType& type);

}  // namespace taut::python
