/// Requirements on readers for every file, valid or not, shared by the fuzz targets and the tests
/// with random damage.
#pragma once

#include <cmath>
#include <string>

#include "fuzz/fuzz_folder.h"
#include "taut/spec.h"
#include "taut/world_batch.h"

namespace taut::fuzz {

/// Checks a robot that was read: its numbers are valid, and it can be compiled or is refused.
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

/// Returns the text without the comment lines at the top, which contain its origin.
inline std::string WithoutComments(std::string text) {
  while (text.starts_with("#")) text.erase(0, text.find('\n') + 1);
  return text;
}

/// Checks the reader on the file at `path`; returns true if it is a model.
inline bool CheckModelFile(const std::string& path) {
  Diagnostics out;
  const auto robot = LoadRobot(path, {}, out);
  Must(robot.has_value() == out.ok(), "a robot or complaints: " + out.Format());
  if (robot) CheckRobot(*robot);
  return robot.has_value();
}

/// Checks the reader on the file at `path`; returns true if it is an experiment. Its resolved text
/// must be an experiment, too, and resolve to the same text.
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
