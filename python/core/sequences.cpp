// Sequences of targets, worlds side by side: what a controller that looks ahead tries out.
#include <chrono>
#include <vector>

#include "worlds.h"

namespace taut::python {
namespace {

/// Asks Python for signals, though not more often than people press keys. The GIL must not be held.
class Signals {
 public:
  /// Whether one has raised.
  bool Raised() {
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) return false;
    next_ = now + std::chrono::milliseconds(100);
    const py::gil_scoped_acquire mine;
    return PyErr_CheckSignals() != 0;
  }

 private:
  std::chrono::steady_clock::time_point next_ =
      std::chrono::steady_clock::now() + std::chrono::milliseconds(100);
};

void PutPositions(const Batch& batch, double* to, py::ssize_t world_stride) {
  const int bodies = static_cast<int>(batch.model().def().bodies.size());
  for (int w = 0; w < batch.worlds(); ++w) {
    double* at = to + w * world_stride;
    for (int b = 0; b < bodies; ++b, at += 3) Put(batch.Body(w, b).position_m, at);
  }
}

Rows<double> Rollout(Worlds& worlds, const py::object& targets_m, double step_s, int count,
                     const std::optional<py::bytes>& start, const py::object& out) {
  Positive(step_s, "step_s");
  if (count < 1) throw py::value_error(fmt::format("count: {}; at least 1", count));
  const auto given = py::array::ensure(targets_m);
  PyErr_Clear();
  const py::ssize_t ticks = given && given.ndim() == 3 ? given.shape(1) : 1;
  const py::ssize_t cables = worlds.cables();
  const Array targets = Shaped(targets_m, {worlds.worlds(), ticks, cables}, "rest_length_target_m");
  Rows<double> positions = Output(out, {worlds.worlds(), ticks, worlds.bodies(), 3});
  std::vector<std::uint8_t> snapshot;
  if (start) {
    const std::string_view text = *start;
    snapshot.assign(text.begin(), text.end());
  }
  const double* const from = targets.data();
  double* const to = positions.mutable_data();
  bool of_this_model = true, raised = false;
  worlds.With([&](Batch& batch) {
    for (int w = 0; start && of_this_model && w < batch.worlds(); ++w) {
      of_this_model = batch.Restore(w, snapshot);
    }
    if (!of_this_model) return;
    Signals signals;
    std::vector<double> now(static_cast<std::size_t>(worlds.worlds() * cables));
    for (py::ssize_t t = 0; t < ticks && !(raised = signals.Raised()); ++t) {
      for (int w = 0; w < batch.worlds(); ++w) {
        std::copy_n(from + (w * ticks + t) * cables, cables, now.begin() + w * cables);
      }
      batch.Step(step_s, count, now);
      PutPositions(batch, to + t * 3 * worlds.bodies(), ticks * 3 * worlds.bodies());
    }
  });
  if (!of_this_model) throw py::value_error("start: not a snapshot of this model");
  if (raised) throw py::error_already_set();
  return positions;
}

}  // namespace

void AddSequences(BatchType& type) {
  type.def(
      "rollout", &Rollout, py::arg("rest_length_target_m"), py::arg("step_s"), py::arg("count") = 1,
      py::arg("start") = py::none(), py::arg("out") = py::none(),
      "Every world through a sequence of targets of its own, (worlds, ticks, cables) [m], each "
      "held for `count` steps of `step_s`. `start`: what `save` gave, where all worlds begin; "
      "None: where they are. Returns body_position_m after every tick, (worlds, ticks, bodies, "
      "3) [m]; afterwards the batch is at the end of it. Other Python threads go on meanwhile; "
      "Ctrl-C ends it between two ticks.");
}

}  // namespace taut::python
