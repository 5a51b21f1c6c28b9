#include "env/observer.h"

#include <algorithm>
#include <limits>
#include <map>

#include "plant/body_channels.h"
#include "plant/cable_channels.h"

namespace taut::env {
namespace {

/// Returns the rows of the cable channels that traces contain for every cable.
std::map<std::string, const double*> CableRowsOf(const plant::Loop& loop) {
  std::map<std::string, const double*> rows;
  for (const plant::CableChannel& channel : plant::kCableChannels) {
    rows[channel.name] = channel.Row(loop.exact().cables, loop.commands());
  }
  return rows;
}

template <class Items>
std::map<std::string, std::size_t> IndexOf(const Items& items) {
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < items.size(); ++i) index[items[i].name] = i;
  return index;
}

}  // namespace

ExperimentSpec Observed(const ExperimentSpec& experiment) {
  ExperimentSpec observed = experiment;
  observed.record.channels = experiment.environment->observations;
  return observed;
}

Observer::Observer(const Plan& plan, const ExperimentSpec& observed,
                   const std::vector<ChannelInfo>& channels, plant::Loop& loop,
                   const LaneBodies& bodies)
    : loop_(loop),
      count_(channels.size()),
      lanes_(static_cast<std::size_t>(plan.lanes)),
      slots_(static_cast<std::size_t>(plan.most_observation_delay) + 1),
      kernel_(plant::LaneKernelOf(plan.lanes)),
      rows_(count_),
      ring_(slots_ * count_ * lanes_),
      fresh_(count_ * lanes_),
      in_float_(slots_),
      delay_(lanes_) {
  const ModelDef& def = plan.experiment.robot.def;
  const auto cables = IndexOf(def.cables), of_bodies = IndexOf(def.bodies),
             components = IndexOf(plant::BodyChannels());
  const auto rows = CableRowsOf(loop);
  ExperimentSpec rest = observed;
  rest.record.channels.clear();
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const std::string& name = channels[i].name;
    const std::size_t first = name.find('/'), last = name.rfind('/');
    const std::string group = name.substr(0, first);
    const std::string whose = first < last ? name.substr(first + 1, last - first - 1) : "";
    const std::string what = name.substr(last + 1);
    const auto cable = cables.find(whose), body = of_bodies.find(whose);
    const auto row = rows.find(what);
    const auto component = components.find(what);
    if (group == "cable" && cable != cables.end() && row != rows.end()) {
      rows_[i] = row->second + cable->second * lanes_;
      senses_ = true;
    } else if (group == "body" && body != of_bodies.end() && component != components.end()) {
      rows_[i] = bodies.Row(body->second, component->second);
    } else {
      rest.record.channels.push_back(name);
      other_columns_.push_back(i);
    }
  }
  others_.resize(other_columns_.size() * lanes_);
  for (std::size_t i = 0; i < other_columns_.size(); ++i) {
    rows_[other_columns_[i]] = &others_[i * lanes_];
  }
  senses_ = senses_ || !other_columns_.empty();
  if (!other_columns_.empty()) recorder_ = std::make_unique<plant::Recorder>(rest);
}

void Observer::Next() { now_ = (now_ + 1) % slots_; }

void Observer::Take(Lanes lanes, int count) {
  const Observation* const exact =
      senses_ ? &loop_.exact() : nullptr;  // `exact()` updates the rows of cables
  for (int j = 0; recorder_ && j < count; ++j) {
    if (!Has(lanes, j)) continue;
    const std::vector<double>& row = recorder_->Row(
        {exact, &loop_.seen(), &loop_.commands(), loop_.plant().world(), &loop_.timeline(j), j});
    for (std::size_t i = 0; i < row.size(); ++i) {
      others_[i * lanes_ + static_cast<std::size_t>(j)] = row[i];
    }
  }
  double* const now = &ring_[now_ * count_ * lanes_];
  const bool all = lanes == AllLanes(count);  // all worlds: unused lanes may be overwritten, too
  double* const to = all ? now : fresh_.data();
  const bool in_float = kernel_.collect(rows_.data(), static_cast<int>(count_), to);
  in_float_[now_] = in_float && (all || in_float_[now_] != 0) ? 1 : 0;
  for (std::size_t j = 0; !all && j < lanes_; ++j) {
    if (!Has(lanes, static_cast<int>(j))) continue;
    for (std::size_t i = 0; i < count_; ++i) now[i * lanes_ + j] = to[i * lanes_ + j];
  }
}

void Observer::Begin(int lane, int delay) {
  const auto j = static_cast<std::size_t>(lane);
  delay_[j] = static_cast<std::size_t>(delay);
  for (std::size_t slot = 0; slot < slots_; ++slot) {
    for (std::size_t i = 0; i < count_; ++i) At(slot, i, j) = At(now_, i, j);
    in_float_[slot] = in_float_[slot] & in_float_[now_];
  }
}

void Observer::Serialize(plant::LaneState& state) {
  for (std::size_t age = 0; age < slots_; ++age) {
    for (std::size_t i = 0; i < count_; ++i) {
      state.Value(At((now_ + slots_ - age) % slots_, i, static_cast<std::size_t>(state.lane())));
    }
  }
  // The range of restored numbers is unknown.
  if (state.reads()) std::fill(in_float_.begin(), in_float_.end(), 0);
}

namespace {

/// Clamps a number to the range of T, since a double may be too large for a float.
template <class T>
T Number(double x) {
  constexpr double kMost = std::numeric_limits<T>::max();
  return static_cast<T>(x > kMost ? kMost : x < -kMost ? -kMost : x);
}

}  // namespace

template <class T>
void Observer::Emit(int lane, T* row) const {
  const auto j = static_cast<std::size_t>(lane);
  const std::size_t slot = (now_ + slots_ - delay_[j]) % slots_, lanes = lanes_, count = count_;
  const double* const from = ring_.data() + slot * count * lanes + j;
  if (in_float_[slot] != 0) {
    for (std::size_t i = 0; i < count; ++i) row[i] = static_cast<T>(from[i * lanes]);
  } else {
    for (std::size_t i = 0; i < count; ++i) row[i] = Number<T>(from[i * lanes]);
  }
}
template void Observer::Emit(int lane, float* row) const;
template void Observer::Emit(int lane, double* row) const;

}  // namespace taut::env
