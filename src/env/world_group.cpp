#include "env/world_group.h"

#include <algorithm>
#include <cmath>

#include "base/assert.h"

namespace taut::env {
namespace {

/// Returns one pointer per lane to the experiment's unchanged variant, for use before episodes
/// begin.
std::vector<const RolloutWorld*> AllAs(const RolloutWorld& world, int lanes) {
  return std::vector<const RolloutWorld*>(static_cast<std::size_t>(lanes), &world);
}

constexpr int kMostTries = 8;

/// Number of steps between two checks of the deadline, a few milliseconds for most models.
constexpr std::int64_t kStepsBetweenLooks = 16;

}  // namespace

Group::Group(const Plan& plan, const ExperimentSpec& observed,
             const std::vector<ChannelInfo>& channels, int count)
    : plan_(plan),
      count_(count),
      width_(static_cast<int>(channels.size()) + plan.options.own_observations),
      batch_(plan.model, {.worlds = plan.lanes, .threads = 1, .simd = plan.simd}),
      plant_(PlantOf(batch_)),
      loop_(plan.experiment, AllAs(WorldOf(plan.experiment), plan.lanes), *plant_, {}),
      bodies_(batch_),
      actions_(plan),
      reward_and_termination_(plan, loop_, bodies_),
      observer_(plan, observed, channels, loop_, bodies_),
      worlds_(static_cast<std::size_t>(plan.lanes)) {}

bool Group::Begin(int lane, std::uint64_t raw_seed, Starts& starts, Place& place,
                  std::string& failed) {
  Episode episode = DrawEpisode(plan_, raw_seed);
  const auto start = starts.Of(episode, place.starts, failed);
  if (!start) return false;
  const auto put = [&](int j) {
    const bool restored = batch_.Restore(j, *start);
    TAUT_ASSERT(restored);
    loop_.Restart(j, episode.world);
    worlds_[Index(j)].begins = true;
  };
  put(lane);
  // Unused lanes restart with the first world, so that they do not fall forever.
  for (int j = count_; lane == 0 && j < plan_.lanes; ++j) put(j);
  Slot& own = worlds_[Index(lane)];
  own.last = own.now;
  own.now = {};
  own.now.seed = episode.seed;
  own.waits = false;
  own.episode = std::move(episode);
  return true;
}

void Group::Settle() {
  loop_.Sense();
  bodies_.Read();
  Lanes begun = 0;
  for (int j = 0; j < plan_.lanes; ++j) {
    Slot& own = worlds_[Index(j)];
    if (!own.begins) continue;
    own.begins = false;
    const Slot& like = worlds_[Index(j < count_ ? j : 0)];
    actions_.Begin(j, loop_.commands(), like.episode.action_delay);
    reward_and_termination_.Begin(j, like.episode.world);
    if (j < count_) begun |= Lanes{1} << j;
  }
  observer_.Take(begun, count_);
  for (int j = 0; j < count_; ++j) {
    if (Has(begun, j)) observer_.Begin(j, worlds_[Index(j)].episode.observation_delay);
  }
}

void Group::Serialize(plant::LaneState& state) {
  Slot& own = worlds_[Index(state.lane())];
  state.Value(own.waits);
  for (EpisodeState* episode : {&own.now, &own.last}) {
    state.Values(episode->seed, episode->steps, episode->reward, episode->end);
  }
  actions_.Serialize(state,
                     loop_);  // restores the controllers' numbers before their state
  loop_.Serialize(state);
  reward_and_termination_.Serialize(state);
  observer_.Serialize(state);
}

std::vector<std::uint8_t> Group::Save(int lane) {
  std::vector<std::uint8_t> saved;
  plant::LaneState state(lane, plan_.lanes, saved);
  state.Value(worlds_[Index(lane)].episode.raw_seed);
  const std::vector<std::uint8_t> world = batch_.Save(lane);
  std::uint64_t size = world.size();
  state.Value(size);
  saved.insert(saved.end(), world.begin(), world.end());
  Serialize(state);
  return saved;
}

bool Group::Restore(int lane, std::span<const std::uint8_t> saved) {
  plant::LaneState head(lane, plan_.lanes, saved);
  std::uint64_t raw_seed = 0, size = 0;
  head.Values(raw_seed, size);
  constexpr std::size_t kHead = 2 * sizeof(std::uint64_t);
  if (saved.size() < kHead || size > saved.size() - kHead) return false;
  const auto world = saved.subspan(kHead, static_cast<std::size_t>(size));
  if (!batch_.Restore(lane, {world.begin(), world.end()})) return false;
  Slot& own = worlds_[Index(lane)];
  own.episode = DrawEpisode(plan_, raw_seed);
  own.begins = false;
  loop_.Restart(lane, own.episode.world);
  bodies_.Read();
  actions_.Begin(lane, loop_.commands(), own.episode.action_delay);
  reward_and_termination_.Begin(lane, own.episode.world);
  observer_.Begin(lane, own.episode.observation_delay);
  plant::LaneState state(lane, plan_.lanes, saved.subspan(kHead + world.size()));
  Serialize(state);
  TAUT_ASSERT(state.at_end());
  return true;
}

void Group::BeginNext(int lane, Starts& starts, Place& place) {
  const std::uint64_t present = worlds_[Index(lane)].episode.raw_seed;
  std::uint64_t seed = present;
  std::string failed;
  for (int i = 0; i < kMostTries; ++i) {
    seed = FollowingSeed(seed);
    if (Begin(lane, seed, starts, place, failed)) return;
  }
  const bool good = Begin(lane, present, starts, place, failed);
  TAUT_ASSERT(good);  // this start was found before
}

void Group::Advance(Place& place, const Deadline& deadline) {
  const BorrowedScratch borrowed(place, batch_);
  const bool measures = reward_and_termination_.measures();
  const std::int64_t most = measures ? 1 : deadline.polls() ? kStepsBetweenLooks : steps_left_;
  std::int64_t since_look = 0;
  while (steps_left_ > 0) {
    const int done = loop_.Steps(static_cast<int>(std::min(most, steps_left_)));
    steps_left_ -= done;
    if (measures) reward_and_termination_.Measure();
    since_look += done;
    if (since_look < kStepsBetweenLooks || steps_left_ == 0) continue;
    since_look = 0;
    if (deadline.Reached()) return;
  }
  if (observer_.senses()) loop_.exact();
}

template <class T>
bool Group::Step(const GroupRows<T>& rows, Starts& starts, Place& place, const Deadline& deadline) {
  const std::size_t width = plan_.action_count();
  if (steps_left_ == 0) {
    for (int j = 0; j < plan_.lanes; ++j) {
      Slot& own = worlds_[Index(j)];
      const bool acts = j < count_ && own.now.end == EpisodeEnd::kNone;
      own.good_action = actions_.Read(j, acts ? rows.actions + Index(j) * width : nullptr);
    }
    actions_.Apply(loop_);
    steps_left_ = plan_.steps_per_period;
  }
  Advance(place, deadline);
  if (steps_left_ > 0) return false;
  loop_.Sense();
  bodies_.Read();
  observer_.Next();
  bool begins = false;
  for (int j = 0; j < count_; ++j) {
    Slot& own = worlds_[Index(j)];
    const bool acted = own.now.end == EpisodeEnd::kNone;
    rows.stepped[j] = acted ? 1 : 0;
    rows.begun[j] = 0;
    rows.rewards[j] = 0;
    if (acted) {
      const auto verdict = reward_and_termination_.Evaluate(j, ++own.now.steps, own.good_action);
      rows.rewards[j] = verdict.reward;
      own.now.end = verdict.end;
    }
    if (own.waits) {
      BeginNext(j, starts, place);
      begins = true;
    }
    rows.truncated[j] = own.now.end == EpisodeEnd::kTime ? 1 : 0;
    rows.terminated[j] = own.now.end > EpisodeEnd::kTime ? 1 : 0;
  }
  observer_.Take(AllLanes(count_), count_);
  if (begins) Settle();
  for (int j = 0; j < count_; ++j) Emit(j, rows.observations + Index(j) * Index(width_));
  return true;
}
template bool Group::Step(const GroupRows<float>&, Starts&, Place&, const Deadline&);
template bool Group::Step(const GroupRows<double>&, Starts&, Place&, const Deadline&);

template <class T>
bool Group::Finish(const GroupRows<T>& rows, Starts& starts, Place& place) {
  const Autoreset autoreset = plan_.options.autoreset;
  bool begun = false;
  for (int j = 0; j < count_; ++j) {
    Slot& own = worlds_[Index(j)];
    T* const row = rows.observations + Index(j) * Index(width_);
    for (int i = 0; plan_.options.observe && i < width_; ++i) {
      if (!std::isfinite(row[i])) row[i] = 0;
    }
    if (rows.stepped[j] == 0) {  // ignore changes by callbacks
      rows.rewards[j] = 0;
      rows.terminated[j] = own.now.end > EpisodeEnd::kTime ? 1 : 0;
      continue;
    }
    if (rows.terminated[j] != 0 && own.now.end <= EpisodeEnd::kTime) {
      own.now.end = EpisodeEnd::kCalled;
    }
    if (!std::isfinite(rows.rewards[j])) {
      rows.rewards[j] = 0;
      rows.terminated[j] = 1;
      if (own.now.end <= EpisodeEnd::kTime) own.now.end = EpisodeEnd::kCalled;
    }
    rows.terminated[j] = rows.terminated[j] != 0 ? 1 : 0;
    own.now.reward += rows.rewards[j];
    if (own.now.end == EpisodeEnd::kNone || autoreset == Autoreset::kDisabled) continue;
    if (autoreset == Autoreset::kNextStep) {
      own.waits = true;
      continue;
    }
    if (rows.final_observations != nullptr) {
      std::copy_n(row, width_, rows.final_observations + Index(j) * Index(width_));
    }
    BeginNext(j, starts, place);
    rows.begun[j] = 1;
    begun = true;
  }
  if (!begun) return false;
  Settle();
  for (int j = 0; j < count_; ++j) {
    if (rows.begun[j] != 0) Emit(j, rows.observations + Index(j) * Index(width_));
  }
  return true;
}
template bool Group::Finish(const GroupRows<float>&, Starts&, Place&);
template bool Group::Finish(const GroupRows<double>&, Starts&, Place&);

}  // namespace taut::env
