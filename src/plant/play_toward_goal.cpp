#include "math/vec.h"
#include "plant/player_kinds.h"
#include "taut/control/sine.h"
#include "taut/control/toward_goal.h"

namespace taut::plant {
namespace {

using Axis = control::Direction<double>;

Axis AxisOf(const Vec3& v) { return {v.x, v.y, v.z}; }

/// Returns S^-1, by Cramer's rule (docs/theory/gaits.md, eq. G.22).
control::StrutFrame<double> FrameOf(const std::vector<Axis>& struts) {
  double xx = 0, yy = 0, zz = 0, xy = 0, yz = 0, xz = 0;
  for (const Axis& u : struts) {
    xx += u.x * u.x, yy += u.y * u.y, zz += u.z * u.z;
    xy += u.x * u.y, yz += u.y * u.z, xz += u.x * u.z;
  }
  const double a = yy * zz - yz * yz, b = xz * yz - xy * zz, c = xy * yz - yy * xz;
  const double one = 1 / (xx * a + xy * b + xz * c);
  return {one * a, one * (xx * zz - xz * xz), one * (xx * yy - xy * xy),
          one * b, one * (xy * xz - xx * yz), one * c};
}

/// Player of a rolling gait toward the goal (docs/theory/gaits.md, eq. G.22 to G.24). Computes one
/// lane at a time, so that results are bit-identical for any number of lanes. The cost is small
/// compared to a step.
class TowardGoalPlayer final : public GaitPlayer {
 public:
  explicit TowardGoalPlayer(const GaitSetup& setup) : GaitPlayer(setup), laws_(setup.gaits.size()) {
    const ResolvedGait& found = setup.resolved;
    for (const ResolvedGait::Strut& strut : found.struts) {
      bodies_.push_back(strut.body);
      along_.push_back(strut.along);
      described_.push_back(AxisOf(strut.along));
    }
    for (const Vec3& place : found.from_center) places_.push_back(AxisOf(place));
    now_.resize(bodies_.size());
    frame_ = FrameOf(described_);
    for (int j = 0; j < lanes(); ++j) Restart(j, *setup.gaits[static_cast<std::size_t>(j)]);
  }

  void Tick(const GaitTick& tick, const Observation& seen) override {
    for (int j = 0; j < lanes(); ++j) {
      if (Has(tick.due, j)) TickLane(j, tick.since_s[j], seen);
    }
  }

  void Restart(int lane, const GaitSpec& gait) override {
    Retune(lane, gait);
    Law& own = laws_[static_cast<std::size_t>(lane)];
    own.beat_hz = own.wanted_hz;
    own.shift_turns = 0;
  }

  void Retune(int lane, const GaitSpec& gait) override {
    const TowardGoalGait& g = *gait.toward_goal;
    Law& own = laws_[static_cast<std::size_t>(lane)];
    own.gains = {g.offset, g.ahead,  g.up,        g.ahead2,    g.ahead_up,
                 g.up2,    g.ahead3, g.ahead2_up, g.ahead_up2, g.up3};
    own.beat = g.beat;
    own.wanted_hz = g.beat_hz;
  }

  void Serialize(LaneState& state) override {
    GaitPlayer::Serialize(state);
    Law& own = laws_[static_cast<std::size_t>(state.lane())];
    state.Values(own.beat_hz, own.shift_turns);
  }

 private:
  struct Law {
    control::TowardGoal<double> gains{};
    double beat = 0, beat_hz = 0;
    /// If the frequency changes at a tick, the beat continues with the same phase.
    double wanted_hz = 0, shift_turns = 0;
  };

  /// Computes the signals of a lane. Without known body poses, they equal the offset. Without a
  /// goal sensor, the goal direction is (0, 0).
  void TickLane(int lane, double since_s, const Observation& seen) {
    Axis ahead{0, 0, 0}, up{0, 0, 0};
    if (seen.bodies != nullptr) {
      for (std::size_t k = 0; k < bodies_.size(); ++k) {
        now_[k] = AxisOf(Rotate(seen.bodies->Body(lane, bodies_[k]).orientation, along_[k]));
      }
      const Axis goal{seen.goal ? seen.goal[At(0, lane)] : 0.0,
                      seen.goal ? seen.goal[At(1, lane)] : 0.0, 0.0};
      ahead = InRobot(goal);
      up = InRobot({0, 0, 1});
    }
    Law& own = laws_[static_cast<std::size_t>(lane)];
    if (own.wanted_hz != own.beat_hz) {
      own.shift_turns =
          control::WrapTurns(own.shift_turns + (own.beat_hz - own.wanted_hz) * since_s);
      own.beat_hz = own.wanted_hz;
    }
    const double turns = control::ClockTurns(own.beat_hz, since_s);
    const double strength = control::BeatStrength(
        own.beat, own.shift_turns == 0.0 ? turns : control::WrapTurns(turns + own.shift_turns));
    for (std::size_t i = 0; i < places_.size(); ++i) {
      signal_[At(i, lane)] = control::TowardGoalSignal(own.gains, control::Along(ahead, places_[i]),
                                                       control::Along(up, places_[i]), strength);
    }
  }

  Axis InRobot(const Axis& v) const {
    return control::InRobot(frame_, described_.data(), now_.data(), now_.size(), v);
  }

  std::vector<int> bodies_;
  std::vector<Vec3> along_;
  std::vector<Axis> described_, places_, now_;
  control::StrutFrame<double> frame_{};
  std::vector<Law> laws_;  ///< Per lane.
};

}  // namespace

std::unique_ptr<GaitPlayer> MakeTowardGoal(const GaitSetup& setup) {
  if (!setup.gaits[0]->toward_goal) return nullptr;
  return std::make_unique<TowardGoalPlayer>(setup);
}

}  // namespace taut::plant
