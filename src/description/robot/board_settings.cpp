#include "description/robot/board_settings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace taut {

int LoadCellCode(const BoardLoadCell& cell, double force_n, double noise) noexcept {
  const double counts =
      cell.counts_at_zero + force_n / cell.n_per_count + noise * cell.noise_counts;
  // The first code begins half a count above zero (data sheet, "ADC Accuracy Definitions").
  const double code = std::floor(std::min(counts, cell.saturation_counts) + 0.5);
  return static_cast<int>(std::clamp(code, 0.0, 1023.0));
}

namespace description {

MotorSettings CommonMotorSettings(const BoardsSpec& boards) {
  return {{board::kForceP, boards.force_p_per_n},
          {board::kForceI, boards.force_i_per_n_s},
          {board::kForceD, boards.force_d_s_per_n},
          {board::kLengthP, boards.length_p_per_m},
          {board::kLengthI, boards.length_i_per_m_s},
          {board::kLengthD, boards.length_d_s_per_m},
          {board::kNewtonsPerCount, boards.load_cell.n_per_count},
          {board::kCountsAtZero, boards.load_cell.counts_at_zero},
          {board::kTensionShare, boards.tension_filter_share},
          {board::kRateShare, boards.rate_filter_share},
          {board::kWindingCounts, boards.winding_counts_per_count},
          {board::kTensionLimit, boards.tension_limit_n},
          {board::kTensionBand, boards.tension_band_n},
          {board::kDutyLimit, boards.duty_limit},
          {board::kSlackWay, boards.slack_way_m},
          {board::kStallDuty, boards.stall_duty}};
}

std::vector<BoardSetting<board::BoardParameter>> CommonBoardSettings(const BoardsSpec& boards) {
  return {{board::kSupply, boards.supply_v},
          {board::kResistance, boards.winding_ohm},
          {board::kBackEmf, boards.back_emf_v_s_per_m},
          {board::kTemperatureLimit, boards.winding_limit_c}};
}

double LengthPerCount(const DcMotorDef& motor, int encoder_lines) {
  const double counts_per_rad = 2 * encoder_lines / (2 * std::numbers::pi);
  return motor.spool_radius_m / motor.gear_ratio / counts_per_rad;
}

MotorSettings SettingsOf(const CableDef& cable, int encoder_lines) {
  MotorSettings settings{{board::kReferenceLength, cable.rest_length_m},
                         {board::kStiffness, cable.stiffness_n_per_m}};
  if (!cable.actuator.dc_motor) return settings;
  const DcMotorDef& motor = *cable.actuator.dc_motor;
  const double per_rotor_m = motor.spool_radius_m / motor.gear_ratio;
  const double free_m_per_s =
      per_rotor_m * motor.supply_voltage_v / motor.torque_constant_n_m_per_a;
  settings.push_back({board::kLengthPerCount, LengthPerCount(motor, encoder_lines)});
  settings.push_back({board::kSpeedLimit, 1.3 * free_m_per_s});
  return settings;
}

MotorSettings SettingsOf(const ImpedanceGains& gains) {
  return {{board::kTensionOffset, gains.tension_offset_n},
          {board::kLengthOffset, gains.length_offset_m},
          {board::kPositionGain, gains.position_gain_n_per_m},
          {board::kVelocityGain, gains.velocity_gain_n_s_per_m}};
}

const ImpedanceGains* GainsOf(const std::vector<ControllerSpec>& controllers, int cable) {
  for (const ControllerSpec& controller : controllers) {
    if (!controller.impedance) continue;
    for (const ImpedanceGains& gains : controller.impedance->cables) {
      if (gains.cable == cable) return &gains;
    }
  }
  return nullptr;
}

std::vector<int> ActuatedCables(const ModelDef& def) {
  std::vector<int> cables;
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    if (def.cables[c].actuator.kind != ActuatorDef::Kind::kNone) {
      cables.push_back(static_cast<int>(c));
    }
  }
  return cables;
}

}  // namespace description
}  // namespace taut
