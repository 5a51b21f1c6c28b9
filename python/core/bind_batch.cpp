// `taut.Batch`: many worlds of one model. Long calls release the GIL; a lock per batch serializes
// calls from several Python threads.
#include "taut/world_batch.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "readings.h"
#include "worlds.h"

namespace taut::python {
namespace {

const std::pair<const char*, Parameter> kParameters[] = {
    {"body_mass_kg", Parameter::kBodyMass},
    {"cable_stiffness_n_per_m", Parameter::kCableStiffness},
    {"cable_damping_n_s_per_m", Parameter::kCableDamping},
    {"friction_scale", Parameter::kFrictionScale},
    {"gravity_x_m_per_s2", Parameter::kGravityX},
    {"gravity_y_m_per_s2", Parameter::kGravityY},
    {"gravity_z_m_per_s2", Parameter::kGravityZ}};

/// Returns the parameter with this name and its index; raises ValueError or IndexError.
std::pair<Parameter, int> ParameterOf(const Worlds& worlds, const std::string& name,
                                      py::ssize_t index) {
  std::string all;
  for (const auto& [known, parameter] : kParameters) {
    all += std::string(" ") + known;
    if (name != known) continue;
    const bool of_cables =
        parameter == Parameter::kCableStiffness || parameter == Parameter::kCableDamping;
    const py::ssize_t count = parameter == Parameter::kBodyMass ? worlds.bodies()
                              : of_cables                       ? worlds.cables()
                                                                : 1;
    return {parameter, Index(index, static_cast<int>(count), "index")};
  }
  throw py::value_error("unknown parameter \"" + name + "\"; expected one of" + all);
}

void Step(Worlds& worlds, double step_s, int count, const py::object& targets) {
  StepLength(step_s);
  if (count < 0) throw py::value_error(fmt::format("count: {}; expected 0 or more", count));
  std::span<const double> rows;
  Array a;
  if (!targets.is_none()) {
    a = Finite(targets, {worlds.worlds(), worlds.cables()}, "rest_length_target_m");
    rows = {a.data(), static_cast<std::size_t>(a.size())};
  }
  const bool done = worlds.With([&](WorldBatch& batch) {
    Signals signals;
    if (count == 0 && !rows.empty()) batch.Step(step_s, 0, rows);
    std::function<void()> between;
    if (worlds.is_viewed()) between = [&] { worlds.ShowIfRequested(batch); };
    return StepUntilSignal(batch, step_s, count, rows, signals, between);
  });
  if (!done) throw py::error_already_set();
}

void AddStates(BatchType& type) {
  for (const BodyReading& reading : kBodyReadings) {
    type.def(
        reading.name,
        [put = reading.put, width = reading.width](Worlds& worlds, const py::object& out) {
          return worlds.Read(
              out, worlds.bodies(), width,
              [=](WorldBatch& b, int w, int i, double* to) { put(b.Body(w, i), to); });
        },
        py::arg("out") = py::none(),
        fmt::format("(worlds, bodies, {}) float64: {}. `out`: existing array for the result.",
                    reading.width, reading.words)
            .c_str());
  }
  for (const CableReading& reading : kCableReadings) {
    type.def(
        reading.name,
        [field = reading.field](Worlds& worlds, const py::object& out) {
          return worlds.Read(out, worlds.cables(), 1, [=](WorldBatch& b, int w, int i, double* to) {
            *to = b.Cable(w, i).*field;
          });
        },
        py::arg("out") = py::none(),
        fmt::format("(worlds, cables) float64: {}. `out`: existing array for the result.",
                    reading.words)
            .c_str());
  }
  type.def(
      "rest_length_target_m",
      [](Worlds& worlds, const py::object& out) {
        return worlds.Read(out, worlds.cables(), 1, [](WorldBatch& b, int w, int i, double* to) {
          *to = b.RestLengthTarget(w, i);
        });
      },
      py::arg("out") = py::none(),
      "(worlds, cables) float64: rest-length targets of the actuators [m].");
  const auto nodes = [&](const char* name, Vec3 (WorldBatch::*read)(int, int) const,
                         const char* words) {
    type.def(
        name,
        [=](Worlds& worlds, const py::object& out) {
          return worlds.Read(out, worlds.nodes(), 3, [=](WorldBatch& b, int w, int i, double* to) {
            Put((b.*read)(w, i), to);
          });
        },
        py::arg("out") = py::none(), words);
  };
  nodes("node_position_m", &WorldBatch::NodePosition,
        "(worlds, nodes, 3) float64: positions of the nodes, in W [m].");
  nodes("node_velocity_m_per_s", &WorldBatch::NodeVelocity,
        "(worlds, nodes, 3) float64: velocities of the nodes, in W [m/s].");
  type.def(
      "time_s",
      [](Worlds& worlds) {
        py::array_t<double> a(worlds.worlds());
        double* to = a.mutable_data();
        worlds.Look([&](WorldBatch& b) {
          for (int w = 0; w < b.worlds(); ++w) to[w] = b.Time(w);
        });
        return a;
      },
      "(worlds,) float64: simulated time [s].");
}

void AddCommands(BatchType& type) {
  type.def(
      "set_rest_length_target",
      [](Worlds& worlds, const py::object& rest_length_m, std::optional<py::ssize_t> world) {
        std::vector<py::ssize_t> shape{worlds.cables()};
        if (!world) shape.insert(shape.begin(), worlds.worlds());
        const Array a = Finite(rest_length_m, shape, "rest_length_m");
        const auto [first, last] = worlds.Range(world);
        const double* from = a.data();
        worlds.With([&, from_world = first, to_world = last](WorldBatch& b) {
          for (int w = from_world; w < to_world; ++w) {
            for (int c = 0; c < static_cast<int>(worlds.cables()); ++c) {
              b.SetRestLengthTarget(w, c, *from++);
            }
          }
        });
      },
      py::arg("rest_length_m"), py::arg("world") = py::none(),
      "Sets the rest-length targets of the actuators [m]: an array (worlds, cables), or (cables,) "
      "for one `world`. Targets hold until they are changed.");
  type.def(
      "set_node_force",
      [](Worlds& worlds, py::ssize_t world, py::ssize_t node, const py::object& force_n) {
        const int w = worlds.World(world),
                  n = Index(node, static_cast<int>(worlds.nodes()), "node");
        const Array f = Finite(force_n, {3}, "force_n");
        const Vec3 force{f.at(0), f.at(1), f.at(2)};
        worlds.With([&](WorldBatch& b) { b.SetNodeForce(w, n, force); });
      },
      py::arg("world"), py::arg("node"), py::arg("force_n"),
      "Sets an external force on a node: (3,), in W [N]. The force acts until it is changed.");
  type.def(
      "set_parameter",
      [](Worlds& worlds, const std::string& name, const py::object& values, py::ssize_t index) {
        const auto [parameter, i] = ParameterOf(worlds, name, index);
        const Array a = Shaped(values, {worlds.worlds()}, "values");
        const double* from = a.data();
        const std::string wrong = worlds.With([&, p = parameter, at = i](WorldBatch& b) {
          std::string first;
          for (int w = 0; w < b.worlds() && first.empty(); ++w) {
            first = b.ParameterError(p, at, from[w]);
            if (!first.empty()) first = fmt::format("values[{}]: {} {}", w, name, first);
          }
          for (int w = 0; w < b.worlds() && first.empty(); ++w) b.SetParameter(w, p, at, from[w]);
          return first;
        });
        if (!wrong.empty()) throw py::value_error(wrong);
      },
      py::arg("name"), py::arg("values"), py::arg("index") = 0,
      "Sets a model parameter to `values`, (worlds,), one per world. Names: body_mass_kg (`index`: "
      "body; its inertia scales with the mass), cable_stiffness_n_per_m, cable_damping_n_s_per_m "
      "(`index`: cable), friction_scale, gravity_x_m_per_s2, gravity_y_m_per_s2, "
      "gravity_z_m_per_s2.");
  type.def(
      "parameter",
      [](Worlds& worlds, const std::string& name, py::ssize_t index) {
        const auto [parameter, i] = ParameterOf(worlds, name, index);
        py::array_t<double> a(worlds.worlds());
        double* to = a.mutable_data();
        worlds.Look([&, p = parameter, at = i](WorldBatch& b) {
          for (int w = 0; w < b.worlds(); ++w) to[w] = b.GetParameter(w, p, at);
        });
        return a;
      },
      py::arg("name"), py::arg("index") = 0,
      "Returns a model parameter of `set_parameter`: (worlds,) float64.");
  type.def("step", &Step, py::arg("step_s"), py::arg("count") = 1,
           py::arg("rest_length_target_m") = py::none(),
           "Advances every world by `count` steps of `step_s` [s]. `rest_length_target_m`: "
           "optional new rest-length targets, (worlds, cables) [m]. Other Python threads run "
           "meanwhile. Ctrl-C ends the call between two steps.");
}

void AddSnapshots(BatchType& type) {
  type.def(
      "save",
      [](Worlds& worlds, py::ssize_t world) {
        const int w = worlds.World(world);
        return BytesFrom(worlds.Look([&](WorldBatch& b) { return b.Save(w); }));
      },
      py::arg("world") = 0, "Returns the complete state of a world as bytes.");
  type.def(
      "restore",
      [](Worlds& worlds, const py::bytes& snapshot, std::optional<py::ssize_t> world) {
        const auto [first, last] = worlds.Range(world);
        const auto view = BytesOf(snapshot);
        const std::vector<std::uint8_t> bytes(view.begin(), view.end());
        const bool all = worlds.With([&, from = first, to = last](WorldBatch& b) {
          for (int w = from; w < to; ++w) {
            if (!b.Restore(w, bytes)) return false;
          }
          return true;
        });
        if (!all) throw py::value_error("snapshot: not a snapshot of this model");
      },
      py::arg("snapshot"), py::arg("world") = 0,
      "Restores a world, bit-identically, from the result of `save`; `world` None: all worlds. "
      "Raises ValueError for a state of another model.");
  type.def(
      "hash",
      [](Worlds& worlds, py::ssize_t world) {
        const int w = worlds.World(world);
        return worlds.Look([&](WorldBatch& b) { return b.Hash(w); });
      },
      py::arg("world") = 0, "Returns a hash of a world's state; equal for bit-identical states.");
  type.def(
      "status",
      [](Worlds& worlds) {
        py::array_t<std::uint32_t> a(worlds.worlds());
        std::uint32_t* to = a.mutable_data();
        worlds.Look([&](WorldBatch& b) {
          for (int w = 0; w < b.worlds(); ++w) to[w] = b.Status(w).bits;
        });
        return a;
      },
      "(worlds,) uint32: condition bits of each world, see `taut.Status`; 0: no error.");
  type.def(
      "contacts",
      [](Worlds& worlds, py::ssize_t world) {
        const int w = worlds.World(world);
        const auto touching = worlds.Look([&](WorldBatch& b) { return b.Contacts(w); });
        return ContactsOf(touching);
      },
      py::arg("world") = 0,
      "Returns the contacts of the last step as a dict of arrays with one row per point: bodies "
      "(n, 2), -1: the world; point_m, normal (from the second body to the first), force_n on the "
      "first body (n, 3), all in W; gap_m (n,).");
}

}  // namespace

void AddBatch(py::module_& module) {
  BatchType type(module, "Batch",
                 "Many worlds of one model, stepped together; they start in the described pose. "
                 "Arrays are copies, unless `out=` names an existing array for the result. Results "
                 "are bit-identical for any number of threads and lanes. Several Python threads "
                 "may use one batch; calls wait for each other.");
  type.def(py::init([](const RobotSpec& robot, int worlds, int threads,
                       const std::optional<std::string>& simd) {
             return std::make_shared<Worlds>(robot.def, worlds, threads, simd);
           }),
           py::arg("robot"), py::arg("worlds") = 1, py::arg("threads") = 1,
           py::arg("simd") = py::none(),
           "Creates `worlds` worlds of a `Robot`. `threads`: number of threads; 0: one per core. "
           "`simd`: \"scalar\", \"sse2\", \"neon\", \"avx2\" or \"avx512\"; None: the widest on "
           "this machine, or scalar for one world.");
  type.def(py::init([](const ExperimentSpec& experiment, int worlds, int threads,
                       const std::optional<std::string>& simd) {
             return std::make_shared<Worlds>(experiment.robot.def, worlds, threads, simd);
           }),
           py::arg("experiment"), py::arg("worlds") = 1, py::arg("threads") = 1,
           py::arg("simd") = py::none(),
           "Creates worlds of an `Experiment`'s robot on its ground, without its controllers and "
           "timeline.");
  type.def_property_readonly("worlds", [](const Worlds& of) { return of.worlds(); });
  type.def_property_readonly("lanes", &Worlds::lanes, "Number of worlds per SIMD register.");
  AddStates(type);
  AddCommands(type);
  AddSnapshots(type);
  AddSequences(type);
  AddRows(module, type);
  py::dict status;
  status["NOT_FINITE"] = static_cast<int>(kStatusNonFinite);
  status["NOT_CONVERGED"] = static_cast<int>(kStatusNotConverged);
  status["CONTACT_OVERFLOW"] = static_cast<int>(kStatusContactOverflow);
  status["STEP_TOO_LONG"] = static_cast<int>(kStatusStepTooLong);
  status["FELL_OFF"] = static_cast<int>(kStatusFellOff);
  status["OVERLOADED"] = static_cast<int>(kStatusOverloaded);
  module.attr("status_bits") = status;
}

}  // namespace taut::python
