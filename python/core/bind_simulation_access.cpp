// Readings and commands of `taut.Simulation`.
#include "shared_simulation.h"

namespace taut::python {
namespace {

using S = SharedSimulation;

}  // namespace

void AddReadings(SimulationType& type) {
  const auto cables = [&](const char* name, double CableState::*field, const char* words) {
    type.def(
        name,
        [=](S& shared, const py::object& cable) {
          std::optional<int> one;
          if (!cable.is_none()) one = shared.Cable(cable);
          return shared.Read(
              one, static_cast<py::ssize_t>(shared.def().cables.size()), 1,
              [=](Simulation& s, int w, int i, double* to) { *to = s.Cable(i, w).*field; });
        },
        py::arg("cable") = py::none(), words);
  };
  cables("cable_length_m", &CableState::length_m,
         "(worlds, cables) float64: path lengths between the ends of each cable [m]. With `cable`, "
         "a name or an index: (worlds,).");
  cables("cable_rate_m_per_s", &CableState::rate_m_per_s,
         "(worlds, cables) or (worlds,) float64: rates of the cable lengths [m/s].");
  cables("rest_length_m", &CableState::rest_length_m,
         "(worlds, cables) or (worlds,) float64: rest lengths [m].");
  cables("tension_n", &CableState::tension_n,
         "(worlds, cables) or (worlds,) float64: tensions as measured by a load cell, spring and "
         "damper [N].");
  cables("elastic_n", &CableState::elastic_n,
         "(worlds, cables) or (worlds,) float64: spring part of the tensions, max(0, k (l - L)) "
         "[N].");
  type.def(
      "rest_length_command_m",
      [](S& shared, const py::object& cable) {
        std::optional<int> one;
        if (!cable.is_none()) one = shared.Cable(cable);
        return shared.Read(
            one, static_cast<py::ssize_t>(shared.def().cables.size()), 1,
            [](Simulation& s, int w, int i, double* to) { *to = s.RestLengthCommand(i, w); });
      },
      py::arg("cable") = py::none(),
      "(worlds, cables) or (worlds,) float64: rest lengths commanded by the controllers [m].");

  const auto bodies = [&](const char* name, py::ssize_t width, auto put, const char* words) {
    type.def(
        name,
        [=](S& shared, const py::object& body) {
          std::optional<int> one;
          if (!body.is_none()) one = shared.Body(body);
          return shared.Read(
              one, static_cast<py::ssize_t>(shared.def().bodies.size()), width,
              [=](Simulation& s, int w, int i, double* to) { put(s.Body(i, w), to); });
        },
        py::arg("body") = py::none(), words);
  };
  bodies(
      "body_position_m", 3, [](const BodyState& s, double* to) { Put(s.position_m, to); },
      "(worlds, bodies, 3) float64: positions of the centers of mass, in W [m]. With `body`, a "
      "name or an index: (worlds, 3).");
  bodies(
      "body_orientation", 4,
      [](const BodyState& s, double* to) {
        const Quat& q = s.orientation;
        to[0] = q.w, to[1] = q.x, to[2] = q.y, to[3] = q.z;
      },
      "(worlds, bodies, 4) or (worlds, 4) float64: rotations from the initial orientations, as "
      "unit quaternions w, x, y, z, in W.");
  bodies(
      "body_velocity_m_per_s", 3,
      [](const BodyState& s, double* to) { Put(s.velocity_m_per_s, to); },
      "(worlds, bodies, 3) or (worlds, 3) float64: velocities of the centers of mass, in W [m/s].");
  bodies(
      "body_angular_velocity_rad_per_s", 3,
      [](const BodyState& s, double* to) { Put(s.angular_velocity_rad_per_s, to); },
      "(worlds, bodies, 3) or (worlds, 3) float64: angular velocities, in W [rad/s].");
  const auto nodes = [&](const char* name, Vec3 (Simulation::*read)(const ElementRef&, int) const,
                         const char* words) {
    type.def(
        name,
        [=](S& shared, const py::object& node) {
          std::optional<int> one;
          if (!node.is_none()) one = shared.Node(node);
          return shared.Read(
              one, static_cast<py::ssize_t>(shared.def().nodes.size()), 3,
              [=](Simulation& s, int w, int i, double* to) { Put((s.*read)(i, w), to); });
        },
        py::arg("node") = py::none(), words);
  };
  nodes("node_position_m", &Simulation::NodePosition,
        "(worlds, nodes, 3) float64: positions of the nodes, in W [m]. With `node`, a name or an "
        "index: (worlds, 3).");
  nodes("node_velocity_m_per_s", &Simulation::NodeVelocity,
        "(worlds, nodes, 3) or (worlds, 3) float64: velocities of the nodes, in W [m/s].");
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
      "(worlds,) bool: False once a state is not finite.");
  type.def(
      "status",
      [](S& shared, py::ssize_t world) {
        const int w = shared.World(world);
        return shared.Look([&](Simulation& s) { return s.StatusText(w); });
      },
      py::arg("world") = 0, "Returns the problems of a world in words; empty if there are none.");
  type.def(
      "hash",
      [](S& shared, py::ssize_t world) {
        const int w = shared.World(world);
        return shared.Look([&](Simulation& s) { return s.Hash(w); });
      },
      py::arg("world") = 0,
      "Returns a hash of a world's state; that of `Run.state_hash` for equal states.");
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
      "Commands a cable's rest length [m], in one `world` or in all. Position controllers keep it "
      "instead of their program; other controllers overwrite it at their next tick.");
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
      "until it is changed.");
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
      "Returns the gains of a cable under impedance control as a dict; None without.");
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
            if (PyNumber_Check(value.ptr()) == 0) {
              throw py::type_error(name + ": " + py::repr(value).cast<std::string>() +
                                   "; expected a number");
            }
            const double number = value.cast<double>();
            const bool offset = at == &ImpedanceGains::velocity_offset_m_per_s;
            if (!std::isfinite(number) || (number < 0 && !offset)) {
              throw py::value_error(
                  fmt::format("{}: {}; expected a number{}", name, number, offset ? "" : " >= 0"));
            }
            changes.emplace_back(at, number);
          }
          if (!known) throw py::type_error("set_gains: there is no gain \"" + name + "\"");
        }
        if (changes.empty()) throw py::type_error("set_gains: no gain given");
        const bool good = shared.With([&, from = first, to = last](Simulation& s) {
          for (int w = from; w < to; ++w) {
            auto gains = s.Gains(c, w);
            if (!gains) return false;
            for (const auto& [at, number] : changes) (*gains).*at = number;
            s.SetGains(*gains, w);
          }
          return true;
        });
        if (!good) throw py::value_error("the cable is not under impedance control");
      },
      py::arg("cable"), py::arg("world") = py::none(),
      "Sets gains of a cable under impedance control by keyword, as `gains` names them, in one "
      "`world` or in all.");
}

}  // namespace taut::python
