/// Keys of motor boards in experiment files (docs/theory/boards.md).
#pragma once

#include "description/experiment/experiment_text.h"
#include "description/yaml/keys.h"

namespace taut::description {

template <class Io>
void Keys(Io& io, Like<BoardLoadCell> auto& c) {
  io.Map("", "boards.load_cell",
         "Load cell of each board: force = n_per_count * (code - counts_at_zero). Converter codes "
         "are whole numbers from 0 to 1023. The defaults are the values of Tetraspine3 (eq. 7 of "
         "Mirletz et al. "
         "2015).");
  io("n_per_count", c.n_per_count, Bound{.least = 0.001, .most = 10}, kFixed,
     "Force per count [N].");
  io("counts_at_zero", c.counts_at_zero, Bound{.least = 0, .most = 1023}, kFixed,
     "Converter code without load.");
  io("saturation_counts", c.saturation_counts, Bound{.least = 1, .most = 1023}, kFixed,
     "Converter code at which the amplifier saturates.");
  io("noise_counts", c.noise_counts, Bound{.least = 0, .most = 1000}, kFixed,
     "Standard deviation of the noise of each conversion, in counts, before rounding.");
}

template <class Io, Either<BoardsSpec, BoardsText> Boards>
void Keys(Io& io, Boards& b) {
  io.Map("boards", "boards",
         "Motor boards between the controllers and the DC motors (docs/theory/boards.md). A "
         "broadcast sends V0 of "
         "`impedance`, or the rest lengths of `position`; the firmware's control loop computes the "
         "duties of the motors at 1 kHz. Controllers receive the boards' readings. All cables with "
         "an actuator need a `dc_motor`, and impedance control must drive all of these cables or "
         "none.",
         R"({"force_p_per_n": 0.03, "force_i_per_n_s": 0.3})");
  io("broadcast_s", b.broadcast_s, Bound{.least = 0.001, .most = 0.029}, kFixed,
     "Time between two broadcasts, a whole number of milliseconds. Boards replace V0 by 0 after "
     "30 ms without a broadcast.");
  io("broadcast_delay_s", b.broadcast_delay_s, Bound{.least = 0, .most = 0.028}, kFixed,
     "Time from the controllers to the boards, a whole number of milliseconds, less than "
     "`broadcast_s`. The default is the delay on the emulated robot.");
  io("velocity_input_scale", b.velocity_input_scale, Bound{.least = 0, .most = 100},
     "Factor on V0: value on the boards divided by the value of the controller.");
  io("hold_s", b.hold_s, Bound::kNonNegative, kFixed,
     "Time at the start during which the motors hold their position, before the control law "
     "starts.");
  io("capture", b.capture,
     "Whether L0 and T0 become the length and tension measured at the start of impedance control, "
     "instead of the set points of the controller.");
  io("encoder_lines", b.encoder_lines, Bound{.least = 1, .most = 100'000},
     "Lines of the encoder on each motor's shaft. The firmware counts two edges per line.");
  io("load_cell", b.load_cell);
  const auto gain = [](double most) { return Bound{.least = 0, .most = most}; };
  io("force_p_per_n", b.force_p_per_n, gain(10),
     "Proportional gain of the PID from the error of the tension to the duty.");
  io("force_i_per_n_s", b.force_i_per_n_s, gain(100), "Integral gain of the tension PID.");
  io("force_d_s_per_n", b.force_d_s_per_n, gain(1), "Derivative gain of the tension PID.");
  io("length_p_per_m", b.length_p_per_m, gain(10'000),
     "Proportional gain of the PID from the error of the rest length to the duty, for position "
     "control and holding.");
  io("length_i_per_m_s", b.length_i_per_m_s, gain(100'000),
     "Integral gain of the rest length PID.");
  io("length_d_s_per_m", b.length_d_s_per_m, gain(100), "Derivative gain of the rest length PID.");
  io("tension_filter_share", b.tension_filter_share, Bound{.least = 0.001, .most = 1},
     "Share of a new reading in the filtered tension (a of eq. K.13).");
  io("rate_filter_share", b.rate_filter_share, Bound{.least = 0.001, .most = 1},
     "Weight of the newest tick's change of encoder count in the filtered rate (a of eq. K.12 in "
     "theory/control.md).");
  io("winding_counts_per_count", b.winding_counts_per_count, gain(10),
     "Load cell counts per encoder count wound in, for the complementary filter of the tension; 0: "
     "low-pass filter.");
  io("tension_limit_n", b.tension_limit_n, Bound{.least = 1, .most = 110},
     "Tension limit: five consecutive readings above it are a fault.");
  io("tension_band_n", b.tension_band_n, Bound{.least = 0.1, .most = 50},
     "Width of the band below `tension_limit_n` in which the duty for winding in decreases to 0.");
  io("duty_limit", b.duty_limit, Bound::kFraction, "Largest magnitude of the duty.");
  io("slack_way_m", b.slack_way_m, Bound{.least = 0.001, .most = 1}, kFixed,
     "Longest length that may be wound in without tension, or with a constant load cell reading; "
     "more is a fault.");
  io("stall_duty", b.stall_duty, Bound{.least = 0.05, .most = 1.1}, kFixed,
     "Duty threshold of the stall detection: at least this duty for 100 ms without an encoder "
     "count is a fault.");
  io("supply_v", b.supply_v, Bound{.least = 5, .most = 28}, kFixed,
     "Supply voltage [V] for the board's estimate of the winding temperature. The supply of the "
     "simulated motor is a key of the model.");
  io("winding_ohm", b.winding_ohm, Bound{.least = 0.1, .most = 1000}, kFixed,
     "Winding resistance for the board's estimate of the winding temperature.");
  io("back_emf_v_s_per_m", b.back_emf_v_s_per_m, gain(10'000), kFixed,
     "Back EMF per cable speed for the board's estimate of the winding temperature.");
  io("winding_limit_c", b.winding_limit_c, Bound{.least = 40, .most = 155}, kFixed,
     "Limit of the estimated winding temperature [degrees C]; above it, the motor has a fault.");
}
void Check(const MapReader& map, BoardsText& boards);

}  // namespace taut::description
