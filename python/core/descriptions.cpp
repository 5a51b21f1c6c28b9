// Robots and experiments out of files.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "taut/files.h"
#include "text.h"

namespace taut::python {
namespace {

std::string Representation(const std::string& kind, const std::string& name, const ModelDef& def) {
  return "<taut." + kind + " \"" + name + "\": " + std::to_string(def.bodies.size()) + " bodies, " +
         std::to_string(def.cables.size()) + " cables>";
}

py::object Load(const std::string& given, const py::kwargs& set) {
  const std::string path = InputPath(given);
  const Overrides overrides = OverridesOf(set);
  Diagnostics said;
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
    said.Error({path, 1, 1}, "a file of the kind \"" + *kind + "\"",
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
      module, "Robot", "A robot as a model file describes it, in numbers. Made by `taut.load`.")
      .def_property_readonly(
          "bodies", [](const Robot& r) { return NamesOf(r.def.bodies); },
          "Names, in the order of all arrays.")
      .def_property_readonly(
          "nodes", [](const Robot& r) { return NamesOf(r.def.nodes); }, "Names.")
      .def_property_readonly(
          "cables", [](const Robot& r) { return NamesOf(r.def.cables); }, "Names.")
      .def_property_readonly(
          "joints", [](const Robot& r) { return NamesOf(r.def.joints); }, "Names.")
      .def_property_readonly(
          "parameters", [](const Robot& r) { return r.parameters; },
          "Named parameters as resolved, in the file's units (SI).")
      .def_property_readonly(
          "files", [](const Robot& r) { return r.files; },
          "Every file that was read, the model first.")
      .def("__repr__", [](const Robot& r) {
        return Representation("Robot", r.files.empty() ? "" : r.files[0], r.def);
      });

  using Experiment = ExperimentSpec;
  py::class_<Experiment, std::shared_ptr<Experiment>>(
      module, "Experiment",
      "A robot, its ground, controllers and timeline as an experiment file describes them. Made by "
      "`taut.load`.")
      .def_readonly("name", &Experiment::name)
      .def_readonly("description", &Experiment::description)
      .def_property_readonly(
          "robot", [](const Experiment& e) { return std::make_shared<Robot>(e.robot); },
          "The robot as placed, with the experiment's terrain: a copy.")
      .def_readonly("step_s", &Experiment::step_s, "Time step [s].")
      .def_property(
          "duration_s", [](const Experiment& e) { return e.duration_s; },
          [](Experiment& e, double given) { e.duration_s = Positive(given, "duration_s"); },
          "Simulated time of `taut.run` [s].")
      .def_property(
          "seed", [](const Experiment& e) { return e.seed; },
          [](Experiment& e, const py::object& given) { e.seed = Seed(given); },
          "Seed of all random numbers.")
      .def_property_readonly(
          "parameters", [](const Experiment& e) { return e.parameters; },
          "The experiment's own named parameters as resolved (SI).")
      .def_property_readonly(
          "load_cases", [](const Experiment& e) { return NamesOf(e.load_cases); },
          "Names, for `taut.analyze`.")
      .def_property_readonly(
          "files", [](const Experiment& e) { return e.files; },
          "Every file that was read, the experiment first.")
      .def_property_readonly(
          "input_hash", [](const Experiment& e) { return e.input_hash; },
          "Of the bytes of all files and of the overrides.")
      .def(
          "to_yaml", [](const Experiment& e) { return ResolvedYaml(e); },
          "The experiment and its robot in numbers, as one text that `taut.load` reads back to the "
          "same bits.")
      .def("__repr__",
           [](const Experiment& e) { return Representation("Experiment", e.name, e.robot.def); });

  module.def("data_folder", &DataFolder, "Folder of the files that come with taut, or None.");
  module.def("load", &Load, py::arg("path"),
             "Reads a model or an experiment file; keyword arguments set its named parameters, as "
             "numbers or expressions:\n\n"
             "    taut.load(\"experiments/push_20n.yaml\", stiffness_n_per_m=300)\n\n"
             "Raises `taut.InputError`, whose `items` say file, line, column, what is wrong and a "
             "hint, all mistakes at once. Warns with `taut.InputWarning`.");
}

}  // namespace taut::python
