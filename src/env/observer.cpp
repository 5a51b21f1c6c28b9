#include "env/observer.h"

#include <cmath>
#include <limits>
#include <map>

#include "plant/body_channels.h"

namespace taut::env {
namespace {

/// Where the rows of cables stand that traces have of every cable.
std::map<std::string, const double*> CableRowsOf(const plant::Loop& loop) {
  const ReadingRows& now = loop.exact().cables;
  const Commands& commands = loop.commands();
  return {{"tension_n", now.tension_n},
          {"elastic_n", now.elastic_n},
          {"length_m", now.length_m},
          {"rate_m_per_s", now.rate_m_per_s},
          {"rest_length_m", now.rest_length_m},
          {"target_rest_length_m", commands.rest_length_m},
          {"setpoint_n", commands.set_point_n},
          {"velocity_input_m_per_s", commands.velocity_input_m_per_s}};
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
                   const std::vector<ChannelInfo>& channels, plant::Loop& loop)
    : plan_(plan),
      loop_(loop),
      count_(channels.size()),
      lanes_(static_cast<std::size_t>(plan.lanes)),
      slots_(static_cast<std::size_t>(plan.most_observation_delay) + 1),
      ring_(slots_ * count_ * lanes_),
      delay_(lanes_) {
  const ModelDef& def = plan.experiment.robot.def;
  const auto cables = IndexOf(def.cables), bodies = IndexOf(def.bodies),
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
    const auto cable = cables.find(whose), body = bodies.find(whose);
    const auto row = rows.find(what);
    const auto component = components.find(what);
    if (group == "cable" && cable != cables.end() && row != rows.end()) {
      rows_.push_back({i, row->second + cable->second * lanes_});
    } else if (group == "body" && body != bodies.end() && component != components.end()) {
      of_bodies_.push_back({i, body->second, component->second});
    } else {
      rest.record.channels.push_back(name);
      others_.push_back(i);
    }
  }
  if (!others_.empty()) recorder_ = std::make_unique<plant::Recorder>(rest);
}

void Observer::Next() { now_ = (now_ + 1) % slots_; }

void Observer::Take(Lanes lanes, int count, std::span<const BodyState> bodies) {
  const std::size_t body_count = plan_.body_count();
  double* const now = &ring_[now_ * count_ * lanes_];
  const auto put = [&](std::size_t column, std::size_t lane, double value) {
    now[column * lanes_ + lane] = std::isfinite(value) ? value : 0.0;
  };
  const bool all = lanes == AllLanes(count);
  for (std::size_t i = 0; all && i < rows_.size(); ++i) {  // lanes behind the last world, too
    double* const to = now + rows_[i].column * lanes_;
    for (std::size_t j = 0; j < lanes_; ++j) {
      const double x = rows_[i].lanes[j];
      to[j] = x - x == 0.0 ? x : 0.0;
    }
  }
  for (std::size_t j = 0; j < static_cast<std::size_t>(count); ++j) {
    if (!Has(lanes, static_cast<int>(j))) continue;
    for (std::size_t i = 0; !all && i < rows_.size(); ++i) {
      put(rows_[i].column, j, rows_[i].lanes[j]);
    }
    plant::BodyNumbers values;
    std::size_t filled = body_count;  // none
    for (const OfBody& of : of_bodies_) {
      if (of.body != filled) plant::PutBody(bodies[j * body_count + of.body], values.data());
      filled = of.body;
      put(of.column, j, values[of.component]);
    }
    if (!recorder_) continue;
    const int lane = static_cast<int>(j);
    const std::vector<double>& row =
        recorder_->Row({&loop_.exact(), &loop_.seen(), &loop_.commands(), loop_.plant().world(),
                        &loop_.timeline(lane), lane});
    for (std::size_t i = 0; i < row.size(); ++i) put(others_[i], j, row[i]);
  }
}

void Observer::Begin(int lane, int delay) {
  const auto j = static_cast<std::size_t>(lane);
  delay_[j] = static_cast<std::size_t>(delay);
  for (std::size_t slot = 0; slot < slots_; ++slot) {
    for (std::size_t i = 0; i < count_; ++i) At(slot, i, j) = At(now_, i, j);
  }
}

namespace {

/// A double may be beyond what a float can be.
template <class T>
T Number(double x) {
  constexpr double kMost = std::numeric_limits<T>::max();
  return static_cast<T>(x > kMost ? kMost : x < -kMost ? -kMost : x);
}

}  // namespace

template <class T>
void Observer::Emit(int lane, T* row) const {
  const auto j = static_cast<std::size_t>(lane);
  const double* const from = &ring_[(now_ + slots_ - delay_[j]) % slots_ * count_ * lanes_];
  for (std::size_t i = 0; i < count_; ++i) row[i] = Number<T>(from[i * lanes_ + j]);
}
template void Observer::Emit(int lane, float* row) const;
template void Observer::Emit(int lane, double* row) const;

}  // namespace taut::env
