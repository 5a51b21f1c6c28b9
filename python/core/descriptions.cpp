// `taut.Robot`, `taut.Experiment` and `taut.load`: robots and experiments from files.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "python_control.h"
#include "taut/files.h"
#include "taut/time_limits.h"
#include "text.h"

namespace taut::python {
namespace {

std::string Representation(const std::string& kind, const std::string& name, const ModelDef& def) {
  return "<taut." + kind + " \"" + name + "\": " + std::to_string(def.bodies.size()) + " bodies, " +
         std::to_string(def.cables.size()) + " cables>";
}

py::object Load(const std::string& given, const py::kwargs& set) {
  const Overrides overrides = OverridesOf(set);
  Diagnostics said;
  const std::string path = InputPath(given, {"model", "experiment"}, said);
  if (!said.ok()) Refuse(said);
  std::optional<std::string> kind;
  std::optional<ExperimentSpec> experiment;
  std::optional<RobotSpec> robot;
  {
    const Released others;
    kind = FileKind(path, said);
    if (kind == "experiment") experiment = LoadExperiment(path, overrides, said);
    if (kind == "model") robot = LoadRobot(path, overrides, said);
  }
  if (kind && kind != "experiment" && kind != "model") {
    said.Error("file.wrong_kind", {path, 1, 1}, "the file has the kind \"" + *kind + "\"",
               "taut.load reads models and experiments");
  }
  if (!experiment && !robot) Refuse(said);
  Tell(said);
  if (experiment) return py::cast(std::make_shared<ExperimentSpec>(std::move(*experiment)));
  return py::cast(std::make_shared<RobotSpec>(std::move(*robot)));
}

}  // namespace

void AddDescriptions(py::module_& module) {
  using Robot = RobotSpec;
  py::class_<Robot, std::shared_ptr<Robot>>(
      module, "Robot",
      "A robot as described by a model file, with all numbers resolved. Returned by `taut.load`.")
      .def_property_readonly(
          "bodies", [](const Robot& r) { return NamesOf(r.def.bodies); },
          "Names of the bodies, in the order of all arrays.")
      .def_property_readonly(
          "nodes", [](const Robot& r) { return NamesOf(r.def.nodes); }, "Names.")
      .def_property_readonly(
          "cables", [](const Robot& r) { return NamesOf(r.def.cables); }, "Names.")
      .def_property_readonly(
          "joints", [](const Robot& r) { return NamesOf(r.def.joints); }, "Names.")
      .def_property_readonly(
          "parameters", [](const Robot& r) { return r.parameters; },
          "Named parameters after resolution, in the file's units (SI).")
      .def_property_readonly(
          "files", [](const Robot& r) { return r.files; },
          "Paths of all files read, the model first.")
      .def("__repr__", [](const Robot& r) {
        return Representation("Robot", r.files.empty() ? "" : r.files[0], r.def);
      });

  using Experiment = ExperimentSpec;
  py::class_<Experiment, std::shared_ptr<Experiment>>(
      module, "Experiment",
      "A robot with its ground, controllers and timeline, as described by an experiment file. "
      "Returned by `taut.load`.")
      .def_readonly("name", &Experiment::name)
      .def_readonly("description", &Experiment::description)
      .def_property_readonly(
          "robot", [](const Experiment& e) { return WithoutExperiment(e.robot); },
          "Copy of the robot at its place in the experiment, with the terrain.")
      .def_readonly("step_s", &Experiment::step_s, "Time step [s].")
      .def_property(
          "duration_s", [](const Experiment& e) { return e.duration_s; },
          [](Experiment& e, double given) {
            if (!(given > 0 && given <= kLongestTime_s)) {
              throw py::value_error(
                  fmt::format("duration_s: {}; expected a positive number up to {:g} [s]", given,
                              kLongestTime_s));
            }
            e.duration_s = given;
          },
          "Simulated time of `taut.run` [s].")
      .def_property(
          "seed", [](const Experiment& e) { return e.seed; },
          [](Experiment& e, const py::object& given) { e.seed = Seed(given); },
          "Seed of all random numbers.")
      .def_property_readonly(
          "parameters", [](const Experiment& e) { return e.parameters; },
          "The experiment's named parameters after resolution, without those of its model (SI).")
      .def_property_readonly(
          "load_cases", [](const Experiment& e) { return NamesOf(e.load_cases); },
          "Names of the load cases, for `taut.analyze`.")
      .def_property_readonly(
          "files", [](const Experiment& e) { return e.files; },
          "Paths of all files read, the experiment first.")
      .def_property_readonly(
          "input_hash", [](const Experiment& e) { return e.input_hash; },
          "Hash of the bytes of all files and of the overrides.")
      .def_property_readonly(
          "controllers",
          [](const Experiment& e) {
            std::vector<std::shared_ptr<LibrarySpec>> all;
            for (const ControllerSpec& one : e.controllers) {
              all.push_back(
                  std::make_shared<LibrarySpec>(LibrarySpec{one, NamesOf(e.robot.def.cables)}));
            }
            return all;
          },
          "List of the experiment's controllers: copies.")
      .def(
          "without_controllers",
          [](const Experiment& e) {
            auto bare = std::make_shared<Experiment>(e);
            bare->controllers.clear();
            bare->robot.def.experiment_parts = ActingParts(*bare);
            return bare;
          },
          "Returns a copy without controllers, for use with other controllers.")
      .def(
          "to_yaml", [](const Experiment& e) { return ResolvedYaml(e); },
          "Returns the experiment and its robot as one YAML text with all numbers resolved, which "
          "`taut.load` reads back bit-identically.")
      .def("__repr__",
           [](const Experiment& e) { return Representation("Experiment", e.name, e.robot.def); });

  module.def("data_folder", &DataFolder, "Folder of the files that come with taut, or None.");
  module.def("load", &Load, py::arg("path"),
             "Reads a model or an experiment file. Keyword arguments set its named parameters, as "
             "numbers or expressions:\n\n    taut.load(\"experiments/push_20n.yaml\", "
             "stiffness_n_per_m=300)\n\nReturns a `Robot` or an `Experiment`. Raises one "
             "`taut.InputError` for all errors; its `items` contain file, line, column, message "
             "and hint. Issues warnings as `taut.InputWarning`.");
}

}  // namespace taut::python
