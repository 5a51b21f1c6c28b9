// Traces from MCAP files: messages of any topic as columns over one time axis.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <unordered_map>

#include "trace/channel_names.h"
#include "trace/mcap_reader.h"
#include "trace/readers.h"
#include "trace/ros2_message.h"

namespace taut::trace {
namespace {

/// Clocks that count from 1970 begin later than this; the first message is then at 0 s.
constexpr double kEpoch_s = 1e8;
constexpr std::size_t kMostMcapValues = 100'000'000;
constexpr std::size_t kMostMcapChannels = 100'000;

/// Columns in the order of their first value; each value is a row of its time.
class Columns {
 public:
  bool Add(std::uint64_t time_ns, const std::string& name, double value) {
    const auto [at, fresh] = places_.emplace(name, columns_.size());
    if (fresh) columns_.push_back({name, {}});
    columns_[at->second].points.emplace_back(time_ns, value);
    return ++values_ <= kMostMcapValues && columns_.size() <= kMostMcapChannels;
  }

  /// Numbers of a time without a value are NaN; of two values the last one counts.
  Trace Take() {
    std::map<std::uint64_t, std::size_t> rows;
    for (const Column& column : columns_) {
      for (const auto& point : column.points) rows.emplace(point.first, 0);
    }
    Trace trace;
    if (rows.empty()) return trace;
    const std::uint64_t first_ns = rows.begin()->first;
    const std::uint64_t zero_ns = 1e-9 * static_cast<double>(first_ns) > kEpoch_s ? first_ns : 0;
    for (auto& [time_ns, row] : rows) {
      row = trace.time_s.size();
      trace.time_s.push_back(static_cast<double>(time_ns - zero_ns) / 1e9);
    }
    for (Column& column : columns_) {
      trace.channels.push_back({column.name, UnitOfName(column.name)});
      auto& values =
          trace.values.emplace_back(rows.size(), std::numeric_limits<double>::quiet_NaN());
      for (const auto& [time_ns, value] : column.points) values[rows.at(time_ns)] = value;
      column.points = {};
    }
    return trace;
  }

 private:
  struct Column {
    std::string name;
    std::vector<std::pair<std::uint64_t, double>> points;
  };
  std::vector<Column> columns_;
  std::unordered_map<std::string, std::size_t> places_;
  std::size_t values_ = 0;
};

void JsonNumbers(const nlohmann::json& json, const std::string& path, int depth,
                 const std::function<void(const std::string&, double)>& number) {
  constexpr int kDeepestJson = 16;
  if (depth > kDeepestJson) return;
  if (json.is_object()) {
    for (const auto& [key, value] : json.items()) {
      JsonNumbers(value, path + "/" + key, depth + 1, number);
    }
  } else if (json.is_number()) {
    number(path, json.get<double>());
  } else if (json.is_null()) {  // taut writes NaN so
    number(path, std::numeric_limits<double>::quiet_NaN());
  }
}

/// Topics that taut adds for viewers repeat values of the trace.
bool IsDrawing(const McapChannel& channel) {
  return channel.schema_name.starts_with("foxglove.Scene") ||
         channel.schema_name.starts_with("foxglove.FrameTransform");
}

}  // namespace

std::optional<Trace> ReadMcap(const std::string& path, Diagnostics& out) {
  McapReader reader(path, out);
  Columns columns;
  std::map<std::uint16_t, std::optional<Ros2Message>> types;
  std::set<std::string> unread;  // topics without numbers that taut can decode
  bool fits = true;
  std::string why;
  const auto use = [&](const McapMessage& message) {
    const McapChannel& channel = reader.channels().at(message.channel);
    const std::string head =
        channel.topic.starts_with('/') ? channel.topic.substr(1) : channel.topic;
    const auto add = [&](const std::string& name, double value) {
      fits = fits && columns.Add(message.log_time_ns, name, value);
    };
    if (channel.encoding == "json") {
      if (IsDrawing(channel)) return true;
      const auto json = nlohmann::json::parse(message.data, nullptr, false);
      const std::string top = head == "values" ? "" : "/" + head;
      JsonNumbers(json, top, 0,
                  [&](const std::string& name, double value) { add(name.substr(1), value); });
      return fits;
    }
    auto type = types.find(message.channel);
    if (type == types.end()) {
      const bool known = channel.encoding == "cdr" && channel.schema_encoding == "ros2msg";
      if (!known) why = "its encoding is " + channel.encoding + ", " + channel.schema_encoding;
      type = types
                 .emplace(message.channel,
                          known ? Ros2Message::Parse(channel.schema_name, channel.schema, why)
                                : std::nullopt)
                 .first;
    }
    const bool decoded =
        type->second &&
        type->second->Decode(message.data, [&](const std::string& name, double value) {
          add(head + "/" + name, value);
        });
    if (!decoded) unread.insert(channel.topic + (why.empty() ? "" : " (" + why + ")"));
    return fits;
  };
  if (!reader.Read(use)) return std::nullopt;
  if (!fits) {
    out.Error("mcap.too_large", {path},
              "the file has more than 100000 channels or 100 million "
              "values",
              "take a shorter part of the bag, or fewer topics");
    return std::nullopt;
  }
  Trace trace = columns.Take();
  for (const std::string& topic : unread) {
    out.Warning("mcap.topic_left_out", {path}, "the topic " + topic + " is left out",
                "taut reads JSON, and CDR with ros2msg definitions");
  }
  if (trace.channels.empty()) {
    out.Error("mcap.no_numbers", {path}, "the file has no topic with numbers that taut can read");
    return std::nullopt;
  }
  trace.metadata = reader.metadata();
  trace.unfinished = reader.unfinished();
  if (!CheckChannelNames(path, trace.channels, out)) return std::nullopt;
  return trace;
}

}  // namespace taut::trace
