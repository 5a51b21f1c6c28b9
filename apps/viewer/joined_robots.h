/// Several robots side by side, merged into one model for display.
#pragma once

#include <string>
#include <vector>

#include "frame.h"
#include "taut/model_def.h"
#include "taut/page.h"

namespace taut::viewer {

class JoinedRobots {
 public:
  /// Adds a robot, as `Page::Add` does.
  int Add(const ModelDef& robot, const std::string& name, const Vec3& at_m);

  std::size_t size() const { return robots_.size(); }
  /// Returns the merged model, with unique names. Not for compilation: materials may differ.
  const ModelDef& def() const { return joined_; }

  /// Returns per cable whether it was given a set point.
  std::vector<bool> HasSetPoint() const;

  /// Same as `Page::Set`: checks the state, then stores it.
  void Set(int robot, const RobotMoment& moment);
  /// Sets bodies, cables, contacts and pushes to the last states.
  void Fill(Frame& frame) const;

 private:
  struct Robot {
    Vec3 at_m;
    ModelDef def;
    int first_node = 0;
    RobotMoment moment;
  };
  void FillCables(const Robot& robot, Frame& frame) const;
  void AddTerrain(const ModelDef& robot, const std::string& prefix, const Vec3& at_m);

  std::vector<Robot> robots_;
  ModelDef joined_;
};

}  // namespace taut::viewer
