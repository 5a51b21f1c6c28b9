/// `taut view --robot`: a page to drive a robot from.
#pragma once

#include <string>

#include "apps/viewer/server.h"
#include "robot.h"

namespace taut::cli {

struct ViewRobotArguments : RobotArguments {
  std::string out;  ///< Empty: records when a browser asks for it.
  viewer::ServerOptions server;
};

/// Until Ctrl-C; the exit status.
int ViewRobot(ViewRobotArguments args);

}  // namespace taut::cli
