/// The parts of an experiment file, each read by one function. `robot` is null where the model
/// could not be read: then nothing that refers to it is checked, everything else is.
#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "description/laws.h"
#include "description/reader.h"
#include "taut/spec.h"

namespace taut::description {

inline const Choices<ReferenceSpec::Quantity> kReferenceQuantities{
    {"tension", ReferenceSpec::Quantity::kTension}, {"elastic", ReferenceSpec::Quantity::kElastic}};
inline const Choices<ReferenceSpec::Statistic> kReferenceStatistics{
    {"max", ReferenceSpec::Statistic::kMax},
    {"mean", ReferenceSpec::Statistic::kMean},
    {"min", ReferenceSpec::Statistic::kMin}};

/// The cables that a selector stands for, ascending. Empty, and a complaint unless the robot is
/// unknown, if there are none.
std::vector<int> SelectCables(const Value& value, std::string_view what, const RobotSpec* robot,
                              const Scope& scope);

/// [[time_s, value], ...] with rising times. Empty after a complaint.
std::vector<std::pair<double, double>> ReadPoints(const Value& value, std::string_view what,
                                                  Bound bound, const Scope& scope);

/// `actuators_known`: false if the model has errors, so that an actuator may just be misspelt.
std::vector<ControllerSpec> ReadControllers(const Value* list, const RobotSpec* robot,
                                            bool actuators_known, const Scope& scope);

ImpedanceSpec ReadImpedance(const Value& value, const RobotSpec* robot, const Scope& scope);
std::vector<PositionProgram> ReadPosition(const Value& value, const RobotSpec* robot,
                                          const Scope& scope);

/// The gait of `value` on its clock, its file read; no gait after a complaint.
std::optional<VelocityInputSpec> ReadVelocityInput(const Value& value, const Scope& scope);

/// Complains unless the gait's cables are in the robot and driven by the controller's impedance.
void CheckGaitDrives(const ControllerSpec& controller, const RobotSpec& robot, const SourceRef& at,
                     Diagnostics& out);

/// Phases and events, into `out`, which has its duration already (NaN if that is unknown).
void ReadTimeline(const Value& value, const RobotSpec* robot, const Scope& scope,
                  ExperimentSpec& out);

/// Numbers of others. `phases`: those of the timeline.
std::vector<ReferenceSpec> ReadReferences(const Value* list, const RobotSpec* robot,
                                          const std::vector<PhaseSpec>& phases, const Scope& scope);
/// Factors on friction, masses, stiffnesses and dampings.
std::vector<ScaleSpec> ReadScales(const Value* list, const RobotSpec* robot, const Scope& scope);
StartNoise ReadStartNoise(const Value& value, const Scope& scope);
SensorSpec ReadSensors(const Value& value, const Scope& scope);

/// Planes and boxes, appended to what `robot` has.
void ReadTerrain(const Value* list, const Scope& scope, RobotSpec& robot);

/// Moves the robot in `def` (but not the terrain) and gives it a velocity. `start` is for the
/// complaint about velocities that settling would take away.
void ReadPlace(const Value& value, StartKind start, const Scope& scope, ModelDef& def);

}  // namespace taut::description
