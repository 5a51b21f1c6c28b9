#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "description/experiment_parts.h"

namespace taut::description {
namespace {

const std::string& CableName(const RobotSpec& robot, int cable) {
  return robot.def.cables[static_cast<std::size_t>(cable)].name;
}

std::string CableNames(const RobotSpec& robot, const std::vector<int>& cables) {
  std::string out;
  for (const int cable : cables) out += (out.empty() ? "" : ", ") + CableName(robot, cable);
  return out;
}

/// A selector as a user would write it: [inner, top].
std::string Written(const Value& selector) {
  if (selector.kind != Value::Kind::kSequence) return selector.text;
  std::string out;
  for (const ValuePtr& item : selector.items) out += (out.empty() ? "" : ", ") + Written(*item);
  return "[" + out + "]";
}

/// What (gains, set points ...) some cables were given, and where; complains about a cable that
/// gets it twice.
template <class T>
class PerCable {
 public:
  PerCable(const RobotSpec* robot, std::string what, const Scope& scope)
      : robot_(robot), what_(std::move(what)), scope_(scope) {}

  /// `selector` may be null, after a complaint about it.
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
    scope_.out.Error(selector->at, "two " + what_ + " for " + CableNames(*robot_, twice),
                     "the first are in line " + std::to_string(first.line));
  }

  const T* Find(int cable) const {
    const auto found = given_.find(cable);
    return found == given_.end() ? nullptr : &found->second.value;
  }

  /// An error for every selector here that matches a cable that `other` lacks.
  template <class U>
  void Require(const PerCable<U>& other, const std::string& hint) const {
    if (!other.complete()) return;  // what is missing was probably meant by a selector in error
    std::map<std::pair<int, int>, std::pair<SourceRef, std::vector<int>>> missing;
    for (const auto& [cable, given] : given_) {
      if (other.Find(cable)) continue;
      auto& [at, cables] = missing[{given.at.line, given.at.column}];
      at = given.at;
      cables.push_back(cable);
    }
    for (const auto& [place, lacking] : missing) {
      scope_.out.Error(lacking.first,
                       "no " + other.what() + " for " + CableNames(*robot_, lacking.second), hint);
    }
  }

  /// False if a selector was wrong: then more cables may have been meant.
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

struct Gains {
  double position_n_per_m = 0.0, velocity_n_s_per_m = 0.0;
};

struct SetPoint {
  double tension_n = 0.0, length_m = 0.0, velocity_m_per_s = 0.0;
};

void ReadPid(const MapReader& impedance, ImpedanceSpec& out) {
  const Value* value = impedance.Find("pid");
  if (out.conversion == TensionConversion::kStiffness) {
    if (value) {
      impedance.Error("pid", "impedance.pid has no effect", "write `conversion: pid`, too");
    }
    return;
  }
  if (!value) {
    impedance.Error("conversion", "conversion: pid needs the key \"pid\" beside it",
                    "write `pid: {proportional_m_per_s_n: 0.01}`");
    return;
  }
  const MapReader pid(*value, "impedance.pid",
                      {"proportional_m_per_s_n", "integral_m_per_s2_n", "derivative_m_per_n"},
                      impedance.scope());
  out.pid.proportional_m_per_s_n = pid.Number("proportional_m_per_s_n", Bound::kNonNegative);
  out.pid.integral_m_per_s2_n = pid.NumberOr("integral_m_per_s2_n", 0.0, Bound::kNonNegative);
  out.pid.derivative_m_per_n = pid.NumberOr("derivative_m_per_n", 0.0, Bound::kNonNegative);
}

enum class RateSource { kExact, kDifferenced, kDifferencedFromRestLength };

using Points = std::vector<std::pair<double, double>>;

/// A number (held for ever) or points.
Points ReadCourse(const Value& value, const std::string& what, Bound bound, const Scope& scope) {
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
  bool relative = false;  ///< To the cable's rest length as described.
  SourceRef at;
};

/// One complaint a course: the other cables would only repeat it.
PositionProgram ProgramFor(const RobotSpec& robot, int cable, const Course& course,
                           std::set<std::pair<int, int>>& reported, const Scope& scope) {
  PositionProgram program{cable, course.points};
  if (!course.relative) return program;
  const CableDef& def = robot.def.cables[static_cast<std::size_t>(cable)];
  for (auto& [time_s, length_m] : program.rest_length_m) {
    const double change_m = length_m;
    length_m += def.rest_length_m;
    if (!(length_m <= 0.0) || !reported.insert({course.at.line, course.at.column}).second) continue;
    scope.out.Error(course.at,
                    "programs.change_m: a change of " + Shown(change_m) +
                        " m at t = " + Shown(time_s) + " s leaves " + def.name + " no rest length",
                    "it is " + Shown(def.rest_length_m) + " m as described");
  }
  return program;
}

/// Which cables a controller drives.
std::vector<int> DrivenCables(const ControllerSpec& controller) {
  std::vector<int> cables;
  if (controller.impedance) {
    for (const ImpedanceGains& gains : controller.impedance->cables) cables.push_back(gains.cable);
  }
  for (const PositionProgram& program : controller.position) cables.push_back(program.cable);
  return cables;
}

/// One line for all cables that a controller cannot drive, for the same reason.
void CheckDriven(const std::vector<ControllerSpec>& controllers,
                 const std::vector<SourceRef>& places, const RobotSpec& robot, bool actuators_known,
                 const Scope& scope) {
  std::map<int, std::size_t> driver;
  for (std::size_t i = 0; i < controllers.size(); ++i) {
    std::vector<int> no_actuator;
    std::map<std::size_t, std::vector<int>> taken;
    for (const int cable : DrivenCables(controllers[i])) {
      const CableDef& def = robot.def.cables[static_cast<std::size_t>(cable)];
      if (def.actuator.kind == ActuatorDef::Kind::kNone) no_actuator.push_back(cable);
      const auto [place, fresh] = driver.emplace(cable, i);
      if (!fresh) taken[place->second].push_back(cable);
    }
    if (!no_actuator.empty() && actuators_known) {
      scope.out.Error(places[i],
                      "controller " + controllers[i].name + " drives " +
                          CableNames(robot, no_actuator) + ", which has no actuator",
                      "give the cable's builder in the model an `actuator:`");
    }
    for (const auto& [other, cables] : taken) {
      scope.out.Error(places[i],
                      "controller " + controllers[i].name + " drives " + CableNames(robot, cables) +
                          ", which controller " + controllers[other].name + " drives already",
                      "a cable obeys one controller");
    }
  }
}

}  // namespace

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
  std::sort(words.begin(), words.end());
  words.erase(std::unique(words.begin(), words.end()), words.end());
  std::string hint = words.empty() ? "the robot has no cables" : "no cable has all of these tags";
  for (const auto& set : match) {
    for (const std::string& word : set) {
      if (words.empty() || std::binary_search(words.begin(), words.end(), word)) continue;
      hint = "no cable is called or tagged \"" + word + "\"; " + DidYouMean(word, words);
    }
  }
  scope.out.Error(value.at, std::string(what) + ": no cable matches " + Written(value), hint);
  return cables;
}

std::vector<std::pair<double, double>> ReadPoints(const Value& value, std::string_view what,
                                                  Bound bound, const Scope& scope) {
  Points points;
  if (value.kind != Value::Kind::kSequence || value.items.empty()) {
    scope.out.Error(value.at, std::string(what) + " must be a list of [time_s, value]",
                    "such as [[0, 1], [5, 2]]");
    return points;
  }
  bool good = true;
  double before = -1.0;
  for (const ValuePtr& item : value.items) {
    if (item->kind != Value::Kind::kSequence || item->items.size() != 2) {
      scope.out.Error(item->at, std::string(what) + ": a point must be [time_s, value]");
      good = false;
      continue;
    }
    const double time_s =
        ReadNumber(*item->items[0], std::string(what) + ": time_s", Bound::kNonNegative, scope);
    const double number = ReadNumber(*item->items[1], what, bound, scope);
    if (time_s <= before) {
      scope.out.Error(item->items[0]->at, std::string(what) + ": times must rise, but " +
                                              Shown(time_s) + " s follows " + Shown(before) + " s");
      good = false;
    }
    good = good && !std::isnan(time_s) && !std::isnan(number);
    if (!std::isnan(time_s)) before = time_s;
    points.emplace_back(time_s, number);
  }
  return good ? points : Points();
}

ImpedanceSpec ReadImpedance(const Value& value, const RobotSpec* robot, const Scope& scope) {
  const MapReader map(value, "impedance", {"conversion", "pid", "rate", "gains", "set_points"},
                      scope);
  ImpedanceSpec out;
  out.conversion = map.ChoiceOr<TensionConversion>(
      "conversion", TensionConversion::kStiffness,
      {{"stiffness", TensionConversion::kStiffness}, {"pid", TensionConversion::kPid}});
  ReadPid(map, out);
  const auto rate = map.ChoiceOr<RateSource>(
      "rate", RateSource::kExact,
      {{"exact", RateSource::kExact},
       {"differenced", RateSource::kDifferenced},
       {"differenced_from_rest_length", RateSource::kDifferencedFromRestLength}});
  out.differenced_rate = rate != RateSource::kExact;
  out.start_from_rest_length = rate == RateSource::kDifferencedFromRestLength;

  PerCable<Gains> gains(robot, "gains", scope);
  const Value* gains_list = map.Require("gains");
  if (!gains_list || gains_list->kind != Value::Kind::kSequence) gains.SetIncomplete();
  for (const ValuePtr& item : Items(gains_list, "impedance.gains", scope)) {
    const MapReader entry(*item, "gains",
                          {"cables", "position_gain_n_per_m", "velocity_gain_n_s_per_m"}, scope);
    const Gains read{entry.Number("position_gain_n_per_m", Bound::kNonNegative),
                     entry.Number("velocity_gain_n_s_per_m", Bound::kNonNegative)};
    gains.Add(entry.Require("cables"), entry.Path("cables"), read);
  }
  PerCable<SetPoint> set_points(robot, "set points", scope);
  const Value* set_points_list = map.Require("set_points");
  if (!set_points_list || set_points_list->kind != Value::Kind::kSequence)
    set_points.SetIncomplete();
  for (const ValuePtr& item : Items(set_points_list, "impedance.set_points", scope)) {
    const MapReader entry(*item, "set_points",
                          {"cables", "tension_n", "length_m", "velocity_m_per_s"}, scope);
    const SetPoint read{entry.Number("tension_n", Bound::kNonNegative),
                        entry.Number("length_m", Bound::kNonNegative),
                        entry.NumberOr("velocity_m_per_s", 0.0, Bound::kAny)};
    set_points.Add(entry.Require("cables"), entry.Path("cables"), read);
  }
  set_points.Require(gains, "add a selector to `gains`");
  gains.Require(set_points, "add a selector to `set_points`, or narrow this one");
  for (const int cable : set_points.cables()) {
    const Gains* gain = gains.Find(cable);
    if (!gain) continue;
    const SetPoint& set_point = *set_points.Find(cable);
    out.cables.push_back({cable, set_point.tension_n, set_point.length_m, gain->position_n_per_m,
                          gain->velocity_n_s_per_m, set_point.velocity_m_per_s});
  }
  return out;
}

std::vector<PositionProgram> ReadPosition(const Value& value, const RobotSpec* robot,
                                          const Scope& scope) {
  const MapReader map(value, "position", {"programs"}, scope);
  PerCable<Course> courses(robot, "programs", scope);
  for (const ValuePtr& item : Items(map.Require("programs"), "position.programs", scope)) {
    const MapReader entry(*item, "programs", {"cables", "rest_length_m", "change_m"}, scope);
    const std::string key = entry.ExactlyOne({"rest_length_m", "change_m"});
    Course course;
    if (!key.empty()) {
      const Value& found = *entry.Find(key);
      course.relative = key == "change_m";
      course.at = found.at;
      course.points = ReadCourse(found, entry.Path(key),
                                 course.relative ? Bound::kAny : Bound::kPositive, scope);
    }
    courses.Add(entry.Require("cables"), entry.Path("cables"), course);
  }
  std::vector<PositionProgram> programs;
  std::set<std::pair<int, int>> reported;
  for (const int cable : courses.cables()) {
    programs.push_back(ProgramFor(*robot, cable, *courses.Find(cable), reported, scope));
  }
  return programs;
}

std::vector<ControllerSpec> ReadControllers(const Value* list, const RobotSpec* robot,
                                            bool actuators_known, const Scope& scope) {
  std::vector<ControllerSpec> controllers;
  std::vector<SourceRef> places;
  std::map<std::string, SourceRef> names;
  for (const ValuePtr& item : Items(list, "controllers", scope)) {
    const MapReader map(*item, "controller",
                        {"name", "period_s", "phase_s", "impedance", "position", "velocity_input"},
                        scope);
    ControllerSpec controller;
    controller.name = map.Name("name");
    controller.clock.period_s =
        map.NumberOr("period_s", controller.clock.period_s, Bound::kPositive);
    controller.clock.phase_s = map.NumberOr("phase_s", 0.0, Bound::kNonNegative);
    const std::string kind = map.ExactlyOne({"impedance", "position"});
    if (kind == "impedance") {
      controller.impedance = ReadImpedance(*map.Find(kind), robot, scope);
    } else if (kind == "position") {
      controller.position = ReadPosition(*map.Find(kind), robot, scope);
    }
    if (const Value* input = map.Find("velocity_input")) {
      controller.velocity_input = ReadVelocityInput(*input, scope);
      if (kind == "position") {
        map.Error("velocity_input", "velocity_input has no effect with position",
                  "it is the V0 of `impedance`");
      } else if (robot && controller.velocity_input && controller.impedance) {
        CheckGaitDrives(controller, *robot, input->at, scope.out);
      }
    }
    if (!controller.name.empty()) {
      const auto [first, fresh] = names.emplace(controller.name, map.KeyAt("name"));
      if (!fresh) {
        map.Error("name", "there are two controllers " + controller.name,
                  "the first is in line " + std::to_string(first->second.line));
      }
    }
    controllers.push_back(std::move(controller));
    places.push_back(map.KeyAt("name"));
  }
  if (robot) CheckDriven(controllers, places, *robot, actuators_known, scope);
  return controllers;
}

}  // namespace taut::description
