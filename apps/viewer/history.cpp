#include "history.h"

#include <algorithm>

#include "pyramid.h"

namespace taut::viewer {
namespace {

/// Columns of a row in addition to bodies and cables.
enum System { kKinetic, kGravity, kElastic, kContacts, kRealTimeFactor, kSystemValues };
constexpr std::size_t kBodyValues = 7, kCableValues = 4;

template <class T>
void KeepEverySecond(std::vector<T>& list) {
  for (std::size_t i = 1; 2 * i < list.size(); ++i) list[i] = list[2 * i];
  list.resize((list.size() + 1) / 2);
}

}  // namespace

template <class T>
void History::Lists<T>::Add(const std::vector<T>& list) {
  items.insert(items.end(), list.begin(), list.end());
  ends.push_back(items.size());
}

template <class T>
std::vector<T> History::Lists<T>::Get(std::size_t row) const {
  const std::size_t begin = row == 0 ? 0 : ends[row - 1];
  return {items.begin() + static_cast<std::ptrdiff_t>(begin),
          items.begin() + static_cast<std::ptrdiff_t>(ends[row])};
}

template <class T>
void History::Lists<T>::Thin() {
  Lists kept;
  for (std::size_t row = 0; row < ends.size(); row += 2) kept.Add(Get(row));
  *this = std::move(kept);
}

History::History(const ModelDef& def, const std::vector<bool>& has_set_point, double period_s,
                 const std::vector<ChannelInfo>& recorded, std::size_t max_bytes)
    : bodies_(def.bodies.size()),
      cables_(def.cables.size()),
      max_bytes_(max_bytes),
      first_period_s_(period_s),
      period_s_(period_s),
      nodes_(def) {
  for (const char* energy : {"kinetic", "gravity", "elastic"}) {
    AddColumn(std::string("system/") + energy + "_j", "J");
  }
  AddColumn("system/contact_count", "1");
  AddColumn("real_time_factor", "1");
  for (const BodyDef& body : def.bodies) {
    for (const char* axis : {"x", "y", "z"}) {
      AddColumn("body/" + body.name + "/position_" + axis + "_m", "m");
    }
    for (const char* part : {"w", "x", "y", "z"}) {
      AddColumn("body/" + body.name + "/orientation_" + part, "1");
    }
  }
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    const std::string prefix = "cable/" + def.cables[c].name + "/";
    AddColumn(prefix + "tension_n", "N");
    AddColumn(prefix + "length_m", "m");
    AddColumn(prefix + "rest_length_m", "m");
    AddColumn(prefix + "setpoint_n", "N", has_set_point[c]);
  }
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    if (!places_.contains(recorded[i].name)) {
      AddColumn(recorded[i].name, recorded[i].unit);
      recorded_.push_back(i);
    }
    columns_of_row_.push_back(places_.at(recorded[i].name));
  }
  for (const ChannelInfo& node : nodes_.channels()) {
    if (!places_.contains(node.name)) channels_.push_back(node);
  }
}

void History::AddColumn(std::string name, std::string unit, bool is_channel) {
  if (is_channel) {
    places_[name] = columns_.size();
    channels_.push_back({std::move(name), std::move(unit)});
  }
  columns_.emplace_back();
}

void History::Clear() {
  period_s_ = first_period_s_;
  due_s_ = 0;
  time_s_.clear();
  for (auto& column : columns_) column.clear();
  contacts_ = {};
  pushes_ = {};
  bends_ = {};
  spans_ = {};
}

void History::Take(const Frame& frame, const std::vector<double>& row) {
  due_s_ = frame.time_s + period_s_ * (1 - 1e-9);  // tolerance: times are sums of steps
  time_s_.push_back(frame.time_s);
  std::size_t at = 0;
  const auto put = [&](double value) { columns_[at++].push_back(value); };
  for (const double value : {frame.energy.kinetic_j, frame.energy.gravity_j, frame.energy.elastic_j,
                             frame.contact_count, frame.real_time_factor}) {
    put(value);
  }
  for (const Frame::Body& body : frame.bodies) {
    const Vec3& p = body.position_m;
    const Quat& q = body.orientation;
    for (const double value : {p.x, p.y, p.z, q.w, q.x, q.y, q.z}) put(value);
  }
  for (const Frame::Cable& cable : frame.cables) {
    for (const double value :
         {cable.tension_n, cable.length_m, cable.rest_length_m, cable.setpoint_n}) {
      put(value);
    }
  }
  for (const std::size_t place : recorded_) put(row[place]);
  contacts_.Add(frame.contacts);
  pushes_.Add(frame.pushes);
  bends_.Add(frame.bends);
  spans_.Add(frame.spans);
  const std::size_t row_bytes = (1 + columns_.size()) * sizeof(double);
  const std::size_t list_bytes =
      contacts_.bytes() + pushes_.bytes() + bends_.bytes() + spans_.bytes();
  if (size() * row_bytes + list_bytes > max_bytes_) Thin();
}

void History::Thin() {
  if (size() < 2) return;
  KeepEverySecond(time_s_);
  for (auto& column : columns_) KeepEverySecond(column);
  contacts_.Thin();
  pushes_.Thin();
  bends_.Thin();
  spans_.Thin();
  period_s_ *= 2;
  due_s_ = time_s_.back() + period_s_ * (1 - 1e-9);
}

std::size_t History::RowAt(double time_s) const {
  const auto after = std::upper_bound(time_s_.begin(), time_s_.end(), time_s);
  return after == time_s_.begin() ? 0 : static_cast<std::size_t>(after - time_s_.begin()) - 1;
}

std::size_t History::PresentRow(double now_s) const {
  const std::size_t last = size() - 1;
  return time_s_[last] < now_s ? last + 1 : last;
}

std::optional<std::size_t> History::PastRow(double time_s, double now_s) const {
  if (!(time_s < now_s)) return std::nullopt;
  const std::size_t row = RowAt(time_s);
  return row < PresentRow(now_s) ? std::optional(row) : std::nullopt;
}

std::optional<std::size_t> History::Step(std::optional<std::size_t> row, int count,
                                         double now_s) const {
  const std::size_t present = PresentRow(now_s);
  const auto next = static_cast<std::int64_t>(row.value_or(present)) + count;
  if (next >= static_cast<std::int64_t>(present)) return std::nullopt;
  return static_cast<std::size_t>(std::max<std::int64_t>(next, 0));
}

void History::Show(std::size_t row, Frame& frame) const {
  frame.time_s = time_s_[row];
  const auto value = [&](std::size_t column) { return columns_[column][row]; };
  frame.energy = {value(kKinetic), value(kGravity), value(kElastic)};
  frame.contact_count = value(kContacts);
  std::size_t at = kSystemValues;
  frame.bodies.clear();
  for (std::size_t b = 0; b < bodies_; ++b, at += kBodyValues) {
    frame.bodies.push_back({{value(at), value(at + 1), value(at + 2)},
                            {value(at + 3), value(at + 4), value(at + 5), value(at + 6)}});
  }
  frame.cables.clear();
  for (std::size_t c = 0; c < cables_; ++c, at += kCableValues) {
    frame.cables.push_back({value(at), value(at + 1), value(at + 2), value(at + 3)});
  }
  frame.contacts = contacts_.Get(row);
  frame.pushes = pushes_.Get(row);
  frame.bends = bends_.Get(row);
  frame.spans = spans_.Get(row);
}

std::vector<double> History::Row(std::size_t row) const {
  std::vector<double> values;
  for (const std::size_t column : columns_of_row_) values.push_back(columns_[column][row]);
  return values;
}

Json History::SeriesOf(const std::string& channel, double t0, double t1, std::size_t points) const {
  // A pyramid would have to grow with every row; scanning so few rows is as fast.
  static const Pyramid no_levels{{}};
  const auto series = [&](const std::vector<double>& column) {
    return SeriesJson(channel, 0, no_levels.Get(time_s_, column, t0, t1, points));
  };
  const auto place = places_.find(channel);
  if (place != places_.end()) return series(columns_[place->second]);
  const auto node = nodes_.Find(channel);
  if (!node) return nullptr;
  NodeChannels::Poses poses;
  for (std::size_t i = 0; i < kBodyValues; ++i) {
    poses[i] = &columns_[kSystemValues + kBodyValues * static_cast<std::size_t>(node->body) + i];
  }
  return series(NodeChannels::Column(*node, poses));
}

}  // namespace taut::viewer
