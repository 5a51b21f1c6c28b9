// Readings and commands of `taut.Simulation`.
#include "readings.h"
#include "shared_simulation.h"

namespace taut::python {
namespace {

using S = SharedSimulation;

/// Returns the docstring of a method that reads all elements of a `kind`, or one element. `width`:
/// further text of the array's shape, such as ", 3".
std::string Words(const char* what, const std::string& kind, const std::string& width) {
  return fmt::format(
      "Returns {0}: float64, shape (worlds, {1}{2}); for one `{4}`, by name or index, shape "
      "(worlds{3}).",
      what, kind == "body" ? "bodies" : kind + "s", width, width.empty() ? "," : width, kind);
}

}  // namespace

void AddReadings(SimulationType& type) {
  for (const CableReading& reading : kCableReadings) {
    type.def(
        reading.name,
        [field = reading.field](S& shared, const py::object& cable) {
          return shared.Read(
              shared.OneOf(&S::Cable, cable), shared.cables(), 1,
              [=](Simulation& s, int w, int i, double* to) { *to = s.Cable(i, w).*field; });
        },
        py::arg("cable") = py::none(), Words(reading.words, "cable", "").c_str());
  }
  type.def(
      "rest_length_command_m",
      [](S& shared, const py::object& cable) {
        return shared.Read(
            shared.OneOf(&S::Cable, cable), shared.cables(), 1,
            [](Simulation& s, int w, int i, double* to) { *to = s.RestLengthCommand(i, w); });
      },
      py::arg("cable") = py::none(),
      Words("rest lengths commanded by the controllers [m]", "cable", "").c_str());
  for (const BodyReading& reading : kBodyReadings) {
    type.def(
        reading.name,
        [put = reading.put, width = reading.width](S& shared, const py::object& body) {
          return shared.Read(
              shared.OneOf(&S::Body, body), shared.bodies(), width,
              [=](Simulation& s, int w, int i, double* to) { put(s.Body(i, w), to); });
        },
        py::arg("body") = py::none(),
        Words(reading.words, "body", fmt::format(", {}", reading.width)).c_str());
  }
  const auto nodes = [&](const char* name, Vec3 (Simulation::*read)(const ElementRef&, int) const,
                         const char* words) {
    type.def(
        name,
        [=](S& shared, const py::object& node) {
          return shared.Read(
              shared.OneOf(&S::Node, node), shared.nodes(), 3,
              [=](Simulation& s, int w, int i, double* to) { Put((s.*read)(i, w), to); });
        },
        py::arg("node") = py::none(), Words(words, "node", ", 3").c_str());
  };
  nodes("node_position_m", &Simulation::NodePosition, "positions of the nodes, in W [m]");
  nodes("node_velocity_m_per_s", &Simulation::NodeVelocity, "velocities of the nodes, in W [m/s]");
  type.def(
      "joint",
      [](S& shared, const py::object& joint, py::ssize_t world) {
        const int j = shared.Joint(joint), w = shared.World(world);
        const JointState state = shared.Look([&](Simulation& s) { return s.Joint(j, w); });
        py::dict all;
        all["coordinate"] = state.coordinate;
        all["rate"] = state.rate;
        all["force_n"] = ArrayOf(std::vector{state.force_n.x, state.force_n.y, state.force_n.z});
        all["torque_n_m"] =
            ArrayOf(std::vector{state.torque_n_m.x, state.torque_n_m.y, state.torque_n_m.z});
        all["gap_m"] = state.gap_m;
        return all;
      },
      py::arg("joint"), py::arg("world") = 0,
      "Returns the state of a joint as a dict: coordinate [rad] or [m], rate, force_n and "
      "torque_n_m on the second body at its point, in W, and gap_m.");
  type.def(
      "contacts",
      [](S& shared, py::ssize_t world) {
        const int w = shared.World(world);
        return ContactsOf(shared.Look([&](Simulation& s) { return s.Contacts(w); }));
      },
      py::arg("world") = 0, "Returns the contacts of the last step, as `Batch.contacts` does.");
  type.def(
      "time_s",
      [](S& shared) {
        return shared.Read(0, 1, 1, [](Simulation& s, int w, int, double* to) { *to = s.Time(w); });
      },
      "(worlds,) float64: time since the start of each world [s].");
  type.def(
      "is_running",
      [](S& shared) {
        py::array_t<bool> a(shared.worlds());
        bool* to = a.mutable_data();
        shared.Look([&](Simulation& s) {
          for (int w = 0; w < s.worlds(); ++w) to[w] = s.IsRunning(w);
        });
        return a;
      },
      "(worlds,) bool: False for worlds whose state is not finite; they are frozen.");
  type.def(
      "status",
      [](S& shared, py::ssize_t world) {
        const int w = shared.World(world);
        return shared.Look([&](Simulation& s) { return s.StatusText(w); });
      },
      py::arg("world") = 0,
      "Returns a description of a world's problems (status bits); empty if there are none.");
  type.def(
      "hash",
      [](S& shared, py::ssize_t world) {
        const int w = shared.World(world);
        return shared.Look([&](Simulation& s) { return s.Hash(w); });
      },
      py::arg("world") = 0,
      "Returns a hash of a world's state, equal to `Run.state_hash` for equal states.");
}

void AddCommands(SimulationType& type) {
  type.def(
      "set_rest_length",
      [](S& shared, const py::object& cable, double rest_length_m,
         std::optional<py::ssize_t> world) {
        const int c = shared.Cable(cable);
        Positive(rest_length_m, "rest_length_m");
        const auto [first, last] = shared.Range(world);
        shared.With([&, from = first, to = last](Simulation& s) {
          for (int w = from; w < to; ++w) s.SetRestLength(c, rest_length_m, w);
        });
      },
      py::arg("cable"), py::arg("rest_length_m"), py::arg("world") = py::none(),
      "Commands a cable's rest length [m], in one `world` or in all. A position controller of the "
      "cable holds this rest length instead of following its program; other controllers of the "
      "cable overwrite the command at their next tick.");
  type.def(
      "set_node_force",
      [](S& shared, const py::object& node, const py::object& force_n,
         std::optional<py::ssize_t> world) {
        const int n = shared.Node(node);
        const Array f = Finite(force_n, {3}, "force_n");
        const Vec3 force{f.at(0), f.at(1), f.at(2)};
        const auto [first, last] = shared.Range(world);
        shared.With([&, from = first, to = last](Simulation& s) {
          for (int w = from; w < to; ++w) s.SetNodeForce(n, force, w);
        });
      },
      py::arg("node"), py::arg("force_n"), py::arg("world") = py::none(),
      "Sets an external force on a node, in W [N], in addition to the experiment's pushes; it acts "
      "until it is changed or the world is reset.");
  type.def(
      "gains",
      [](S& shared, const py::object& cable, py::ssize_t world) -> py::object {
        const int c = shared.Cable(cable), w = shared.World(world);
        const auto gains = shared.Look([&](Simulation& s) { return s.Gains(c, w); });
        if (!gains) return py::none();
        py::dict all;
        all["tension_offset_n"] = gains->tension_offset_n;
        all["length_offset_m"] = gains->length_offset_m;
        all["position_gain_n_per_m"] = gains->position_gain_n_per_m;
        all["velocity_gain_n_s_per_m"] = gains->velocity_gain_n_s_per_m;
        all["velocity_offset_m_per_s"] = gains->velocity_offset_m_per_s;
        return all;
      },
      py::arg("cable"), py::arg("world") = 0,
      "Returns the gains of a cable under impedance control as a dict; None for other cables.");
  type.def(
      "set_gains",
      [](S& shared, const py::object& cable, std::optional<py::ssize_t> world,
         const py::kwargs& given) {
        const int c = shared.Cable(cable);
        const auto [first, last] = shared.Range(world);
        const std::pair<const char*, double ImpedanceGains::*> fields[] = {
            {"tension_offset_n", &ImpedanceGains::tension_offset_n},
            {"length_offset_m", &ImpedanceGains::length_offset_m},
            {"position_gain_n_per_m", &ImpedanceGains::position_gain_n_per_m},
            {"velocity_gain_n_s_per_m", &ImpedanceGains::velocity_gain_n_s_per_m},
            {"velocity_offset_m_per_s", &ImpedanceGains::velocity_offset_m_per_s}};
        std::vector<std::pair<double ImpedanceGains::*, double>> changes;
        for (const auto& [key, value] : given) {
          const std::string name = py::str(key);
          bool known = false;
          for (const auto& [field, at] : fields) {
            if (name != field) continue;
            known = true;
            const double number = Number(value, name);
            const bool offset = at == &ImpedanceGains::velocity_offset_m_per_s;
            if (!std::isfinite(number) || (number < 0 && !offset)) {
              throw py::value_error(
                  fmt::format("{}: {}; expected a number{}", name, number, offset ? "" : " >= 0"));
            }
            changes.emplace_back(at, number);
          }
          if (!known)
            throw py::type_error("set_gains: there is no gain \"" + name +
                                 "\"; expected keywords as in gains()");
        }
        if (changes.empty())
          throw py::type_error("set_gains: no gain is given; expected keywords as in gains()");
        const bool good = shared.With([&, from = first, to = last](Simulation& s) {
          for (int w = from; w < to; ++w) {
            auto gains = s.Gains(c, w);
            if (!gains) return false;
            for (const auto& [at, number] : changes) (*gains).*at = number;
            s.SetGains(*gains, w);
          }
          return true;
        });
        if (!good)
          throw py::value_error("cable \"" + shared.def().cables[static_cast<std::size_t>(c)].name +
                                "\" is not under impedance control");
      },
      py::arg("cable"), py::arg("world") = py::none(),
      "Sets gains of a cable under impedance control by keyword, as `gains` names them, in one "
      "`world` or in all.");
}

}  // namespace taut::python
