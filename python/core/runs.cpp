// `taut.run`, `taut.read_trace` and `taut.Trace`: runs of experiments, with traces in memory.
#include "taut/run.h"

#include <pybind11/functional.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "python_control.h"
#include "taut/run_folder.h"
#include "taut/summary.h"
#include "taut/trace.h"
#include "text.h"

namespace taut::python {
namespace {

/// Trace writer that keeps every row in memory.
class InMemory : public TraceWriter {
 public:
  explicit InMemory(Trace& trace) : trace_(trace) { trace.values.resize(trace.channels.size()); }
  bool Append(double time_s, const double* values) override {
    trace_.time_s.push_back(time_s);
    for (auto& channel : trace_.values) channel.push_back(*values++);
    return true;
  }
  bool FlushOld() override { return true; }
  bool Finish() override { return true; }
  const std::string& error() const override { return none_; }

 private:
  Trace& trace_;
  const std::string none_;
};

using SharedTrace = std::shared_ptr<Trace>;

struct Ran {
  SharedTrace trace;
  RunSummary summary;
  ExperimentSpec experiment;  ///< Copy of the experiment that was run: the caller may change the
                              ///< original.
};

/// Recording that serves as a plant.
class Recorded {
 public:
  explicit Recorded(SharedTrace trace) : trace_(std::move(trace)) {}

  /// Returns a plant of the experiment's robot; raises InputError if the trace has none of the
  /// robot's cables. The recording and the experiment must outlive the plant.
  std::unique_ptr<Plant> PlantFor(const ExperimentSpec& experiment) const {
    Diagnostics said;
    auto plant = ReplayOf(*trace_, experiment.robot, said);
    if (!plant) Refuse(said);
    Tell(said);
    return plant;
  }

 private:
  SharedTrace trace_;
};

Ran Run(const ExperimentSpec& experiment, int threads, const py::object& progress,
        const py::object& controllers, const py::object& plant) {
  Threads(threads);
  CallableOrNone(progress, "progress");
  const auto callbacks = std::make_shared<Callbacks>();
  const Extensions extensions = ExtensionsOf(controllers, experiment.robot, callbacks);
  std::unique_ptr<Plant> own;
  if (py::isinstance<Recorded>(plant)) {
    own = plant.cast<Recorded&>().PlantFor(experiment);
  } else if (!plant.is_none()) {
    own = PythonPlant::Of(plant, experiment.robot, callbacks);
    callbacks->Rethrow();
  }
  Diagnostics said;
  Ran ran{std::make_shared<Trace>(), {}, experiment};
  std::optional<RunSummary> summary;
  bool stopped = false;  // by a Python exception, such as Ctrl-C
  WarnOfStep(experiment, said);
  if (CheckRecord(experiment, said)) {
    const Released others;
    ran.trace->channels = RunChannels(experiment, own.get());
    ran.trace->metadata = RunMetadata(experiment);
    InMemory writer(*ran.trace);
    RunOptions options;
    options.threads = threads;
    options.traces = {&writer};
    options.extensions = extensions;
    options.plant = own.get();
    options.progress = [&](const RunProgress& now) {
      if (callbacks->failed()) return false;
      const Acquired mine;
      if (SignalRaised()) return !(stopped = true);
      if (progress.is_none()) return true;
      try {
        CallPython(progress, now.time_s, now.duration_s);
      } catch (py::error_already_set& error) {
        error.restore();
        stopped = true;
      }
      return !stopped;
    };
    summary = RunExperiment(experiment, options, said);
  }
  if (stopped) throw py::error_already_set();
  callbacks->Rethrow();
  if (!summary) Refuse(said);
  Tell(said);
  ran.summary = std::move(*summary);
  return ran;
}

/// Writes the folder of a run, as `taut run` does.
void WriteRun(const Ran& ran, const std::string& path, Diagnostics& out) {
  const auto folder = RunFolder::Open(path, {}, out);
  if (!folder || !folder->Prepare(ResolvedYaml(ran.experiment), out)) return;
  const Trace& trace = *ran.trace;
  TraceMetadata metadata = trace.metadata;
  metadata.emplace_back(kRunIdKey, folder->id());
  auto file = CreateHdf5Trace(folder->Path("trace.h5"), trace.channels, metadata, out);
  if (!file) return;
  const auto writer = folder->BeginWith(std::move(file), {"trace.h5"});
  std::vector<double> row(trace.channels.size());
  bool good = true;
  for (std::size_t i = 0; i < trace.time_s.size() && good; ++i) {
    for (std::size_t c = 0; c < row.size(); ++c) row[c] = trace.values[c][i];
    good = writer->Append(trace.time_s[i], row.data());
  }
  if (!writer->Finish() || !good) return out.Error("trace.not_written", {}, writer->error());
  RunSummary summary = ran.summary;
  summary.run = folder->id();
  folder->Finish(SummaryJson(summary), out);
}

void SaveRun(const Ran& ran, const std::filesystem::path& path) {
  Diagnostics said;
  {
    const Released others;
    WriteRun(ran, path.string(), said);
  }
  if (!said.ok()) Refuse(said);
  Tell(said);
}

SharedTrace ReadRun(const std::string& path) {
  Diagnostics said;
  std::optional<Trace> trace;
  {
    const Released others;
    trace = ReadTrace(TraceOfRun(path), said);
  }
  if (!trace) Refuse(said);
  Tell(said);
  return std::make_shared<Trace>(std::move(*trace));
}

/// Returns a read-only view of a trace's numbers, which keeps the trace alive.
py::array View(const std::vector<double>& numbers, const py::object& owner) {
  py::array_t<double> a(static_cast<py::ssize_t>(numbers.size()), numbers.data(), owner);
  a.attr("setflags")(py::arg("write") = false);
  return a;
}

std::size_t ChannelOf(const Trace& trace, const std::string& name) {
  if (const auto found = trace.Find(name)) return *found;
  const std::vector<std::string> names = NamesOf(trace.channels);
  const std::string_view close = ClosestMatch(name, names);
  throw py::key_error("no channel \"" + name + "\"" +
                      (close.empty() ? "" : "; did you mean \"" + std::string(close) + "\"?"));
}

}  // namespace

void AddRuns(py::module_& module) {
  py::class_<Trace, SharedTrace>(
      module, "Trace",
      "Channels against time, recorded by a run: `trace[\"cable/a/tension_n\"]`. `to_pandas()` and "
      "`to_xarray()` convert to tables.")
      .def_property_readonly(
          "channels", [](const Trace& t) { return NamesOf(t.channels); },
          "Names of the channels, which end with quantity and unit.")
      .def_property_readonly(
          "units",
          [](const Trace& t) {
            py::dict units;
            for (const ChannelInfo& c : t.channels) units[py::str(c.name)] = c.unit;
            return units;
          },
          "Dict of the units by channel: \"N\", \"m\", ...")
      .def_property_readonly(
          "metadata",
          [](const Trace& t) {
            py::dict all;
            for (const auto& [key, value] : t.metadata) all[py::str(key)] = value;
            return all;
          },
          "Dict of the origin of the trace: version, step, seed, hash of the inputs ...")
      .def_property_readonly(
          "time_s", [](const py::object& self) { return View(self.cast<Trace&>().time_s, self); },
          "(rows,) float64: times [s]. A read-only view.")
      .def_readonly("unfinished", &Trace::unfinished)
      .def("__getitem__",
           [](const py::object& self, const std::string& name) {
             const Trace& t = self.cast<Trace&>();
             return View(t.values[ChannelOf(t, name)], self);
           })
      .def("__contains__",
           [](const Trace& t, const std::string& name) { return t.Find(name).has_value(); })
      .def("__len__", [](const Trace& t) { return t.time_s.size(); });

  py::class_<Recorded>(module, "Replay",
                       "Plant that replays a recording: `taut.run(experiment, plant=taut.Replay("
                       "trace))` computes the commands that the experiment's controllers would "
                       "have issued.")
      .def(py::init<SharedTrace>(), py::arg("trace"));

  py::class_<Ran>(module, "Run", "Result of `taut.run`.")
      .def_readonly("trace", &Ran::trace)
      .def_property_readonly(
          "state_hash", [](const Ran& r) { return r.summary.state_hash; },
          "Hash of the world's state at the end, as printed by `taut run`.")
      .def_property_readonly("simulated_s", [](const Ran& r) { return r.summary.simulated_s; })
      .def_property_readonly(
          "status", [](const Ran& r) { return r.summary.status_text; },
          "Errors of the run; empty for a good run.")
      .def_property_readonly(
          "overloads",
          [](const Ran& r) {
            py::list all;
            for (const Overload& one : r.summary.overloads) {
              py::dict entry;
              entry["kind"] = NameOf(one.kind);
              entry["name"] = one.name;
              entry["limit"] = NameOf(one.limit);
              entry["bears_n"] = one.bears_n;
              entry["carried_n"] = one.carried_n;
              entry["first_time_s"] = one.first_time_s;
              all.append(entry);
            }
            return all;
          },
          "Members whose load exceeded a limit, as in summary.json.")
      .def_property_readonly(
          "max_tension_n",
          [](const Ran& r) {
            py::dict all;
            for (const CableSummary& c : r.summary.cables) all[py::str(c.name)] = c.tension.max_n;
            return all;
          },
          "Dict of the largest tension by cable, over all steps, not only recorded rows [N].")
      .def("save", &SaveRun, py::arg("folder"),
           "Writes the folder of the run, as `taut run --out` does: trace.h5, inputs.yaml, "
           "summary.json. `taut view`, `report` and `compare` accept it. Replaces an earlier run "
           "in the folder. Raises `taut.InputError` if a file cannot be written.");

  module.def(
      "run", &Run, py::arg("experiment"), py::arg("threads") = 1, py::arg("progress") = py::none(),
      py::arg("controllers") = py::none(), py::arg("plant") = py::none(),
      "Runs an experiment from start to end, bit-identically to `taut run`. `threads`: number of "
      "threads. `progress(time_s, duration_s)` is called a few times per second. `controllers`: "
      "list "
      "of additional controllers, as for `taut.Simulation`. `plant`: object with `observe()` and "
      "`advance(step_s, time_s, commands)`, or a `taut.Replay`, on which the controllers act "
      "instead of a simulation. Returns a "
      "`taut.Run`. Ctrl-C ends the call. Raises `taut.InputError` if the experiment cannot start.");
  module.def("read_trace", &ReadRun, py::arg("path"),
             "Reads a recorded trace: .h5, .csv or .csv.gz, or the folder of a run. Returns a "
             "`taut.Trace`.");
}

}  // namespace taut::python
