/// Conversion of the contents of an experiment file to the experiment. `robot` is null if the model
/// could not be read: then references to the robot are not checked, but everything else is.
#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "description/experiment/experiment_text.h"
#include "description/yaml/reader.h"
#include "taut/spec.h"

namespace taut::description {

/// Returns the cables of a selector, ascending. If there are none, returns an empty list and,
/// unless the robot is unknown, reports an error.
std::vector<int> SelectCables(const Value& value, std::string_view what, const RobotSpec* robot,
                              const Scope& scope);

/// Returns a selector as users write it: [inner, top].
std::string Written(const Value& selector);
/// Returns the hint for a selector that matches no `kind` ("cable"); `words` are the existing tags.
/// The hint contains the word that none of them has.
std::string UnknownWord(const std::vector<std::vector<std::string>>& match,
                        std::vector<std::string> words, const std::string& kind);

/// Converts load cases. Reports unknown names, and temperatures of members without an expansion
/// coefficient.
std::vector<LoadCaseSpec> ToLoadCases(const std::vector<LoadCaseText>& texts,
                                      const RobotSpec* robot, const Scope& scope);

/// Converts controllers. `actuators_known`: false if the model has errors, which may hide an
/// actuator.
std::vector<ControllerSpec> ToControllers(std::vector<ControllerText>& texts,
                                          const RobotSpec* robot, bool actuators_known,
                                          const Scope& scope);

ImpedanceSpec ToImpedance(const ImpedanceText& text, const RobotSpec* robot, const Scope& scope);
std::vector<PositionProgram> ToPrograms(const PositionText& text, const RobotSpec* robot,
                                        const Scope& scope);

/// Kind of gait input: its key and the quantity that its gaits must drive.
struct GaitInputKind {
  const char* key;
  GaitDrives drives;
};
inline constexpr GaitInputKind kVelocityInput{"velocity_input", GaitDrives::kVelocity};
inline constexpr GaitInputKind kRestLengthInput{"rest_length_input", GaitDrives::kRestLength};

/// Reads the gait files, each once, and checks them with `CheckGaits`. Returns nothing after any
/// error. `cables`: the cables that the gaits drive, if known.
std::optional<GaitInputSpec> ToGaitInput(const GaitInputText& text, const GaitInputKind& kind,
                                         const RobotSpec* robot, const Scope& scope,
                                         std::vector<int>& cables);

/// Checks that the gaits of an input drive the right quantity and all the same cables of the robot,
/// and returns these cables. `places`: of the first gait and of the others.
std::vector<int> CheckGaits(const GaitInputSpec& input, const GaitInputKind& kind,
                            const std::vector<SourceRef>& places, const RobotSpec* robot,
                            Diagnostics& out);

/// Reports cables that a gait drives without an impedance of the controller.
void CheckGaitDrives(const ControllerSpec& controller, const std::vector<int>& cables,
                     const RobotSpec& robot, const SourceRef& at, Diagnostics& out);

/// Adds kinematic bodies to the robot: bodies of the robot, or boxes of the terrain, which must
/// exist already.
void AddMotions(const std::vector<MotionText>& texts, bool robot_known, const Scope& scope,
                RobotSpec& robot);

/// Reports motions that go too far during the experiment; warns of motions too fast for its steps.
void CheckMotions(const std::vector<MotionText>& texts, const ExperimentSpec& experiment,
                  const Scope& scope);

/// Adds phases and events to `out`, whose duration is already set (NaN if unknown).
void AddTimeline(const TimelineText& text, const RobotSpec* robot, const Scope& scope,
                 ExperimentSpec& out);

/// Converts reference values from other sources. `phases`: of the timeline.
std::vector<ReferenceSpec> ToReferences(const std::vector<ReferenceText>& texts,
                                        const RobotSpec* robot,
                                        const std::vector<PhaseSpec>& phases, const Scope& scope);
/// Converts factors on friction, masses, stiffnesses and dampings.
std::vector<ScaleSpec> ToScales(const std::vector<ScaleText>& texts, const RobotSpec* robot,
                                const Scope& scope);

/// Converts the goal. Returns nothing after an error.
std::optional<GoalSpec> ToGoal(const GoalText& text, const RobotSpec* robot, const Scope& scope);
/// Reports gaits that need a goal in an experiment without one.
void CheckGoalIsSensed(const ExperimentSpec& experiment, Diagnostics& out);

/// Converts the environment of reinforcement learning. `experiment` is otherwise complete;
/// `drivers_known`: false if the model or its controllers have errors, which may hide the driver of
/// a cable.
EnvironmentSpec ToEnvironment(const EnvironmentText& text, const Value& block,
                              const RobotSpec* robot, bool drivers_known,
                              const ExperimentSpec& experiment, const Scope& scope);

/// Appends planes, boxes, stairs, scattered blocks, height fields and meshes to `robot`.
void AddTerrain(const std::vector<TerrainText>& texts, const Scope& scope, RobotSpec& robot);

/// Moves the robot (but not the terrain) and sets its velocity. `start`: for the error about
/// velocities that settling would reset.
void Place(const PlaceText& place, StartKind start, const Scope& scope, RobotSpec& robot);

}  // namespace taut::description
