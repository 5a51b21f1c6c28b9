// `Batch.rollout`: sequences of rest-length targets in parallel worlds, for model predictive
// control.
#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "worlds.h"

namespace taut::python {
namespace {

void PutPositions(const WorldBatch& batch, double* to, py::ssize_t world_stride) {
  const int bodies = static_cast<int>(batch.model().def().bodies.size());
  for (int w = 0; w < batch.worlds(); ++w) {
    double* at = to + w * world_stride;
    for (int b = 0; b < bodies; ++b, at += 3) Put(batch.Body(w, b).position_m, at);
  }
}

Rows<double> Rollout(Worlds& worlds, const py::object& targets_m, double step_s, int count,
                     const std::optional<py::bytes>& start, const py::object& out) {
  StepLength(step_s);
  if (count < 1) throw py::value_error(fmt::format("count: {}; expected at least 1", count));
  const auto given = py::array::ensure(targets_m);
  PyErr_Clear();
  const py::ssize_t ticks = given && given.ndim() == 3 ? given.shape(1) : 1;
  const py::ssize_t cables = worlds.cables();
  const Array targets = Finite(targets_m, {worlds.worlds(), ticks, cables}, "rest_length_target_m");
  Rows<double> positions = Output(out, {worlds.worlds(), ticks, worlds.bodies(), 3});
  std::vector<std::uint8_t> snapshot;
  if (start) {
    const std::string_view text = *start;
    snapshot.assign(text.begin(), text.end());
  }
  const double* const from = targets.data();
  double* const to = positions.mutable_data();
  bool of_this_model = true, raised = false;
  worlds.With([&](WorldBatch& batch) {
    for (int w = 0; start && of_this_model && w < batch.worlds(); ++w) {
      of_this_model = batch.Restore(w, snapshot);
    }
    if (!of_this_model) return;
    Signals signals;
    std::vector<double> now(static_cast<std::size_t>(worlds.worlds() * cables));
    for (py::ssize_t t = 0; t < ticks; ++t) {
      if ((raised = signals.Raised())) return;
      for (int w = 0; w < batch.worlds(); ++w) {
        std::copy_n(from + (w * ticks + t) * cables, cables, now.begin() + w * cables);
      }
      if ((raised = !StepUntilSignal(batch, step_s, count, now, signals))) return;
      PutPositions(batch, to + t * 3 * worlds.bodies(), ticks * 3 * worlds.bodies());
    }
  });
  if (!of_this_model) throw py::value_error("start: not a snapshot of this model");
  if (raised) throw py::error_already_set();
  return positions;
}

}  // namespace

bool Signals::Raised() {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return false;
  next_ = now + kBetween;
  const Acquired mine;
  return SignalRaised();
}

bool StepUntilSignal(WorldBatch& batch, double step_s, int count, std::span<const double> targets_m,
                     Signals& signals, const std::function<void()>& between) {
  const std::chrono::milliseconds shortest{between ? 4 : 25}, longest{between ? 16 : 100};
  const int first = between ? 256 : 4096;  // steps of one world: a millisecond or some tens
  int piece = std::max(1, first / batch.worlds());
  while (count > 0) {
    const auto start = std::chrono::steady_clock::now();
    const int now = std::min(piece, count);
    if (targets_m.empty()) {
      batch.Step(step_s, now);
    } else {
      batch.Step(step_s, now, std::exchange(targets_m, {}));
    }
    count -= now;
    const auto took = std::chrono::steady_clock::now() - start;
    if (took < shortest && piece < (1 << 20)) piece *= 2;
    if (took > longest) piece = std::max(1, piece / 2);
    if (between) between();
    if (count > 0 && signals.Raised()) return false;
  }
  return true;
}

void AddSequences(BatchType& type) {
  type.def("rollout", &Rollout, py::arg("rest_length_target_m"), py::arg("step_s"),
           py::arg("count") = 1, py::arg("start") = py::none(), py::arg("out") = py::none(),
           "Steps each world through its sequence of rest-length targets, (worlds, ticks, cables) "
           "[m], each held for `count` steps of `step_s` [s]. `start`: result of `save` from which "
           "all worlds begin; None: their present states. Returns body_position_m after every "
           "tick, (worlds, ticks, bodies, 3) [m]; the batch stays in its last state. Other Python "
           "threads run meanwhile; Ctrl-C ends the call between two steps.");
}

}  // namespace taut::python
