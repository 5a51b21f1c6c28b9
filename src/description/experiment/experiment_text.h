/// Contents of an experiment file after parsing. References to the robot are resolved later, after
/// the model has been loaded.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "description/experiment/ground_keys.h"
#include "description/experiment/motion_keys.h"
#include "description/experiment/terrain_boxes.h"
#include "description/gait/gait_keys.h"
#include "description/model/model_text.h"
#include "description/model/surface_keys.h"
#include "description/yaml/head_keys.h"
#include "taut/spec.h"

namespace taut::description {

struct SelectorForm {
  static constexpr const char* kSchema = R"("$ref": "#/$defs/selector")";
};
struct PatternsForm {
  static constexpr const char* kSchema = R"("$ref": "#/$defs/patterns")";
};
struct SpanForm {
  static constexpr const char* kSchema =
      R"("type": "array", "title": "[from, to]", "items": {"$ref": "#/$defs/number"}, )"
      R"("minItems": 2, "maxItems": 2)";
};
/// Constant, or points over time.
struct CourseForm {
  static constexpr const char* kSchema =
      R"("title": "number or [[time_s, value], ...]", )"
      R"("oneOf": [{"$ref": "#/$defs/number"}, {"$ref": "#/$defs/points"}])";
};

// terrain and place

struct PlaneText : PlaneDef {
  std::optional<double> height_m, slope_rad;
  std::optional<Vec3> slope_direction;  ///< Unit vector.
  SurfaceText surface;
};
struct TerrainBoxText : TerrainBoxDef {
  Vec3 size_m;
  SurfaceText surface;
};
struct TerrainText {
  std::string name;
  SourceRef at, name_at, name_key_at;
  std::optional<PlaneText> plane;
  std::optional<TerrainBoxText> box;
  std::optional<ScatterText> scatter;
  std::optional<StairsText> stairs;
  std::optional<HeightFieldText> height_field;
  std::optional<TerrainMeshText> mesh;
};
struct PlaceText {
  SourceRef at;
  Vec3 at_m;
  Quat rotate;
  Vec3 velocity_m_per_s, angular_velocity_rad_per_s;
  SourceRef velocity_at, angular_velocity_at;  ///< Positions of the keys in the file; line 0 if
                                               ///< absent.
  bool moved = false;
};

// controllers

struct GainsText {
  Raw<SelectorForm> cables;
  double position_gain_n_per_m = 0.0, velocity_gain_n_s_per_m = 0.0;
};
struct SetPointText {
  Raw<SelectorForm> cables;
  double tension_n = 0.0, length_m = 0.0, velocity_m_per_s = 0.0;
};
enum class RateSource { kExact, kDifferenced, kDifferencedFromRestLength };
struct ImpedanceText : ImpedanceSpec {
  std::optional<PidGains> pid_text;
  RateSource rate = RateSource::kExact;
  std::vector<GainsText> gains;
  std::vector<SetPointText> set_points;
  bool gains_complete = true, set_points_complete = true;  ///< False: the value is not a list.
};
struct ProgramText {
  Raw<SelectorForm> cables;
  Raw<CourseForm> rest_length_m, change_m;
};
struct PositionText {
  std::vector<ProgramText> programs;
};
struct FilesForm {
  static constexpr const char* kSchema = R"("type": "array", "items": {"type": "string"})";
};
struct GaitChangeText {
  double at_s = 0.0;
  Raw<FileForm> gait_file;
  SourceRef at;
};
struct GaitInputText : GaitInputSpec {
  Raw<FileForm> gait_file;
  Raw<FilesForm> more_gaits;
  std::vector<GaitChangeText> change_texts;
  SourceRef at;
};
struct VelocityInputText : GaitInputText {};
struct RestLengthInputText : GaitInputText {};
struct ControllerText : ControllerSpec {
  std::optional<ImpedanceText> impedance_text;
  std::optional<PositionText> position_text;
  std::optional<VelocityInputText> velocity_input_text;
  std::optional<RestLengthInputText> rest_length_input_text;
  SourceRef name_at;  ///< Position of the key.
};

struct BoardsText : BoardsSpec {
  SourceRef at, capture_at;  ///< Positions in the file.
};

// timeline

struct PushText : PushSpec {
  Placed node_name;
};
struct DragText : DragSpec {
  Placed node_name;
};
struct EventText {
  std::optional<PushText> push;
  std::optional<DragText> drag;
  SourceRef name_at;
};
struct GoalText : GoalSpec {
  Placed body_name;
};
struct TimelineText {
  Named<Raw<SpanForm>> phases;
  std::vector<EventText> events;
};

// sensors and scale factors

struct LoadCellText : LoadCellSpec {
  std::pair<double, double> range_n{0.0, std::numeric_limits<double>::infinity()};
  std::optional<int> bits;
};
struct EncoderText : EncoderSpec {
  std::optional<double> counts_per_turn, spool_radius_m;
  std::optional<int> lines;
  int decoding = 4;
  double gear_ratio = 1.0;
  bool index = false;
};
struct SensorText : SensorSpec {
  std::optional<LoadCellText> load_cell_text;
  std::optional<EncoderText> encoder_text;
};
struct ScaleText {
  std::optional<double> friction, mass, stiffness, damping;
  Raw<PatternsForm> bodies;
  Raw<SelectorForm> cables;
  ScaleSpec::Quantity quantity = ScaleSpec::Quantity::kFriction;
  double factor = 1.0;
};
struct RecordText : RecordSpec {
  std::vector<Placed> channel_texts;
};
struct ReferenceText : ReferenceSpec {
  Placed phase_text;
  Named<double> cables_n;
};

// load cases

struct NodeForceText : LoadCaseSpec::NodeForce {
  Placed node_name;
  Raw<SelectorForm> nodes;
  SourceRef at;
};
struct LineLoadText {
  Raw<SelectorForm> members;
  Vec3 force_n_per_m;
  SourceRef at;
};
struct AreaLoadText {
  Raw<SelectorForm> members, nodes;  ///< One of both.
  double pressure_pa = 0.0;
  Vec3 direction;  ///< Unit vector.
  bool projected = false;
  SourceRef at;
};
struct SettlementText : LoadCaseSpec::Settlement {
  Placed support;
};
struct RestLengthText {
  Raw<SelectorForm> members;
  std::optional<double> by_m, by_ratio;
  SourceRef at;
};
struct TemperatureText {
  Raw<SelectorForm> members;
  double by_k = 0.0;
  SourceRef at;
};
struct LoadCaseText {
  Placed name;
  bool weight = true;
  double weight_factor = 1.0;
  std::vector<NodeForceText> forces;
  std::vector<SettlementText> settlements;
  std::vector<RestLengthText> rest_lengths;
  std::vector<TemperatureText> temperatures;
  std::vector<LineLoadText> lines;
  std::vector<AreaLoadText> areas;
  std::optional<double> max_displacement_m;
};
/// Sum of load cases with partial factors.
struct LoadCombinationText {
  Placed name;
  Named<double> factors;
  std::optional<double> max_displacement_m;
};

// reinforcement learning

struct EnvironmentActionText : EnvironmentAction {
  Raw<SelectorForm> cables;
  Raw<PatternsForm> each, all;
  SourceRef name_at;  ///< Position of the key.
};
struct EnvironmentText : EnvironmentSpec {
  std::vector<EnvironmentActionText> action_texts;
  std::vector<Placed> observation_texts;
};

struct ExperimentForm {
  static constexpr const char* kSchema = R"("const": "experiment")";
};
struct ExperimentText : ExperimentSpec {
  Head<ExperimentForm> head;
  Raw<FileForm> model;
  Raw<ParametersForm> set;
  Overlay<ModelOptions> model_options;
  std::optional<Vec3> gravity_m_per_s2;
  std::vector<TerrainText> terrain;
  std::vector<MotionText> motions;
  std::optional<PlaceText> place;
  std::vector<ScaleText> scale_texts;
  std::optional<GoalText> goal_text;
  std::optional<SensorText> sensor_text;
  std::vector<ControllerText> controller_texts;
  std::optional<BoardsText> boards_text;
  TimelineText timeline;
  RecordText record_text;
  Raw<FileForm> compare_file;
  std::vector<ReferenceText> reference_texts;
  std::vector<LoadCaseText> load_case_texts;
  std::vector<LoadCombinationText> load_combinations;
  std::optional<EnvironmentText> environment_text;
};

}  // namespace taut::description
