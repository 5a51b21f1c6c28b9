/// What must be true of every file that a reader is given, good or bad. The fuzz targets and the
/// tests with random damage ask the same.
#pragma once

#include <cmath>
#include <string>

#include "fuzz/fuzz_folder.h"
#include "taut/batch.h"
#include "taut/spec.h"

namespace taut::fuzz {

/// Either a robot or at least one complaint; a robot's numbers can be compiled or are refused.
inline void CheckRobot(const RobotSpec& robot) {
  const ModelDef& def = robot.def;
  for (const BodyDef& body : def.bodies) {
    Must(body.fixed || (body.mass_kg > 0 && std::isfinite(body.mass_kg)), "mass of " + body.name);
    Must(std::isfinite(body.com_m.x + body.com_m.y + body.com_m.z), "place of " + body.name);
  }
  for (const CableDef& cable : def.cables) {
    Must(cable.rest_length_m > 0 && std::isfinite(cable.rest_length_m),
         "rest length of " + cable.name);
  }
  Must(robot.cable_tags.size() == def.cables.size(), "tags of cables");
  Must(robot.node_tags.size() == def.nodes.size(), "tags of nodes");
  Diagnostics refused;
  Must((Model::Compile(def, refused) != nullptr) == refused.ok(), "compiled or refused");
}

/// Without the lines at the top that say where it comes from.
inline std::string WithoutComments(std::string text) {
  while (text.starts_with("#")) text.erase(0, text.find('\n') + 1);
  return text;
}

/// True if the file at `path` is a model.
inline bool CheckModelFile(const std::string& path) {
  Diagnostics out;
  const auto robot = LoadRobot(path, {}, out);
  Must(robot.has_value() == out.ok(), "a robot or complaints: " + out.Format());
  if (robot) CheckRobot(*robot);
  return robot.has_value();
}

/// True if the file at `path` is an experiment. What it resolves to must be one, too, and resolve
/// to the same text.
inline bool CheckExperimentFile(const std::string& path, const Folder& folder) {
  Diagnostics out;
  const auto experiment = LoadExperiment(path, {}, out);
  Must(experiment.has_value() == out.ok(), "an experiment or complaints: " + out.Format());
  if (!experiment) return false;
  CheckRobot(experiment->robot);
  const ModelDef& def = experiment->robot.def;
  for (const ControllerSpec& controller : experiment->controllers) {
    for (const PositionProgram& program : controller.position) {
      Must(static_cast<std::size_t>(program.cable) < def.cables.size(), "cable of a program");
    }
    if (!controller.impedance) continue;
    for (const ImpedanceGains& gains : controller.impedance->cables) {
      Must(static_cast<std::size_t>(gains.cable) < def.cables.size(), "cable of gains");
    }
  }
  for (const PushSpec& push : experiment->pushes) {
    Must(static_cast<std::size_t>(push.node) < def.nodes.size(), "node of a push");
  }
  for (const DragSpec& drag : experiment->drags) {
    Must(static_cast<std::size_t>(drag.node) < def.nodes.size(), "node of a drag");
  }
  const std::string text = ResolvedYaml(*experiment);
  Diagnostics again;
  const auto same =
      LoadExperiment(folder.Write("inputs.yaml", text.data(), text.size()), {}, again);
  Must(same.has_value(), "what was resolved can be read: " + again.Format() + text);
  Must(WithoutComments(ResolvedYaml(*same)) == WithoutComments(text),
       "what was resolved is read as it was");
  return true;
}

}  // namespace taut::fuzz
