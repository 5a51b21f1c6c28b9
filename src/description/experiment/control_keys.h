/// The keys of controllers in an experiment file, and what of them is in a resolved one.
#pragma once

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
    "`inner_top_1`: the cable of that name. `inner`: all cables with that tag. `[inner, top]`: all "
    "cables that have both tags. `[[inner, left], [inner, right]]`: all cables that have any of "
    "these sets. A selector that matches no cable is an error.";

/// Numbers that studies may vary.
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
         "Gains of some cables. No cable may be matched twice.",
         R"({"cables": ["inner", "top"], "position_gain_n_per_m": 500, )"
         R"("velocity_gain_n_s_per_m": 150})");
  io("cables", g.cables, kNeeded, kCablesMeaning);
  io("position_gain_n_per_m", g.position_gain_n_per_m, kNeeded, Bound::kNonNegative, "K of eq. 3.");
  io("velocity_gain_n_s_per_m", g.velocity_gain_n_s_per_m, kNeeded, Bound::kNonNegative,
     "B of eq. 3.");
}
template <class Io>
void Keys(Io& io, Like<SetPointText> auto& s) {
  io.Map("set_points", "controller.impedance.set_points",
         "Set points of some cables. No cable may be matched twice.",
         R"({"cables": "inner_top_1", "tension_n": 28, "length_m": 0.19})");
  io("cables", s.cables, kNeeded, kCablesMeaning);
  io("tension_n", s.tension_n, kNeeded, Bound::kNonNegative, "T0 of eq. 3.");
  io("length_m", s.length_m, kNeeded, Bound::kNonNegative, "L0 of eq. 3.");
  io("velocity_m_per_s", s.velocity_m_per_s, "V0 of eq. 3, lengthening positive.");
}
template <class Io>
void Keys(Io& io, Like<PidGains> auto& p) {
  io.Map("", "controller.impedance.pid",
         "A PID that turns a tension error into a rate of winding in. With `conversion: pid` "
         "only.");
  io("proportional_m_per_s_n", p.proportional_m_per_s_n, kNeeded, Bound::kNonNegative,
     "Rate of winding in per tension error.");
  io("integral_m_per_s2_n", p.integral_m_per_s2_n, Bound::kNonNegative,
     "Gain on the error's integral.");
  io("derivative_m_per_n", p.derivative_m_per_n, Bound::kNonNegative, "Gain on the error's rate.");
}
template <class Io, Either<ImpedanceSpec, ImpedanceText> Impedance>
void Keys(Io& io, Impedance& i) {
  io.Map("impedance", "controller.impedance",
         "Impedance control of each cable (paper eq. 3), lengthening positive: a tension set point "
         "T = T0 + K (L - L0) + B (V - V0), never negative, that becomes a command to the cable's "
         "motor. Every cable that has a set point needs gains, and the other way round.");
  io.Rule(R"("if": {"properties": {"conversion": {"const": "pid"}}, "required": ["conversion"]}, )"
          R"("then": {"required": ["pid"]}, "else": {"not": {"required": ["pid"]}})");
  io("conversion", i.conversion, kConversions,
     "How a tension becomes a rest length. `stiffness`: through the cable's stiffness, rest length "
     "- (set point - tension) / k, as NTRT's tension controller. `pid`: a PID on the tension error "
     "commands the rate of the rest length, as the robot's boards do.");
  if constexpr (Io::kResolved) {
    io("pid", i.pid);
    io("differenced_rate", i.differenced_rate);
    io("start_from_rest_length", i.start_from_rest_length);
    io("cables", i.cables);
  } else {
    io("pid", i.pid_text);
    io("rate", i.rate, kRateSources,
       "Where V comes from. `exact`: the cable's rate. `differenced`: the change of length since "
       "the last tick over the period, as a board measures it; 0 at the first tick. "
       "`differenced_from_rest_length`: the same, but the first difference is taken from the rest "
       "length, as NTRT does.");
    io("gains", i.gains, kNeeded, "K and B.");
    io("set_points", i.set_points, kNeeded, "T0, L0 and V0.");
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
         "The course of some cables' rest length: a constant, or points [[time_s, value], ...] "
         "with straight lines between them, held before the first and after the last one. Two "
         "points make a ramp.",
         R"({"cables": "inner", "change_m": [[1, 0], [3, -0.02]]})");
  io("cables", p.cables, kNeeded, kCablesMeaning);
  io.OneOf({"rest_length_m", "change_m"});
  io("rest_length_m", p.rest_length_m, Bound::kPositive, "The rest length.");
  io("change_m", p.change_m,
     "What is added to each cable's own rest length at the start; lengthening is positive.");
}
template <class Io>
void Keys(Io& io, Like<PositionText> auto& p) {
  io.Map("position", "controller.position", "Rest lengths against time.");
  io("programs", p.programs, kNeeded, "Which cables do what. No cable may be matched twice.");
}

template <class Io, Either<GaitChange, GaitChangeText> Change>
void Keys(Io& io, Change& c) {
  io.Map("changes", "controller.gait_changes", "From a time on another gait plays.",
         R"({"at_s": 20, "gait": "../gaits/cpg_learned.yaml"})");
  io("at_s", c.at_s, kNeeded, Bound::kNonNegative,
     "When: at the first tick of the gait's clock from then on.");
  if constexpr (Io::kResolved) {
    io("gait", c.gait);
  } else {
    io("gait", c.gait_file, kNeeded,
       "A gait file, seen from this file's folder. It may be one that has played before.");
  }
}

/// What both kinds of inputs have.
template <class Io, class Input>
void GaitInputKeys(Io& io, Input& v, const char* example = nullptr) {
  io("period_s", v.clock.period_s, Bound::kPositive,
     "Time between two ticks of the gait; its signals hold in between.");
  io("phase_s", v.clock.phase_s, Bound::kNonNegative, "Time of its first tick.");
  if constexpr (Io::kResolved) {
    io("gait", v.gait);
    io("others", v.others, kLater);
    io("changes", v.changes, kLater);
  } else {
    io("gait", v.gait_file, kNeeded, "A gait file, seen from this file's folder.",
       Example{example});
    io("changes", v.change_texts,
       "Gaits that follow at given times. They move the same cables in the same quantity.");
    io("more_gaits", v.more_gaits,
       "More gait files, for a program's own controller to choose from while the experiment runs.");
  }
  io("blend_s", v.blend_s, LaterThan{0.5}, Bound::kNonNegative,
     "How long a change of gait takes: the new one's share grows smoothly from 0 to 1. Between two "
     "networks of the same oscillators it has no effect: the network goes on with its phases and "
     "amplitudes under the new gait's numbers.");
}

template <class Io>
void Keys(Io& io, Like<GaitInputSpec> auto& v) {
  GaitInputKeys(io, v);
}
template <class Io>
void Keys(Io& io, Like<VelocityInputText> auto& v) {
  io.Map("velocity_input", "controller.velocity_input",
         "A gait that is added to the V0 of `impedance`, on a clock of its own: slower oscillators "
         "above a faster law. With `impedance` only, which must drive all cables that the gait "
         "moves.",
         R"({"gait": "../gaits/cpg_learned.yaml", "period_s": 0.01})");
  GaitInputKeys(io, v, R"("../gaits/cpg_learned.yaml")");
}
template <class Io>
void Keys(Io& io, Like<RestLengthInputText> auto& v) {
  io.Map("rest_length_input", "controller.rest_length_input",
         "A gait with `drives: rest_length`, on a clock of its own: its signals are added to the "
         "programs of `position`, and to the rest length at the start of each cable that has no "
         "program. Needs no `position`, and does not go with `impedance`.",
         R"({"gait": "../gaits/rest_length_sine.yaml", "period_s": 0.01})");
  GaitInputKeys(io, v, R"("../gaits/rest_length_sine.yaml")");
}
void Check(const MapReader& map, GaitInputText& input);

template <class Io, Either<ControllerSpec, ControllerText> Controller>
void Keys(Io& io, Controller& c) {
  io.Map("controller", "controller",
         "One controller: its clock, and either `impedance` or what drives rest lengths: "
         "`position`, `rest_length_input` or both.");
  io("name", c.name, kNeeded, kName, "Name of the controller.");
  io("period_s", c.clock.period_s, Bound::kPositive,
     "Time between two ticks. The physics step does not change it.");
  io("phase_s", c.clock.phase_s, Bound::kNonNegative, "Time of the first tick.");
  io.EitherSide({"impedance"}, {"position", "rest_length_input"});
  if constexpr (Io::kResolved) {
    io("impedance", c.impedance);
    io("position", c.position);
    io("velocity_input", c.velocity_input);
    io("rest_length_input", c.rest_length_input);
  } else {
    io("impedance", c.impedance_text);
    io("position", c.position_text);
    io("velocity_input", c.velocity_input_text);
    io("rest_length_input", c.rest_length_input_text);
  }
}
void Check(const MapReader& map, ControllerText& controller);

}  // namespace taut::description
