// Controllers for a microcontroller's program, compiled without a standard library: this file must
// link without any library (see control_freestanding.cmake).
#include "taut/board/board.h"
#include "taut/control/clock.h"
#include "taut/control/cpg.h"
#include "taut/control/feedback_cpg.h"
#include "taut/control/impedance.h"
#include "taut/control/impedance_tick.h"
#include "taut/control/network.h"
#include "taut/control/pid.h"
#include "taut/control/position.h"
#include "taut/control/rate.h"
#include "taut/control/real.h"
#include "taut/control/sine.h"
#include "taut/control/toward_goal.h"

namespace control = taut::control;

extern "C" float RestLengthFromImpedance(float rest_length_m, float tension_n, float* before_m) {
  const control::Impedance<float> law{28.0f, 0.19f, 500.0f, 150.0f};
  const float period_s = 0.001f, stiffness_n_per_m = 229.16f;
  const float length_m = control::LengthFromTension(rest_length_m, tension_n, stiffness_n_per_m);
  control::DifferenceState<float> difference = control::StartDifference(*before_m);
  const float rate = control::StepDifference(difference, length_m, period_s);
  *before_m = difference.length_before_m;
  const float set_point_n = control::ImpedanceTension(law, length_m, rate, 0.0f);
  return control::TensionToRestLengthByStiffness(rest_length_m, tension_n, set_point_n,
                                                 stiffness_n_per_m, 0.001f);
}

// A whole tick of a board: readings of load cell and encoder, the control law, the PID controller
// that winds
struct BoardSenses {
  float rest_length_m, length_m, rate_m_per_s, tension_n, elastic_n, stiffness_n_per_m;
};
extern "C" float RestLengthFromTick(const BoardSenses* senses,
                                    control::ImpedanceMemory<float>* memory, bool first_tick) {
  control::ImpedanceLaw law;
  law.by_pid = law.differenced_rate = true;
  law.first_tick = first_tick;
  law.proportional = 0.05;
  const control::Impedance<float> gains{28.0f, 0.19f, 500.0f, 150.0f};
  return control::StepImpedance(law, gains, 0.0f, *senses, *memory).target_m;
}

extern "C" float SpeedFromTension(control::PidState<float>* state, float tension_n, float set_n) {
  const control::Pid<float> pid{0.05f, 0.1f, 0.0f};
  return control::TensionByPidLimited(pid, *state, tension_n, set_n, 0.001f, 0.07f,
                                      control::Windup::kHeld);
}

extern "C" float SpeedFromPosition(control::PidState<float>* state, float rest_length_m,
                                   float t_s) {
  const control::ProgramPoint<float> ramp[] = {{0.0f, 0.2f}, {5.0f, 0.3f}};
  const control::Pid<float> pid{5.0f, 0.0f, 0.0f};
  return control::RestLengthByPid(pid, *state, rest_length_m, control::RestLengthAt(ramp, 2, t_s),
                                  0.001f, 0.07f, control::Windup::kHeld);
}

extern "C" float SpeedFromSine(float t_s) {
  const control::Sine<float> wave{0.06f, -0.5f, -0.06f};
  return control::SineVelocity(wave, control::ClockTurns(0.5f, t_s));
}

// Two oscillators of a motor board, with load cell feedback on their phases
extern "C" float SpeedFromOscillators(control::CpgState<float>* states, float tension_n) {
  const control::CpgLaw<float> laws[] = {{1.0f, 0.07f, 20.0f}, {1.0f, 0.07f, 20.0f}};
  const control::CpgCoupling<float> couplings[] = {
      control::MakeCoupling<float>(0, 1, 100.0f, 0.25f),
      control::MakeCoupling<float>(1, 0, 100.0f, -0.25f)};
  const control::CpgNetwork<float> network{laws, 2, couplings, 2};
  const float feedback[] = {0.1f * (tension_n - 10.0f), 0.0f};
  control::CpgWork<float> work[2];
  control::StepCpg(network, feedback, 0.005f, 2, states, work);
  return control::CpgVelocity(states[0]);
}

// The same with a network between load cell and oscillator
extern "C" float SpeedFromNetwork(control::FeedbackCpgState<float>* state, float tension_n) {
  const float weights[] = {0.5f, -1.0f, 2.0f, 0.25f};
  const float heard = (tension_n - 25.0f) / 50.0f;
  float hidden[1], says = 0.0f;
  control::EvaluateNetwork<float>(
      {1, 1, 1}, [&](int n) { return weights[n]; }, [&](int) { return heard; }, hidden,
      [&](int, float y) { says = y; });
  const control::FeedbackCpgLaw<float> law{0.07f, 5.0f, 0.0f, 0.5f, 0.3f};
  const control::CpgFeedback<float> feedback{0.0f, says, -says};
  control::FeedbackCpgWork<float> work;
  control::StepFeedbackCpg<float>({&law, 1, nullptr, 0}, &feedback, 0.01f, 1, state, &work);
  return control::FeedbackCpgSignal(law, *state);
}

// A cable of a rolling robot, from the directions of its struts
extern "C" float LengthTowardGoal(const control::Direction<float>* struts_now,
                                  const control::Direction<float>* goal, float t_s) {
  const control::Direction<float> struts[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const control::StrutFrame<float> frame{1, 1, 1, 0, 0, 0};
  const control::Direction<float> place{0.5f, -0.5f, 0.7f}, up{0, 0, 1};
  const auto in_robot = [&](const control::Direction<float>& v) {
    return control::Along(control::InRobot(frame, struts, struts_now, 3, v), place);
  };
  const control::TowardGoal<float> law{0, -0.3f, 0.1f, 0, 0, 0, 0, 0, 0, 0};
  return control::TowardGoalSignal(law, in_robot(*goal), in_robot(up),
                                   control::BeatStrength(0.3f, control::ClockTurns(0.4f, t_s)));
}

extern "C" int64_t NextTick(float t_s) {
  const control::Clock<float> clock{0.001f, 0.0f};
  const int64_t tick = control::TickAtOrAfter(clock, t_s);
  return control::IsDue(clock, tick, t_s) ? tick + 1 : tick;
}

int main() {
  float before_m = 0.2f;
  control::PidState<float> tension = control::StartPid<float>();
  control::PidState<float> position = control::StartPidAt(0.0f);
  const float rest_length_m = RestLengthFromImpedance(0.2f, 10.0f, &before_m);
  const float speed =
      SpeedFromTension(&tension, 10.0f, 12.0f) + SpeedFromPosition(&position, rest_length_m, 2.0f);
  control::CpgState<float> oscillators[] = {control::StartCpg<float>(), control::StartCpg<float>()};
  control::FeedbackCpgState<float> hearing = control::StartFeedbackCpg(0.0f, 0.5f);
  const control::Direction<float> axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const float gait = SpeedFromNetwork(&hearing, 20.0f) + SpeedFromSine(0.25f) +
                     SpeedFromOscillators(oscillators, 12.0f) + LengthTowardGoal(axes, axes, 0.5f);
  return speed < 0.0f && gait < 1.0f && NextTick(0.5f) > 0 ? 0 : 1;
}

// All computations of a board in a millisecond, including a message.
extern "C" void BoardTick(taut::board::Board* board, const taut::board::Inputs* inputs,
                          const uint8_t* message, uint8_t size,
                          uint8_t (*frame)[taut::board::kFrameSize]) {
  taut::board::Receive(message, size, size > 11, *board);
  taut::board::Tick(*inputs, *board);
  taut::board::MakeFrame(*board, *frame);
}
