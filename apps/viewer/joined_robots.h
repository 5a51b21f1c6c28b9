/// Robots side by side, as one that the page can show.
#pragma once

#include <string>
#include <vector>

#include "frame.h"
#include "taut/model_def.h"
#include "taut/page.h"

namespace taut::viewer {

class JoinedRobots {
 public:
  /// As `Page::Add`.
  int Add(const ModelDef& robot, const std::string& name, const Vec3& at_m);

  std::size_t size() const { return robots_.size(); }
  /// All of them, with names that tell them apart. Not to be compiled: materials may differ.
  const ModelDef& def() const { return joined_; }

  /// By cable: whether it was set with a set point.
  std::vector<bool> HasSetPoint() const;

  /// As `Page::Set`: checked, then kept.
  void Set(int robot, const RobotMoment& moment);
  /// Bodies, cables, contacts and pushes, as they were set last.
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
