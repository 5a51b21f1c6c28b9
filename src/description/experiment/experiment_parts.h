/// Conversion of the contents of an experiment file to an `ExperimentSpec`. If the model could not
/// be read, `robot` is null, and references to the robot are not checked.
#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "description/experiment/experiment_text.h"
#include "description/yaml/reader.h"
#include "taut/spec.h"

namespace taut::description {

/// Returns the cables that match a selector, in ascending order. Reports an error if none matches
/// and the robot is known.
std::vector<int> SelectCables(const Value& value, std::string_view what, const RobotSpec* robot,
                              const Scope& scope);

/// Returns the names of cables for a message, separated by commas.
std::string CableNames(const RobotSpec& robot, const std::vector<int>& cables);

/// Returns a selector in the notation of the file format: [inner, top].
std::string Written(const Value& selector);
/// Returns the hint for a selector that matches no `kind` ("cable"). The hint names the tag of the
/// selector that is not in `words`, the existing tags.
std::string UnknownWord(const std::vector<std::vector<std::string>>& match,
                        std::vector<std::string> words, const std::string& kind);

/// Converts load cases. Reports unknown names, and temperatures of members without an expansion
/// coefficient.
std::vector<LoadCaseSpec> ToLoadCases(const std::vector<LoadCaseText>& texts,
                                      const std::vector<LoadCombinationText>& combinations,
                                      const RobotSpec* robot, const Scope& scope);

/// Converts controllers. `actuators_known`: false if the model has errors, so that actuators may be
/// missing.
std::vector<ControllerSpec> ToControllers(std::vector<ControllerText>& texts,
                                          const RobotSpec* robot, bool actuators_known,
                                          const Scope& scope);

/// Adds the motor boards as the last controller. Reports cables that boards cannot drive.
void AddBoards(const BoardsText& boards, const RobotSpec* robot, const Scope& scope,
               ExperimentSpec& experiment);

ImpedanceSpec ToImpedance(const ImpedanceText& text, const RobotSpec* robot, const Scope& scope);
std::vector<PositionProgram> ToPrograms(const PositionText& text, const RobotSpec* robot,
                                        const Scope& scope);

/// Kind of gait input: its key, and the quantity that its gaits drive.
struct GaitInputKind {
  const char* key;
  GaitDrives drives;
};
inline constexpr GaitInputKind kVelocityInput{"velocity_input", GaitDrives::kVelocity};
inline constexpr GaitInputKind kRestLengthInput{"rest_length_input", GaitDrives::kRestLength};

/// Reads each gait file once and checks it with `CheckGaits`. Returns nothing after any error.
/// `cables` receives the cables that the gaits drive, if known.
std::optional<GaitInputSpec> ToGaitInput(const GaitInputText& text, const GaitInputKind& kind,
                                         const RobotSpec* robot, const Scope& scope,
                                         std::vector<int>& cables);

/// Checks that all gaits of an input drive the right quantity and the same cables of the robot.
/// Returns these cables. `places`: file positions of the gaits.
std::vector<int> CheckGaits(const GaitInputSpec& input, const GaitInputKind& kind,
                            const std::vector<SourceRef>& places, const RobotSpec* robot,
                            Diagnostics& out);

/// Reports cables that a gait drives, but for which the controller has no impedance.
void CheckGaitDrives(const ControllerSpec& controller, const std::vector<int>& cables,
                     const RobotSpec& robot, const SourceRef& at, Diagnostics& out);

/// Adds kinematic bodies to the robot: bodies of the model, or boxes of the terrain. Call
/// `AddTerrain` first.
void AddMotions(const std::vector<MotionText>& texts, bool robot_known, const Scope& scope,
                RobotSpec& robot);

/// Reports motions that leave the permitted range during the experiment. Warns of motions that are
/// too fast for the time step.
void CheckMotions(const std::vector<MotionText>& texts, const ExperimentSpec& experiment,
                  const Scope& scope);

/// Adds phases and events to `out`, whose duration is already set (NaN if unknown).
void AddTimeline(const TimelineText& text, const RobotSpec* robot, const Scope& scope,
                 ExperimentSpec& out);

/// Converts reference values from other sources. `phases`: phases of the timeline.
std::vector<ReferenceSpec> ToReferences(const std::vector<ReferenceText>& texts,
                                        const RobotSpec* robot,
                                        const std::vector<PhaseSpec>& phases, const Scope& scope);
/// Converts factors on friction, masses, stiffnesses and dampings.
std::vector<ScaleSpec> ToScales(const std::vector<ScaleText>& texts, const RobotSpec* robot,
                                const Scope& scope);

/// Converts the goal. Returns nothing after an error.
std::optional<GoalSpec> ToGoal(const GoalText& text, const RobotSpec* robot, const Scope& scope);
/// Reports gaits that need a goal if the experiment has none.
void CheckGoalIsSensed(const ExperimentSpec& experiment, Diagnostics& out);

/// Converts the environment of reinforcement learning. All other fields of `experiment` must be
/// complete. `drivers_known`: false if the model or its controllers have errors, so that the driver
/// of a cable may be unknown.
EnvironmentSpec ToEnvironment(const EnvironmentText& text, const Value& block,
                              const RobotSpec* robot, bool drivers_known,
                              const ExperimentSpec& experiment, const Scope& scope);

/// Appends planes, boxes, stairs, scattered blocks, height fields and meshes to `robot`.
void AddTerrain(const std::vector<TerrainText>& texts, const Scope& scope, RobotSpec& robot);

/// Moves the robot (but not the terrain) and sets its velocity. `start`: reports an error if
/// settling would reset this velocity.
void Place(const PlaceText& place, StartKind start, const Scope& scope, RobotSpec& robot);

}  // namespace taut::description
