// Controllers of an experiment: impedance, position programs, gait inputs.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "description/experiment/control_keys.h"
#include "description/experiment/experiment_parts.h"

namespace taut::description {
namespace {

const std::string& CableName(const RobotSpec& robot, int cable) {
  return robot.def.cables[static_cast<std::size_t>(cable)].name;
}

/// Settings (gains, set points, programs) per cable, with file positions. Reports cables with two
/// settings.
template <class T>
class PerCable {
 public:
  PerCable(const RobotSpec* robot, std::string what, const Scope& scope)
      : robot_(robot), what_(std::move(what)), scope_(scope) {}

  /// Adds a setting for the cables of a selector. `selector` is null if it had an error.
  void Add(const Value* selector, const std::string& path, const T& given) {
    if (!selector) {
      complete_ = false;
      return;
    }
    const std::vector<int> cables = SelectCables(*selector, path, robot_, scope_);
    if (cables.empty()) complete_ = false;
    std::vector<int> twice;
    SourceRef first;
    for (const int cable : cables) {
      const auto [place, fresh] = given_.emplace(cable, Given{given, selector->at});
      if (fresh) continue;
      if (twice.empty()) first = place->second.at;
      twice.push_back(cable);
    }
    if (twice.empty()) return;
    scope_.out.Error("controller.duplicate_cable", selector->at,
                     "there are two " + what_ + " for " + CableNames(*robot_, twice),
                     "the first are in line " + std::to_string(first.line));
  }

  const T* Find(int cable) const {
    const auto found = given_.find(cable);
    return found == given_.end() ? nullptr : &found->second.value;
  }

  /// Reports every selector that matches a cable without a setting in `other`.
  template <class U>
  void Require(const PerCable<U>& other, const std::string& hint) const {
    if (!other.complete()) return;  // its invalid selector may include the missing cables
    std::map<std::pair<int, int>, std::pair<SourceRef, std::vector<int>>> missing;
    for (const auto& [cable, given] : given_) {
      if (other.Find(cable)) continue;
      auto& [at, cables] = missing[{given.at.line, given.at.column}];
      at = given.at;
      cables.push_back(cable);
    }
    for (const auto& [place, lacking] : missing) {
      scope_.out.Error(
          "controller.cable_without", lacking.first,
          "there are no " + other.what() + " for " + CableNames(*robot_, lacking.second), hint);
    }
  }

  /// Returns false if a selector had an error and may include more cables.
  bool complete() const { return complete_; }
  void SetIncomplete() { complete_ = false; }
  const std::string& what() const { return what_; }
  std::vector<int> cables() const {
    std::vector<int> out;
    for (const auto& entry : given_) out.push_back(entry.first);
    return out;
  }

 private:
  struct Given {
    T value;
    SourceRef at;
  };
  const RobotSpec* robot_;
  std::string what_;
  const Scope& scope_;
  std::map<int, Given> given_;
  bool complete_ = true;
};

using Points = std::vector<std::pair<double, double>>;

/// Reads a constant, or points [[time_s, value], ...].
Points ReadCourse(const Value& value, const std::string& what, const Bound& bound,
                  const Scope& scope) {
  if (value.kind == Value::Kind::kSequence) return ReadPoints(value, what, bound, scope);
  if (value.kind != Value::Kind::kScalar) {
    WrongType(value, what, "a number or a list of [time_s, value]", scope);
    return {};
  }
  const double number = ReadNumber(value, what, bound, scope);
  if (std::isnan(number)) return {};
  return {{0.0, number}};
}

struct Course {
  Points points;
  bool relative = false;  ///< Whether values are added to the cable's rest length in the described
                          ///< pose.
  SourceRef at;
};

/// Returns the rest length program of one cable. Reports errors once per course, not once per
/// cable.
PositionProgram ProgramFor(const RobotSpec& robot, int cable, const Course& course,
                           std::set<std::pair<int, int>>& reported, const Scope& scope) {
  PositionProgram program{cable, course.points};
  if (!course.relative) return program;
  const CableDef& def = robot.def.cables[static_cast<std::size_t>(cable)];
  for (auto& [time_s, length_m] : program.rest_length_m) {
    const double change_m = length_m;
    length_m += def.rest_length_m;
    if (!(length_m <= 0.0) || !reported.insert({course.at.line, course.at.column}).second) continue;
    scope.out.Error("program.no_rest_length", course.at,
                    "programs.change_m: a change of " + Shown(change_m) + " m at t = " +
                        Shown(time_s) + " s leaves " + def.name + " without a positive rest length",
                    "its initial rest length is " + Shown(def.rest_length_m) + " m");
  }
  return program;
}

/// Returns the cables that a controller drives by control law or gait, in ascending order.
std::set<int> DrivenCables(const ControllerSpec& controller, const std::vector<int>& of_gait) {
  std::set<int> cables(of_gait.begin(), of_gait.end());
  if (controller.impedance) {
    for (const ImpedanceGains& gains : controller.impedance->cables) cables.insert(gains.cable);
  }
  for (const PositionProgram& program : controller.position) cables.insert(program.cable);
  return cables;
}

/// Reports cables that a controller cannot drive, one error per reason.
void CheckDriven(const std::vector<ControllerSpec>& controllers,
                 const std::vector<std::set<int>>& driven, const std::vector<SourceRef>& places,
                 const RobotSpec& robot, bool actuators_known, const Scope& scope) {
  std::map<int, std::size_t> driver;
  for (std::size_t i = 0; i < controllers.size(); ++i) {
    std::vector<int> no_actuator;
    std::map<std::size_t, std::vector<int>> taken;
    for (const int cable : driven[i]) {
      const CableDef& def = robot.def.cables[static_cast<std::size_t>(cable)];
      if (def.actuator.kind == ActuatorDef::Kind::kNone) no_actuator.push_back(cable);
      const auto [place, fresh] = driver.emplace(cable, i);
      if (!fresh) taken[place->second].push_back(cable);
    }
    if (!no_actuator.empty() && actuators_known) {
      scope.out.Error("controller.cable_without_actuator", places[i],
                      "controller " + controllers[i].name +
                          " drives cables without an actuator: " + CableNames(robot, no_actuator),
                      "give the cable's builder in the model an `actuator:`");
    }
    for (const auto& [other, cables] : taken) {
      scope.out.Error("controller.cable_driven_twice", places[i],
                      "controller " + controllers[i].name + " drives " + CableNames(robot, cables) +
                          ", which controller " + controllers[other].name + " already drives",
                      "a cable can have only one controller");
    }
  }
}

}  // namespace

std::string CableNames(const RobotSpec& robot, const std::vector<int>& cables) {
  std::string out;
  for (const int cable : cables) out += (out.empty() ? "" : ", ") + CableName(robot, cable);
  return out;
}

std::string Written(const Value& selector) {
  if (selector.kind != Value::Kind::kSequence) return selector.text;
  std::string out;
  for (const ValuePtr& item : selector.items) out += (out.empty() ? "" : ", ") + Written(*item);
  return "[" + out + "]";
}

std::string UnknownWord(const std::vector<std::vector<std::string>>& match,
                        std::vector<std::string> words, const std::string& kind) {
  std::sort(words.begin(), words.end());
  words.erase(std::unique(words.begin(), words.end()), words.end());
  if (words.empty()) return "the robot has no " + kind + "s";
  std::string hint = "no " + kind + " has all of these tags";
  for (const auto& set : match) {
    for (const std::string& word : set) {
      if (std::binary_search(words.begin(), words.end(), word)) continue;
      hint = "no " + kind + " is called or tagged \"" + word + "\"; " + DidYouMean(word, words);
    }
  }
  return hint;
}

std::vector<int> SelectCables(const Value& value, std::string_view what, const RobotSpec* robot,
                              const Scope& scope) {
  const auto match = ReadMatch(value, what, scope);
  std::vector<int> cables;
  if (match.empty() || !robot) return cables;
  std::vector<std::string> words;
  for (std::size_t i = 0; i < robot->cable_tags.size(); ++i) {
    const Tags& tags = robot->cable_tags[i];
    if (Matches(match, tags)) cables.push_back(static_cast<int>(i));
    words.insert(words.end(), tags.begin(), tags.end());
  }
  if (!cables.empty()) return cables;
  scope.out.Error("controller.matches_no_cable", value.at,
                  std::string(what) + ": no cable matches " + Written(value),
                  UnknownWord(match, std::move(words), "cable"));
  return cables;
}

void Check(const MapReader& map, ImpedanceText& impedance) {
  if (impedance.conversion == TensionConversion::kStiffness && map.Has("pid")) {
    map.Error("controller.pid_without_effect", "pid", "impedance.pid has no effect",
              "add `conversion: pid`");
  }
  if (impedance.conversion == TensionConversion::kPid && !map.Has("pid")) {
    map.Error("controller.pid_missing", "conversion",
              "conversion: pid needs the key \"pid\" as well",
              "write `pid: {proportional_m_per_s_n: 0.01}`");
  }
  if (impedance.pid_text) impedance.pid = *impedance.pid_text;
  impedance.differenced_rate = impedance.rate != RateSource::kExact;
  impedance.start_from_rest_length = impedance.rate == RateSource::kDifferencedFromRestLength;
  const auto is_list = [&](std::string_view key) {
    return map.Has(key) && map.Find(key)->kind == Value::Kind::kSequence;
  };
  impedance.gains_complete = is_list("gains");
  impedance.set_points_complete = is_list("set_points");
}

void Check(const MapReader& map, ControllerText& controller) {
  controller.name_at = map.KeyAt("name");
  if (map.Has("velocity_input") && !map.Has("impedance")) {
    for (const char* key : {"position", "rest_length_input"}) {
      if (!map.Has(key)) continue;
      map.Error("controller.velocity_input_without_effect", "velocity_input",
                std::string("velocity_input has no effect with ") + key,
                "it sets V0 of `impedance`");
      break;
    }
  }
}

ImpedanceSpec ToImpedance(const ImpedanceText& text, const RobotSpec* robot, const Scope& scope) {
  PerCable<GainsText> gains(robot, "gains", scope);
  if (!text.gains_complete) gains.SetIncomplete();
  for (const GainsText& entry : text.gains) gains.Add(entry.cables.value, "gains.cables", entry);
  PerCable<SetPointText> set_points(robot, "set points", scope);
  if (!text.set_points_complete) set_points.SetIncomplete();
  for (const SetPointText& entry : text.set_points) {
    set_points.Add(entry.cables.value, "set_points.cables", entry);
  }
  set_points.Require(gains, "add a selector to `gains`");
  gains.Require(set_points, "add a selector to `set_points`, or narrow this one");
  ImpedanceSpec out = text;
  for (const int cable : set_points.cables()) {
    const GainsText* gain = gains.Find(cable);
    if (!gain) continue;
    const SetPointText& set_point = *set_points.Find(cable);
    out.cables.push_back({cable, set_point.tension_n, set_point.length_m,
                          gain->position_gain_n_per_m, gain->velocity_gain_n_s_per_m,
                          set_point.velocity_m_per_s});
  }
  return out;
}

std::vector<PositionProgram> ToPrograms(const PositionText& text, const RobotSpec* robot,
                                        const Scope& scope) {
  PerCable<Course> courses(robot, "programs", scope);
  for (const ProgramText& entry : text.programs) {
    Course course;
    course.relative = entry.change_m.value && !entry.rest_length_m.value;
    const Value* points = course.relative ? entry.change_m.value : entry.rest_length_m.value;
    if (points) {
      course.at = points->at;
      course.points =
          ReadCourse(*points, course.relative ? "programs.change_m" : "programs.rest_length_m",
                     course.relative ? Bound::kAny : Bound::kPositive, scope);
    }
    courses.Add(entry.cables.value, "programs.cables", course);
  }
  std::vector<PositionProgram> programs;
  std::set<std::pair<int, int>> reported;
  for (const int cable : courses.cables()) {
    programs.push_back(ProgramFor(*robot, cable, *courses.Find(cable), reported, scope));
  }
  return programs;
}

std::vector<ControllerSpec> ToControllers(std::vector<ControllerText>& texts,
                                          const RobotSpec* robot, bool actuators_known,
                                          const Scope& scope) {
  std::vector<ControllerSpec> controllers;
  std::vector<std::set<int>> driven;
  std::vector<SourceRef> places;
  std::map<std::string, SourceRef> names;
  for (ControllerText& text : texts) {
    ControllerSpec& controller = controllers.emplace_back(text);
    if (text.impedance_text) {
      controller.impedance = ToImpedance(*text.impedance_text, robot, scope);
    }
    if (text.position_text) controller.position = ToPrograms(*text.position_text, robot, scope);
    std::vector<int> moved, of_gait;
    if (text.velocity_input_text) {
      controller.velocity_input =
          ToGaitInput(*text.velocity_input_text, kVelocityInput, robot, scope, moved);
      if (robot && controller.velocity_input && controller.impedance) {
        CheckGaitDrives(controller, moved, *robot, text.velocity_input_text->at, scope.out);
      }
    }
    if (text.rest_length_input_text) {
      controller.rest_length_input =
          ToGaitInput(*text.rest_length_input_text, kRestLengthInput, robot, scope, of_gait);
    }
    driven.push_back(DrivenCables(controller, of_gait));
    if (!controller.name.empty()) {
      const auto [first, fresh] = names.emplace(controller.name, text.name_at);
      if (!fresh) {
        scope.out.Error("controller.duplicate_name", text.name_at,
                        "two controllers are called " + controller.name,
                        "the first is in line " + std::to_string(first->second.line));
      }
    }
    places.push_back(text.name_at);
  }
  if (robot) CheckDriven(controllers, driven, places, *robot, actuators_known, scope);
  return controllers;
}

}  // namespace taut::description
