/// Control page of a robot (`taut view --robot`).
#pragma once

#include <string>

#include "apps/viewer/server.h"
#include "robot_console.h"

namespace taut::cli {

struct ViewRobotArguments : RobotArguments {
  std::string
      out;  ///< Folder of recordings, which starts at once; empty: a browser starts the recording.
  viewer::ServerOptions server;
};

/// Runs until Ctrl-C. Returns the exit status.
int ViewRobot(ViewRobotArguments args);

}  // namespace taut::cli
