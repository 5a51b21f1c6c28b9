// Traces from MCAP files: messages of any topic as columns over one time axis.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
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

/// Reason why a file exceeds the limits; kFits: it does not.
enum class Excess { kFits, kValues, kNames, kTable };

/// Columns in the order of their first value; each value is a row of its time.
class Columns {
 public:
  /// Begins a message of a topic.
  void Begin(std::uint16_t topic, std::uint64_t time_ns) { times_ns_[topic].push_back(time_ns); }

  Excess Add(std::uint16_t topic, std::uint64_t time_ns, const std::string& name, double value) {
    if (name.size() > kMostMcapNameBytes) return Excess::kNames;
    const auto [at, fresh] = places_.emplace(name, columns_.size());
    if (fresh) columns_.push_back({name, topic, {}});
    columns_[at->second].points.emplace_back(time_ns, value);
    const bool fits = ++values_ <= kMostMcapValues && columns_.size() <= kMostMcapChannels;
    return fits ? Excess::kFits : Excess::kValues;
  }

  /// Returns the trace. Of two values at one time the last counts; values before the first and
  /// after the last message of a topic, and in its gaps, are NaN. Returns nothing if the table of
  /// all times and columns would have too many values: a few megabytes of messages, each with
  /// another number, would fill the memory.
  std::optional<Trace> Take() {
    std::map<std::uint64_t, std::size_t> rows;
    for (const Column& column : columns_) {
      for (const auto& point : column.points) rows.emplace(point.first, 0);
    }
    Trace trace;
    if (rows.empty()) return trace;
    if (rows.size() * columns_.size() > kMostMcapValues) return std::nullopt;
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
      Spread(column, trace.time_s, rows, values);
      column.points = {};
    }
    return trace;
  }

 private:
  struct Column {
    std::string name;
    std::uint16_t topic;
    std::vector<std::pair<std::uint64_t, double>> points;
  };
  /// Sets the values at the times of the column's messages, and interpolates between neighboring
  /// messages, because each topic has its own times. Distances of more than `kGap` times the median
  /// are gaps.
  void Spread(const Column& column, const std::vector<double>& time_s,
              const std::map<std::uint64_t, std::size_t>& rows, std::vector<double>& values) const {
    constexpr double kGap = 5;
    std::vector<std::size_t> known;
    for (const auto& [time_ns, value] : column.points) values[rows.at(time_ns)] = value;
    // A message of the topic without this number is a gap.
    for (const std::uint64_t time_ns : times_ns_.at(column.topic)) {
      const auto row = rows.find(time_ns);
      if (row != rows.end()) known.push_back(row->second);
    }
    std::sort(known.begin(), known.end());
    known.erase(std::unique(known.begin(), known.end()), known.end());
    std::vector<double> steps_s;
    for (std::size_t i = 1; i < known.size(); ++i) {
      steps_s.push_back(time_s[known[i]] - time_s[known[i - 1]]);
    }
    if (steps_s.empty()) return;
    std::vector<double> sorted = steps_s;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    for (std::size_t i = 1; i < known.size(); ++i) {
      if (steps_s[i - 1] > kGap * *middle) continue;
      const double from = values[known[i - 1]], to = values[known[i]];
      for (std::size_t row = known[i - 1] + 1; row < known[i]; ++row) {
        const double share = (time_s[row] - time_s[known[i - 1]]) / steps_s[i - 1];
        values[row] = from + share * (to - from);
      }
    }
  }

  std::vector<Column> columns_;
  std::map<std::uint16_t, std::vector<std::uint64_t>> times_ns_;  ///< Message times by channel.
  std::unordered_map<std::string, std::size_t> places_;
  std::size_t values_ = 0;
};

void JsonNumbers(const nlohmann::json& json, const std::string& path, int depth,
                 const std::function<void(const std::string&, double)>& number) {
  constexpr int kDeepestJson = 16;
  if (depth > kDeepestJson) return;
  // The name is refused as too long.
  if (path.size() > 2 * kMostMcapNameBytes) return number(path, 0);
  if (json.is_object()) {
    for (const auto& [key, value] : json.items()) {
      JsonNumbers(value, path + "/" + key, depth + 1, number);
    }
  } else if (json.is_array()) {
    constexpr std::size_t kMostJsonElements = 64;
    for (std::size_t i = 0; i < std::min(json.size(), kMostJsonElements); ++i) {
      JsonNumbers(json[i], path + "/" + std::to_string(i), depth + 1, number);
    }
  } else if (json.is_boolean()) {
    number(path, json.get<bool>() ? 1 : 0);
  } else if (json.is_number()) {
    number(path, json.get<double>());
  } else if (json.is_null()) {  // taut writes NaN as null
    number(path, std::numeric_limits<double>::quiet_NaN());
  }
}

/// Returns whether taut wrote a topic for viewers only: it repeats values of the trace.
bool IsDrawing(const McapChannel& channel) {
  return channel.schema->name.starts_with("foxglove.Scene") ||
         channel.schema->name.starts_with("foxglove.FrameTransform");
}

/// Definition of messages; channels with the same schema share it.
struct Definition {
  std::shared_ptr<const McapSchema> schema;  ///< Keeps the key of the definition valid.
  std::optional<Ros2Message> message;
  std::string why;  ///< Reason why `message` is empty.
};

void RefuseSize(const std::string& path, Excess excess, Diagnostics& out) {
  const char* const hint = "take a shorter part of the bag, or fewer topics";
  if (excess == Excess::kNames) {
    out.Error("mcap.long_name", {path},
              fmt::format("the name of a channel has more than {} bytes", kMostMcapNameBytes),
              hint);
  } else if (excess == Excess::kTable) {
    out.Error("mcap.too_large_table", {path},
              "the table of all message times and channels has more than 100 million "
              "values",
              hint);
  } else {
    out.Error("mcap.too_large", {path},
              "the file has more than 100000 channels or 100 million "
              "values",
              hint);
  }
}

}  // namespace

std::optional<Trace> ReadMcap(const std::string& path, Diagnostics& out) {
  McapReader reader(path, out);
  Columns columns;
  std::map<const McapSchema*, Definition> definitions;
  std::map<std::uint16_t, std::string> unread;  // channels without numbers that taut can decode
  Excess excess = Excess::kFits;
  const auto leave_out = [&](std::uint16_t channel, const std::string& why) {
    if (unread.contains(channel)) return;
    unread[channel] = reader.channels().at(channel).topic + (why.empty() ? "" : " (" + why + ")");
  };
  const auto use = [&](const McapMessage& message) {
    const McapChannel& channel = reader.channels().at(message.channel);
    const std::string head =
        channel.topic.starts_with('/') ? channel.topic.substr(1) : channel.topic;
    const auto add = [&](const std::string& name, double value) {
      if (excess != Excess::kFits) return;
      excess = columns.Add(message.channel, message.log_time_ns, name, value);
    };
    const auto fits = [&] { return excess == Excess::kFits; };
    if (IsDrawing(channel)) return true;
    columns.Begin(message.channel, message.log_time_ns);
    if (channel.encoding == "json") {
      const auto json = nlohmann::json::parse(message.data, nullptr, false);
      if (json.is_discarded()) leave_out(message.channel, "a message is not JSON");
      const std::string top = head == "values" ? "" : "/" + head;
      JsonNumbers(json, top, 0, [&](const std::string& name, double value) {
        if (fits()) add(name.substr(1), value);
      });
      return fits();
    }
    if (channel.encoding != "cdr" || channel.schema->encoding != "ros2msg") {
      leave_out(message.channel,
                "its encoding is " + channel.encoding + ", " + channel.schema->encoding);
      return true;
    }
    const auto [at, fresh] = definitions.try_emplace(channel.schema.get());
    Definition& definition = at->second;
    if (fresh) {
      definition.schema = channel.schema;
      definition.message =
          Ros2Message::Parse(channel.schema->name, channel.schema->text, definition.why);
    }
    const bool decoded =
        definition.message &&
        definition.message->Decode(message.data, [&](const std::string& name, double value) {
          add(head + "/" + name, value);
        });
    if (!decoded) leave_out(message.channel, definition.why);
    return fits();
  };
  if (!reader.Read(use)) return std::nullopt;
  std::optional<Trace> table;
  if (excess == Excess::kFits) {
    table = columns.Take();
    if (!table) excess = Excess::kTable;
  }
  if (!table) {
    RefuseSize(path, excess, out);
    return std::nullopt;
  }
  Trace trace = std::move(*table);
  std::set<std::string> topics;
  for (const auto& [channel, topic] : unread) topics.insert(topic);
  for (const std::string& topic : topics) {
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
