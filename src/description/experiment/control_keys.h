/// Keys of controllers in experiment files, with the subset that resolved experiments contain.
#pragma once

#include "description/experiment/board_keys.h"
#include "description/experiment/experiment_text.h"
#include "description/gait/gait_keys.h"

namespace taut::description {

inline const Choices<TensionConversion> kConversions{{"stiffness", TensionConversion::kStiffness},
                                                     {"pid", TensionConversion::kPid}};
inline const Choices<RateSource> kRateSources{
    {"exact", RateSource::kExact},
    {"differenced", RateSource::kDifferenced},
    {"differenced_from_rest_length", RateSource::kDifferencedFromRestLength}};
inline constexpr const char* kCablesMeaning =
    "Cable selector. `inner_top_1`: the cable with that name. `inner`: all cables with that tag. "
    "`[inner, top]`: all with both tags. `[[inner, left], [inner, right]]`: all that have all tags "
    "of at least "
    "one set. A selector without a match is an error.";

/// Gains that studies may vary.
template <class Io>
void Keys(Io& io, Like<ImpedanceGains> auto& g) {
  io("cable", g.cable);
  io("tension_offset_n", g.tension_offset_n, Bound::kNonNegative);
  io("length_offset_m", g.length_offset_m, Bound::kNonNegative);
  io("position_gain_n_per_m", g.position_gain_n_per_m, Bound::kNonNegative);
  io("velocity_gain_n_s_per_m", g.velocity_gain_n_s_per_m, Bound::kNonNegative);
  io("velocity_offset_m_per_s", g.velocity_offset_m_per_s);
}
template <class Io>
void Keys(Io& io, Like<GainsText> auto& g) {
  io.Map("gains", "controller.impedance.gains",
         "Gains of the selected cables. No cable may be matched twice.",
         R"({"cables": ["inner", "top"], "position_gain_n_per_m": 500, )"
         R"("velocity_gain_n_s_per_m": 150})");
  io("cables", g.cables, kNeeded, kCablesMeaning);
  io("position_gain_n_per_m", g.position_gain_n_per_m, kNeeded, Bound::kNonNegative,
     "Position gain K (eq. 3).");
  io("velocity_gain_n_s_per_m", g.velocity_gain_n_s_per_m, kNeeded, Bound::kNonNegative,
     "Velocity gain B (eq. 3).");
}
template <class Io>
void Keys(Io& io, Like<SetPointText> auto& s) {
  io.Map("set_points", "controller.impedance.set_points",
         "Set points of the selected cables. No cable may be matched twice.",
         R"({"cables": "inner_top_1", "tension_n": 28, "length_m": 0.19})");
  io("cables", s.cables, kNeeded, kCablesMeaning);
  io("tension_n", s.tension_n, kNeeded, Bound::kNonNegative, "Tension offset T0 (eq. 3).");
  io("length_m", s.length_m, kNeeded, Bound::kNonNegative, "Length set point L0 (eq. 3).");
  io("velocity_m_per_s", s.velocity_m_per_s,
     "Velocity set point V0 (eq. 3), lengthening positive.");
}
template <class Io>
void Keys(Io& io, Like<PidGains> auto& p) {
  io.Map("", "controller.impedance.pid",
         "PID controller from tension error to winding rate. Only with `conversion: pid`.");
  io("proportional_m_per_s_n", p.proportional_m_per_s_n, kNeeded, Bound::kNonNegative,
     "Proportional gain: winding rate per tension error.");
  io("integral_m_per_s2_n", p.integral_m_per_s2_n, Bound::kNonNegative, "Integral gain.");
  io("derivative_m_per_n", p.derivative_m_per_n, Bound::kNonNegative, "Derivative gain.");
}
template <class Io, Either<ImpedanceSpec, ImpedanceText> Impedance>
void Keys(Io& io, Impedance& i) {
  io.Map(
      "impedance", "controller.impedance",
      "Impedance control of each cable (eq. 3 of Mirletz et al. 2015), with lengthening positive. "
      "The tension set "
      "point T = T0 + K (L - L0) + B (V - V0), never negative, becomes a command to the cable's "
      "motor. Every cable with a set point needs gains, and vice versa.");
  io.Rule(R"("if": {"properties": {"conversion": {"const": "pid"}}, "required": ["conversion"]}, )"
          R"("then": {"required": ["pid"]}, "else": {"not": {"required": ["pid"]}})");
  io("conversion", i.conversion, kConversions,
     "Conversion of the tension set point to a rest length. `stiffness`: rest length - (set point "
     "- tension) / k with the cable's stiffness k, as in NTRT's tension controller. `pid`: a PID "
     "on the tension error commands the rate of the rest length, as on the robot's boards.");
  if constexpr (Io::kResolved) {
    io("pid", i.pid);
    io("differenced_rate", i.differenced_rate);
    io("start_from_rest_length", i.start_from_rest_length);
    io("cables", i.cables);
  } else {
    io("pid", i.pid_text);
    io("rate", i.rate, kRateSources,
       "Source of the cable's rate V. `exact`: the true rate. `differenced`: change of length "
       "since the last "
       "tick, divided by the period, as the boards compute it; 0 at the first tick. "
       "`differenced_from_rest_length`: as `differenced`, but the first difference starts from the "
       "rest length, as in NTRT.");
    io("gains", i.gains, kNeeded, "Gains K and B.");
    io("set_points", i.set_points, kNeeded, "Set points T0, L0 and V0.");
  }
}
void Check(const MapReader& map, ImpedanceText& impedance);

template <class Io>
void Keys(Io& io, Like<PositionProgram> auto& p) {
  io("cable", p.cable);
  io("rest_length_m", p.rest_length_m);
}
template <class Io>
void Keys(Io& io, Like<ProgramText> auto& p) {
  io.Map("programs", "controller.position.programs",
         "Rest length of the selected cables over time: a constant, or points [[time_s, value], "
         "...], linearly interpolated and held before the first and after the last point. Two "
         "points make a ramp.",
         R"({"cables": "inner", "change_m": [[1, 0], [3, -0.02]]})");
  io("cables", p.cables, kNeeded, kCablesMeaning);
  io.OneOf({"rest_length_m", "change_m"});
  io("rest_length_m", p.rest_length_m, Bound::kPositive, "Rest length of the selected cables.");
  io("change_m", p.change_m, "Change of each cable's initial rest length, lengthening positive.");
}
template <class Io>
void Keys(Io& io, Like<PositionText> auto& p) {
  io.Map("position", "controller.position", "Position control: rest lengths over time.");
  io("programs", p.programs, kNeeded, "Programs of cables. No cable may be matched twice.");
}

template <class Io, Either<GaitChange, GaitChangeText> Change>
void Keys(Io& io, Change& c) {
  io.Map("changes", "controller.gait_changes", "Switch to another gait at a given time.",
         R"({"at_s": 20, "gait": "../gaits/cpg_learned.yaml"})");
  io("at_s", c.at_s, kNeeded, Bound::kNonNegative,
     "Time of the switch. The gait changes at the first tick of the gait's clock at or after this "
     "time.");
  if constexpr (Io::kResolved) {
    io("gait", c.gait);
  } else {
    io("gait", c.gait_file, kNeeded,
       "Gait file, relative to this file's folder. A gait may be used again.");
  }
}

/// Keys that velocity inputs and rest length inputs share.
template <class Io, class Input>
void GaitInputKeys(Io& io, Input& v, const char* example = nullptr) {
  io("period_s", v.clock.period_s, Bound::kPositive,
     "Time between two ticks of the gait; its signals are held in between.");
  io("phase_s", v.clock.phase_s, Bound::kNonNegative, "Time of the gait's first tick.");
  if constexpr (Io::kResolved) {
    io("gait", v.gait);
    io("others", v.others, kLater);
    io("changes", v.changes, kLater);
  } else {
    io("gait", v.gait_file, kNeeded, "Gait file, relative to this file's folder.",
       Example{example});
    io("changes", v.change_texts,
       "Later gaits and their times. All gaits must drive the same cables and the same quantity as "
       "`gait`.");
    io("more_gaits", v.more_gaits,
       "Additional gait files, for selection at run time by a controller of your program.");
  }
  io("blend_s", v.blend_s, LaterThan{0.5}, Bound::kNonNegative,
     "Duration of a gait change, in which the weight of the new gait rises smoothly from 0 to 1. "
     "This duration has no effect on a change between networks with the same oscillators: the "
     "phases and amplitudes of the oscillators continue with "
     "the new gait's parameters.");
}

template <class Io>
void Keys(Io& io, Like<GaitInputSpec> auto& v) {
  GaitInputKeys(io, v);
}
template <class Io>
void Keys(Io& io, Like<VelocityInputText> auto& v) {
  io.Map("velocity_input", "controller.velocity_input",
         "Gait that is added to V0 of `impedance`, with a separate clock, so that slow oscillators "
         "can drive a fast control law. Only with `impedance`, which must drive all cables of the "
         "gait.",
         R"({"gait": "../gaits/cpg_learned.yaml", "period_s": 0.01})");
  GaitInputKeys(io, v, R"("../gaits/cpg_learned.yaml")");
}
template <class Io>
void Keys(Io& io, Like<RestLengthInputText> auto& v) {
  io.Map("rest_length_input", "controller.rest_length_input",
         "Gait with `drives: rest_length` and a separate clock. The signals of the gait are added "
         "to the "
         "programs of `position`, and to the initial rest length of cables without a program. "
         "`position` is optional, `impedance` not allowed.",
         R"({"gait": "../gaits/rest_length_sine.yaml", "period_s": 0.01})");
  GaitInputKeys(io, v, R"("../gaits/rest_length_sine.yaml")");
}
void Check(const MapReader& map, GaitInputText& input);

template <class Io, Either<ControllerSpec, ControllerText> Controller>
void Keys(Io& io, Controller& c) {
  io.Map("controller", "controller",
         "Controller with a clock. A controller has either `impedance`, or at least one of "
         "`position` and "
         "`rest_length_input`.");
  io("name", c.name, kNeeded, kName, "Name of the controller.");
  io("period_s", c.clock.period_s, Bound::kPositive,
     "Time between two ticks, independent of the physics step.");
  io("phase_s", c.clock.phase_s, Bound::kNonNegative, "Time of the first tick.");
  if constexpr (Io::kResolved) {
    io.EitherSide({"impedance"}, {"position", "rest_length_input", "boards"});
    io("impedance", c.impedance);
    io("position", c.position);
    io("velocity_input", c.velocity_input);
    io("rest_length_input", c.rest_length_input);
    io("boards", c.boards, kLater);
  } else {
    io.EitherSide({"impedance"}, {"position", "rest_length_input"});
    io("impedance", c.impedance_text);
    io("position", c.position_text);
    io("velocity_input", c.velocity_input_text);
    io("rest_length_input", c.rest_length_input_text);
  }
}
void Check(const MapReader& map, ControllerText& controller);

}  // namespace taut::description
