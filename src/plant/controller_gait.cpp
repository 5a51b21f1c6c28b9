#include <algorithm>

#include "plant/controller_kinds.h"
#include "plant/player_kinds.h"
#include "plant/schedule.h"
#include "taut/control/clock.h"

namespace taut::plant {
namespace {

/// Returns the weight of the new gait during a blend. `part`: elapsed fraction of the blend. First
/// and second derivatives are continuous (docs/theory/gaits.md).
double ShareAt(double part) {
  const double x = std::clamp(part, 0.0, 1.0);
  return x * x * x * (10.0 + x * (-15.0 + 6.0 * x));
}

/// Controller that plays the gaits of an input one at a time, with blends between them.
class GaitController final : public Controller {
 public:
  GaitController(const ControlSetup& setup, std::size_t index)
      : index_(index),
        lanes_(setup.lanes.size()),
        number_(lanes_.size()),
        time_s_(lanes_.size()),
        since_s_(lanes_.size()) {
    const GaitInputSpec& input = *GaitInputOf(setup.lanes[0]->controllers[index]);
    clock_ = input.clock;
    blend_s_ = input.blend_s;
    for (std::size_t g = 0; g <= input.others.size(); ++g) {
      GaitSetup gaits;
      gaits.period_s = clock_.period_s;
      for (const RolloutWorld* lane : setup.lanes) {
        gaits.gaits.push_back(&GaitOf(*GaitInputOf(lane->controllers[index]), g));
      }
      Diagnostics heard_before;
      gaits.resolved = ResolveGait(*gaits.gaits[0], setup.experiment.robot, heard_before)
                           .value_or(ResolvedGait{});
      players_.push_back(PlayerOf(gaits));
    }
    for (std::size_t j = 0; j < lanes_.size(); ++j) {
      lanes_[j].changes = GaitInputOf(setup.lanes[j]->controllers[index])->changes;
    }
  }

  ClockSpec clock() const override { return clock_; }

  void Restart(int lane, const RolloutWorld& world) override {
    const GaitInputSpec& input = *GaitInputOf(world.controllers[index_]);
    for (std::size_t g = 0; g < players_.size(); ++g) {
      players_[g]->Restart(lane, GaitOf(input, g));
    }
    Lane& own = lanes_[static_cast<std::size_t>(lane)];
    own = Lane{};
    own.changes = input.changes;
  }

  void Retune(int lane, const std::vector<ControllerSpec>& controllers) override {
    const GaitInputSpec& input = *GaitInputOf(controllers[index_]);
    for (std::size_t g = 0; g < players_.size(); ++g) players_[g]->Retune(lane, GaitOf(input, g));
  }

  void Serialize(LaneState& state) override {
    for (const auto& player : players_) player->Serialize(state);
    Lane& own = lanes_[static_cast<std::size_t>(state.lane())];
    for (Part* part : {&own.now, &own.before}) state.Values(part->gait, part->from_tick);
    state.Value(own.blend_from_s);
  }

  void Act(const Tick& tick, const Observation& seen, Commands& commands) override {
    for (std::size_t j = 0; j < lanes_.size(); ++j) {
      if (Has(tick.due, static_cast<int>(j))) Choose(j, tick.number[j], commands.gait[j]);
    }
    for (std::size_t g = 0; g < players_.size(); ++g) Play(static_cast<int>(g), tick, seen);
    if (InUnison(tick.due)) return SayInUnison(commands);
    for (std::size_t j = 0; j < lanes_.size(); ++j) {
      if (Has(tick.due, static_cast<int>(j))) Say(j, tick.number[j], commands);
    }
  }

 private:
  /// Gait that is playing in a lane.
  struct Part {
    int gait = -1;
    std::int64_t from_tick = 0;
  };
  struct Lane {
    std::vector<GaitChange> changes;
    Part now, before;  ///< `before`: the previous gait during a blend.
    double blend_from_s = 0;
  };

  double TimeOf(std::int64_t tick) const {
    return control::TickTime(control::Clock<double>{clock_.period_s, clock_.phase_s}, tick);
  }

  /// Selects the gait of a lane, starting with this tick. A change waits until the previous blend
  /// has ended.
  void Choose(std::size_t j, std::int64_t tick, int commanded) {
    Lane& lane = lanes_[j];
    const double time_s = TimeOf(tick);
    if (lane.before.gait >= 0 && time_s >= lane.blend_from_s + blend_s_) lane.before.gait = -1;
    int gait = 0;
    for (const GaitChange& change : lane.changes) {
      if (time_s >= change.at_s - kTimeToleranceS) gait = change.gait;
    }
    if (commanded >= 0) gait = std::min(commanded, static_cast<int>(players_.size()) - 1);
    if (tick == 0) lane.now = {gait, 0};
    if (gait == lane.now.gait || lane.before.gait >= 0) return;
    const auto old = static_cast<std::size_t>(lane.now.gait), next = static_cast<std::size_t>(gait);
    if (players_[next]->GoOnFrom(*players_[old], static_cast<int>(j))) {
      lane.now.gait = gait;
      return;
    }
    lane.before = lane.now;
    lane.now = {gait, tick};
    lane.blend_from_s = time_s;
  }

  void Play(int gait, const Tick& tick, const Observation& seen) {
    Lanes playing = 0;
    for (std::size_t j = 0; j < lanes_.size(); ++j) {
      const Lane& lane = lanes_[j];
      const Part* part = lane.now.gait == gait ? &lane.now : nullptr;
      if (lane.before.gait == gait) part = &lane.before;
      if (part == nullptr || !Has(tick.due, static_cast<int>(j))) continue;
      playing |= Lanes{1} << j;
      number_[j] = tick.number[j] - part->from_tick;
      time_s_[j] = TimeOf(tick.number[j]);
      since_s_[j] =
          part->from_tick == 0 ? time_s_[j] : static_cast<double>(number_[j]) * clock_.period_s;
    }
    if (playing == 0) return;
    players_[static_cast<std::size_t>(gait)]->Tick(
        {playing, number_.data(), time_s_.data(), since_s_.data()}, seen);
  }

  /// Returns whether all lanes play the same gait without blending.
  bool InUnison(Lanes due) const {
    bool same = due == AllLanes(static_cast<int>(lanes_.size()));
    for (const Lane& lane : lanes_) {
      same = same && lane.before.gait < 0 && lane.now.gait == lanes_[0].now.gait;
    }
    return same;
  }
  void SayInUnison(Commands& commands) const {
    const GaitPlayer& player = *players_[static_cast<std::size_t>(lanes_[0].now.gait)];
    const double* said = player.signal().data();
    for (const int cable : player.cables()) {
      double* const out = commands.signal + static_cast<std::size_t>(cable) * lanes_.size();
      for (std::size_t j = 0; j < lanes_.size(); ++j) out[j] = *said++;
    }
  }

  void Say(std::size_t j, std::int64_t tick, Commands& commands) const {
    const Lane& lane = lanes_[j];
    const double share = lane.before.gait < 0 ? 1.0
                         : blend_s_ > 0 ? ShareAt((TimeOf(tick) - lane.blend_from_s) / blend_s_)
                                        : 1.0;
    Add(lane.now.gait, j, share, false, commands);
    if (share < 1.0) Add(lane.before.gait, j, 1.0 - share, true, commands);
  }

  void Add(int gait, std::size_t j, double share, bool more, Commands& commands) const {
    const GaitPlayer& player = *players_[static_cast<std::size_t>(gait)];
    for (std::size_t i = 0; i < player.cables().size(); ++i) {
      const double said = player.signal()[i * lanes_.size() + j];
      const auto cable = static_cast<std::size_t>(player.cables()[i]);
      double& out = commands.signal[cable * lanes_.size() + j];
      const double part = share == 1.0 ? said : share * said;
      out = more ? out + part : part;
    }
  }

  std::size_t index_;
  ClockSpec clock_;
  double blend_s_ = 0;
  std::vector<std::unique_ptr<GaitPlayer>> players_;  ///< One player per gait of the input.
  std::vector<Lane> lanes_;
  std::vector<std::int64_t> number_;
  std::vector<double> time_s_, since_s_;
};

}  // namespace

std::unique_ptr<Controller> MakeGait(const ControlSetup& setup, std::size_t index) {
  if (GaitInputOf(setup.lanes[0]->controllers[index]) == nullptr) return nullptr;
  return std::make_unique<GaitController>(setup, index);
}

}  // namespace taut::plant
