/// Motor boards of an experiment: the firmware's control loop between the controllers and the DC
/// motors (docs/theory/boards.md). A simulation runs the loop natively, a robot on its boards.
///
/// Threads: a spec is plain data.
#pragma once

namespace taut {

/// Load cell of a board with amplifier and converter: force = n_per_count (code - counts_at_zero)
/// (Mirletz et al. 2015, eq. 7).
struct BoardLoadCell {
  double n_per_count = 0.1567;              ///< Force per count [N], > 0.
  double counts_at_zero = 4.9363 / 0.1567;  ///< Code without a force, 31.5.
  double saturation_counts = 741;           ///< Limit of the amplifier, 111.2 N.
  double noise_counts = 0.7;  ///< Standard deviation of the noise of a conversion (assumed).
};

/// Returns the converter's code for a force, with a noise of `noise` standard deviations.
int LoadCellCode(const BoardLoadCell& cell, double force_n, double noise) noexcept;

/// Settings of all boards. Names, units, limits and defaults of the firmware's parameters are those
/// of `taut/board/parameters.h`. Parameters of a motor that follow from its cable (stiffness, rest
/// length, length per count, speed limit) or its controller (T0, L0, K, B) are not included.
struct BoardsSpec {
  double broadcast_s = 0.010;  ///< Time between two broadcasts, a multiple of 1 ms.
  /// Transmission time from the controllers to the boards, a multiple of 1 ms, less than
  /// `broadcast_s`. Default: as on the emulated robot (docs/validation/virtual_robot.md).
  double broadcast_delay_s = 0.004;
  double velocity_input_scale = 1.0;  ///< Ratio of V0 on a board to V0 of the controller.
  double hold_s = 0.0;  ///< Time at the start during which motors hold their position.
  /// Whether T0 and L0 become the tension and length measured when impedance control starts.
  bool capture = false;
  int encoder_lines = 16;  ///< Encoder lines per turn of the motor's shaft; two counts per line.
  BoardLoadCell load_cell;

  // Parameters of every motor.
  double force_p_per_n = 0.06, force_i_per_n_s = 0.6, force_d_s_per_n = 0.0;
  double length_p_per_m = 400, length_i_per_m_s = 4000, length_d_s_per_m = 0.0;
  double tension_filter_share = 0.2, rate_filter_share = 0.1, winding_counts_per_count = 0.0;
  double tension_limit_n = 50, tension_band_n = 10, duty_limit = 1.0;
  double slack_way_m = 0.03, stall_duty = 0.6;

  // Parameters of every board: estimate of the winding temperature.
  double supply_v = 12, winding_ohm = 19.8, back_emf_v_s_per_m = 169, winding_limit_c = 110;
};

}  // namespace taut
