/// From what an experiment file says to what is done. `robot` is null where the model
/// could not be read: then nothing that refers to it is checked, everything else is.
#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "description/experiment/experiment_text.h"
#include "description/yaml/reader.h"
#include "taut/spec.h"

namespace taut::description {

/// The cables that a selector stands for, ascending. Empty, and a complaint unless the robot is
/// unknown, if there are none.
std::vector<int> SelectCables(const Value& value, std::string_view what, const RobotSpec* robot,
                              const Scope& scope);

/// A selector as a user would write it: [inner, top].
std::string Written(const Value& selector);
/// The hint for a selector that matches no `kind` ("cable"), whose tags are `words`: the word that
/// none of them has.
std::string UnknownWord(const std::vector<std::vector<std::string>>& match,
                        std::vector<std::string> words, const std::string& kind);

/// Complains about names that are not there, and about members that nobody knows to expand.
std::vector<LoadCaseSpec> ToLoadCases(const std::vector<LoadCaseText>& texts,
                                      const RobotSpec* robot, const Scope& scope);

/// `actuators_known`: false if the model has errors, so that an actuator may just be misspelt.
std::vector<ControllerSpec> ToControllers(std::vector<ControllerText>& texts,
                                          const RobotSpec* robot, bool actuators_known,
                                          const Scope& scope);

ImpedanceSpec ToImpedance(const ImpedanceText& text, const RobotSpec* robot, const Scope& scope);
std::vector<PositionProgram> ToPrograms(const PositionText& text, const RobotSpec* robot,
                                        const Scope& scope);

/// What a gait may be the input of.
struct GaitInputKind {
  const char* key;
  GaitDrives drives;
};
inline constexpr GaitInputKind kVelocityInput{"velocity_input", GaitDrives::kVelocity};
inline constexpr GaitInputKind kRestLengthInput{"rest_length_input", GaitDrives::kRestLength};

/// Reads the gaits' files, each once, and checks them as `CheckGaits`. Nothing if there was any
/// error. `cables`: that the gaits move, if that is known.
std::optional<GaitInputSpec> ToGaitInput(const GaitInputText& text, const GaitInputKind& kind,
                                         const RobotSpec* robot, const Scope& scope,
                                         std::vector<int>& cables);

/// Complains unless the gaits of an input drive what they are to drive, all of them the same cables
/// of the robot, which are returned. `places`: of the first gait and of the others.
std::vector<int> CheckGaits(const GaitInputSpec& input, const GaitInputKind& kind,
                            const std::vector<SourceRef>& places, const RobotSpec* robot,
                            Diagnostics& out);

/// Complains about cables that a gait moves and the controller's impedance does not.
void CheckGaitDrives(const ControllerSpec& controller, const std::vector<int>& cables,
                     const RobotSpec& robot, const SourceRef& at, Diagnostics& out);

/// What programs move, of the robot or the terrain, which must be there.
void AddMotions(const std::vector<MotionText>& texts, bool robot_known, const Scope& scope,
                RobotSpec& robot);

/// Complains about motions that go too far in the time of the experiment, warns of those that are
/// too fast for its steps.
void CheckMotions(const std::vector<MotionText>& texts, const ExperimentSpec& experiment,
                  const Scope& scope);

/// Phases and events, into `out`, which has its duration already (NaN if that is unknown).
void AddTimeline(const TimelineText& text, const RobotSpec* robot, const Scope& scope,
                 ExperimentSpec& out);

/// Numbers of others. `phases`: those of the timeline.
std::vector<ReferenceSpec> ToReferences(const std::vector<ReferenceText>& texts,
                                        const RobotSpec* robot,
                                        const std::vector<PhaseSpec>& phases, const Scope& scope);
/// Factors on friction, masses, stiffnesses and dampings.
std::vector<ScaleSpec> ToScales(const std::vector<ScaleText>& texts, const RobotSpec* robot,
                                const Scope& scope);

/// Where the robot is to go. Nothing after a complaint.
std::optional<GoalSpec> ToGoal(const GoalText& text, const RobotSpec* robot, const Scope& scope);
/// Complains about gaits that hear of a goal where there is none.
void CheckGoalIsSensed(const ExperimentSpec& experiment, Diagnostics& out);

/// What learners may do and see. `experiment` has everything else already; `drivers_known`: false
/// if the model or its controllers have errors, so that what drives a cable may just be misspelt.
EnvironmentSpec ToEnvironment(const EnvironmentText& text, const Value& block,
                              const RobotSpec* robot, bool drivers_known,
                              const ExperimentSpec& experiment, const Scope& scope);

/// Planes and boxes, stairs and scattered blocks, appended to what `robot` has.
void AddTerrain(const std::vector<TerrainText>& texts, const Scope& scope, RobotSpec& robot);

/// Moves the robot (but not the terrain) and gives it a velocity. `start` is for the
/// complaint about velocities that settling would take away.
void Place(const PlaceText& place, StartKind start, const Scope& scope, RobotSpec& robot);

}  // namespace taut::description
