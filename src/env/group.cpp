#include "env/group.h"

#include <algorithm>
#include <cmath>

#include "base/assert.h"

namespace taut::env {
namespace {

/// Pointers to as many variants as there are lanes: the experiment itself, until episodes begin.
std::vector<const RolloutWorld*> AllAs(const RolloutWorld& world, int lanes) {
  return std::vector<const RolloutWorld*>(static_cast<std::size_t>(lanes), &world);
}

constexpr int kMostTries = 8;

}  // namespace

Group::Group(const Plan& plan, const ExperimentSpec& observed,
             const std::vector<ChannelInfo>& channels, int count)
    : plan_(plan),
      count_(count),
      width_(static_cast<int>(channels.size()) + plan.options.own_observations),
      batch_(plan.model, {.worlds = plan.lanes, .threads = 1, .simd = plan.simd}),
      plant_(PlantOf(batch_)),
      loop_(plan.experiment, AllAs(WorldOf(plan.experiment), plan.lanes), *plant_, {}),
      actions_(plan),
      judge_(plan, loop_),
      observer_(plan, observed, channels, loop_),
      worlds_(static_cast<std::size_t>(plan.lanes)),
      bodies_(plan.body_count() * worlds_.size()) {}

std::span<const BodyState> Group::BodiesOf(int lane) const {
  return std::span(bodies_).subspan(Index(lane) * plan_.body_count(), plan_.body_count());
}

void Group::ReadBodies(int lane) {
  BodyState* body = bodies_.data() + Index(lane) * plan_.body_count();
  for (std::size_t b = 0; b < plan_.body_count(); ++b) {
    *body++ = batch_.Body(lane, static_cast<int>(b));
  }
}

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
  // Nobody looks at those behind the last world; they are kept from falling for ever.
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
  Lanes begun = 0;
  for (int j = 0; j < plan_.lanes; ++j) {
    Slot& own = worlds_[Index(j)];
    if (!own.begins) continue;
    own.begins = false;
    const Slot& like = worlds_[Index(j < count_ ? j : 0)];
    ReadBodies(j);
    actions_.Begin(j, loop_.commands(), like.episode.action_delay);
    judge_.Begin(j, like.episode.world, BodiesOf(j));
    if (j < count_) begun |= Lanes{1} << j;
  }
  observer_.Take(begun, count_, bodies_);
  for (int j = 0; j < count_; ++j) {
    if (Has(begun, j)) observer_.Begin(j, worlds_[Index(j)].episode.observation_delay);
  }
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
  TAUT_ASSERT(good);  // it had that start before
}

void Group::Advance(Place& place) {
  const BorrowedScratch borrowed(place, batch_);
  for (std::int64_t left = plan_.steps_per_period; left > 0;) {
    left -= loop_.Steps(judge_.measures() ? 1 : static_cast<int>(left));
    if (judge_.measures()) judge_.Measure();
  }
}

template <class T>
void Group::Step(const GroupRows<T>& rows, Starts& starts, Place& place) {
  const std::size_t width = plan_.action_count();
  for (int j = 0; j < plan_.lanes; ++j) {
    Slot& own = worlds_[Index(j)];
    const bool acts = j < count_ && own.now.end == EpisodeEnd::kNone;
    own.good_action = actions_.Read(j, acts ? rows.actions + Index(j) * width : nullptr);
  }
  actions_.Apply(plant_->commands());
  Advance(place);
  loop_.Sense();
  observer_.Next();
  bool begins = false;
  for (int j = 0; j < count_; ++j) {
    Slot& own = worlds_[Index(j)];
    const bool acted = own.now.end == EpisodeEnd::kNone;
    rows.stepped[j] = acted ? 1 : 0;
    rows.begun[j] = 0;
    rows.rewards[j] = 0;
    ReadBodies(j);
    if (acted) {
      const auto verdict = judge_.Look(j, ++own.now.steps, own.good_action, BodiesOf(j));
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
  observer_.Take(AllLanes(count_), count_, bodies_);
  if (begins) Settle();
  for (int j = 0; j < count_; ++j) Emit(j, rows.observations + Index(j) * Index(width_));
}
template void Group::Step(const GroupRows<float>&, Starts&, Place&);
template void Group::Step(const GroupRows<double>&, Starts&, Place&);

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
    if (rows.stepped[j] == 0) {  // a callback has nothing to say here
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
