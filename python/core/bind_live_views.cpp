// `sim.show()` and `batch.show()`: opening and closing of live views.
#include <cmath>
#include <limits>

#include "live_view.h"
#include "shared_simulation.h"

namespace taut::python {

LiveView::State StateOf(WorldBatch& batch, int world) {
  return {MomentOf(batch, world), batch.Time(world)};
}

LiveView::State StateOf(Simulation& simulation, int world) {
  const int group = world / simulation.lanes(), lane = world % simulation.lanes();
  LiveView::State state{MomentOf(simulation.batch(group), lane), simulation.Time(world)};
  RobotMoment& moment = state.moment;
  for (Vec3& force_n : moment.node_force_n) force_n = {};
  for (const ExternalForce& force : simulation.ExternalForces(world)) {
    Vec3& sum_n = moment.node_force_n[static_cast<std::size_t>(force.node)];
    sum_n = {sum_n.x + force.force_n.x, sum_n.y + force.force_n.y, sum_n.z + force.force_n.z};
  }
  const Commands& commands = simulation.commands(group);
  const std::size_t cables = simulation.def().cables.size();
  for (std::size_t c = 0; c < cables; ++c) {
    if (!simulation.Gains(static_cast<int>(c), world)) continue;
    moment.set_point_n.resize(cables, std::numeric_limits<double>::quiet_NaN());
    moment.set_point_n[c] = commands.set_point_n[c * static_cast<std::size_t>(commands.lanes) +
                                                 static_cast<std::size_t>(lane)];
  }
  return state;
}

namespace {

template <class Shared>
std::shared_ptr<LiveView> Show(Shared& shared, const ExperimentSpec& experiment, py::ssize_t world,
                               const std::string& web_folder, int port) {
  if (port < 0 || port > std::numeric_limits<std::uint16_t>::max()) {
    throw py::value_error(fmt::format("port: {}; expected 0 to 65535", port));
  }
  LiveOptions options;
  options.title = experiment.name.empty() ? "taut" : experiment.name;
  options.web_folder = web_folder;
  options.port = static_cast<std::uint16_t>(port);
  Diagnostics said;
  auto view = shared.Show(experiment, shared.World(world), options, said);
  if (!view) Refuse(said);
  return view;
}

}  // namespace

void AddLiveViews(py::module_& module) {
  py::class_<LiveView, std::shared_ptr<LiveView>> type(module, "LiveView");
  type.def_property_readonly("url", &LiveView::url,
                             "Address of the page, with a secret token. It permits looking back.");
  type.def_property_readonly("closed", &LiveView::closed);
  type.def(
      "close",
      [](LiveView& view) {
        const Released others;
        view.Close();
      },
      "Ends the server; open pages keep their last picture.");
  module.def("show_simulation",
             [](SharedSimulation& of, py::ssize_t world, const std::string& web_folder, int port) {
               return Show(of, of.peek().experiment(), world, web_folder, port);
             });
  module.def("show_batch",
             [](Worlds& of, py::ssize_t world, const std::string& web_folder, int port) {
               ExperimentSpec shown;
               shown.robot.def = of.def();
               return Show(of, shown, world, web_folder, port);
             });
  py::module_::import("atexit").attr("register")(py::cpp_function([] {
    const Released others;
    CloseLiveViews();
  }));
}

}  // namespace taut::python
