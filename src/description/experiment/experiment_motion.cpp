// Kinematic bodies of an experiment.
#include <algorithm>
#include <set>

#include "base/brief.h"
#include "base/fixed.h"
#include "description/experiment/experiment_keys.h"
#include "description/experiment/experiment_parts.h"
#include "description/model/sanity_checks.h"
#include "math/elementary.h"

namespace taut::description {
namespace {

/// Converts a terrain box to a fixed body and returns its index.
int BodyOfBox(std::size_t box, RobotSpec& robot) {
  ModelDef& def = robot.def;
  const TerrainBoxDef& from = def.terrain_boxes[box];
  BodyDef body;
  body.name = from.name;
  body.com_m = from.center_m;
  body.fixed = true;
  const int number = static_cast<int>(def.bodies.size());
  def.boxes.push_back(
      {from.name, number, from.center_m, from.orientation, from.half_extents_m, from.material});
  def.bodies.push_back(std::move(body));
  robot.body_sources.push_back(robot.terrain_box_sources[box]);
  if (robot.solids) robot.solids->boxes.emplace_back();
  const auto at = static_cast<std::ptrdiff_t>(box);
  def.terrain_boxes.erase(def.terrain_boxes.begin() + at);
  robot.terrain_box_sources.erase(robot.terrain_box_sources.begin() + at);
  return number;
}

template <class List>
std::size_t Find(const List& list, const std::string& name) {
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const auto& x) { return x.name == name; });
  return static_cast<std::size_t>(found - list.begin());
}

void CheckLaw(const MapReader& map, const char* speed, const char* amplitude) {
  if (map.Has(amplitude) && !map.Has("frequency_hz")) {
    map.Error("motion.frequency_missing", amplitude, map.Path(amplitude) + " needs frequency_hz");
  }
  if (!map.Has(amplitude) && !map.Has(speed)) {
    map.scope().out.Error("motion.no_motion", map.at(),
                          map.what() + " has neither a speed nor an amplitude");
  }
}

/// Reports joints between a kinematic body and another fixed body.
void CheckJoints(const ModelDef& def, int body, const SourceRef& at, const Scope& scope) {
  for (const JointDef& joint : def.joints) {
    if (joint.body_a != body && joint.body_b != body) continue;
    if (!base::IsFixed(def, joint.body_a) || !base::IsFixed(def, joint.body_b)) continue;
    scope.out.Error(
        "motion.joint_to_kinematic_body", at,
        "motion.of: the joint \"" + joint.name + "\" connects the body to another fixed body",
        "leave the joint out of the model");
  }
}

}  // namespace

void Check(const MapReader& map, SlideText&) { CheckLaw(map, "speed_m_per_s", "amplitude_m"); }
void Check(const MapReader& map, TurnText&) { CheckLaw(map, "speed_rad_per_s", "amplitude_rad"); }
void Check(const MapReader& map, MotionText&) {
  if (map.Has("slide") || map.Has("turn")) return;
  map.scope().out.Error("motion.slide_or_turn_missing", map.at(),
                        map.what() + " needs `slide` or `turn`");
}

void AddMotions(const std::vector<MotionText>& texts, bool robot_known, const Scope& scope,
                RobotSpec& robot) {
  ModelDef& def = robot.def;
  std::set<std::string> names, moved;
  for (const MotionText& text : texts) {
    if (!names.insert(text.name).second) {
      scope.out.Error("motion.duplicate_name", text.at, "two motions are called " + text.name);
      continue;
    }
    if (!moved.insert(text.of.text).second) {
      scope.out.Error("motion.body_moved_twice", text.of.at,
                      "motion.of: \"" + text.of.text + "\" already has a motion");
      continue;
    }
    MotionDef motion;
    motion.name = text.name;
    if (text.slide) motion.direction = text.slide->direction, motion.slide = text.slide->law;
    if (text.turn) {
      motion.axis = text.turn->axis, motion.center_m = text.turn->center_m;
      motion.turn = text.turn->law;
    }
    const std::size_t body = Find(def.bodies, text.of.text);
    const std::size_t box = Find(def.terrain_boxes, text.of.text);
    if (body < def.bodies.size()) {
      motion.body = static_cast<int>(body);
      def.bodies[body].fixed = true;
      def.bodies[body].velocity_m_per_s = def.bodies[body].angular_velocity_rad_per_s = {};
      CheckJoints(def, motion.body, text.of.at, scope);
    } else if (box < def.terrain_boxes.size()) {
      motion.body = BodyOfBox(box, robot);
    } else {
      std::vector<std::string> known;
      for (const BodyDef& b : def.bodies) known.push_back(b.name);
      for (const TerrainBoxDef& b : def.terrain_boxes) known.push_back(b.name);
      if (robot_known) {
        scope.out.Error("motion.unknown_body", text.of.at,
                        "motion.of: \"" + text.of.text +
                            "\" is neither a body of the robot nor a box of the terrain",
                        NameHint(text.of.text, known));
      }
      continue;
    }
    def.motions.push_back(std::move(motion));
  }
}

void CheckMotions(const std::vector<MotionText>& texts, const ExperimentSpec& experiment,
                  const Scope& scope) {
  const double duration_s = experiment.duration_s;
  const auto reach = [&](const TimeLaw& law) {
    double fastest = 0;
    for (const auto& [time_s, speed] : law.speed) fastest = std::max(fastest, std::fabs(speed));
    return fastest * duration_s + 2 * std::fabs(law.amplitude);
  };
  const auto check = [&](const MotionText& text, const TimeLaw& law) {
    if (law.amplitude == 0 || law.frequency_hz * experiment.step_s <= 0.5) return;
    scope.out.Warning("motion.frequency_too_high", text.at,
                      "the motion \"" + text.name + "\" has " + base::Brief(law.frequency_hz) +
                          " Hz, so a step of " + base::Brief(experiment.step_s) +
                          " s gives less than two steps per period",
                      "use a smaller step_s");
  };
  const std::string in_time = " in " + base::Brief(duration_s) + " s";
  for (const MotionText& text : texts) {
    const double way_m = text.slide ? reach(text.slide->law) : 0;
    const double angle_rad = text.turn ? reach(text.turn->law) : 0;
    if (IsTooFar(experiment.robot, way_m)) {
      scope.out.Error(
          "motion.too_far", text.at,
          "the motion \"" + text.name + "\" may move by " + base::Brief(way_m) + " m" + in_time,
          "use a smaller motion: positions that far away are rounded too coarsely for this robot");
    }
    if (!(angle_rad <= math::kMaxAngle)) {
      scope.out.Error("motion.turns_too_far", text.at,
                      "the motion \"" + text.name + "\" may rotate by " + base::Brief(angle_rad) +
                          " rad" + in_time,
                      "at most 1e9 rad: larger angles are rounded too coarsely");
    }
    if (text.slide) check(text, text.slide->law);
    if (text.turn) check(text, text.turn->law);
  }
}

}  // namespace taut::description
