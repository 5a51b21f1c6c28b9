#include "taut/convert_trace.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/pattern.h"
#include "export/message_tree.h"
#include "export/robot_scene.h"
#include "taut/version.h"
#include "trace/mcap_writer.h"
#include "trace/whole_csv.h"

namespace taut {
namespace {

constexpr std::size_t kAskEvery = 256;   // number of rows between calls of `go_on`
constexpr double kMostSeconds = 1.8e10;  // limit of times in 64-bit nanoseconds
constexpr char kNoGroup[] = "values";    // the topic of names without a slash

/// Calls `go_on` at every 256th row. Returns false if the caller wants to stop.
bool GoesOn(const GoOn& go_on, std::size_t row, std::size_t rows) {
  return !go_on || row % kAskEvery != 0 ||
         go_on(static_cast<double>(row) / static_cast<double>(rows));
}

/// Channels of one MCAP topic.
struct Group {
  std::string name;
  exporting::MessageTree messages;
  std::uint16_t channel = 0;
};

class ToMcap {
 public:
  ToMcap(const Trace& trace, const ModelDef* robot, const std::string& path)
      : trace_(trace), robot_(robot), file_(path) {}

  Conversion Run(const GoOn& go_on) {
    if (!file_.Start(std::string("taut ") + kVersion, trace_.metadata)) return Conversion::kFailed;
    AddTopics();
    const std::size_t rows = trace_.time_s.size();
    const double zero_s = rows > 0 ? std::min(trace_.time_s.front(), 0.0) : 0.0;
    for (std::size_t row = 0; row < rows; ++row) {
      if (!GoesOn(go_on, row, rows)) return Conversion::kStopped;
      const auto time_ns =
          static_cast<std::uint64_t>(std::llround(1e9 * (trace_.time_s[row] - zero_s)));
      if (!WriteRow(row, time_ns)) return Conversion::kFailed;
    }
    return file_.Finish() ? Conversion::kDone : Conversion::kFailed;
  }
  const std::string& why() const { return file_.why(); }

 private:
  void AddTopics() {
    bodies_ = exporting::BodiesOf(trace_);
    const std::string scene = exporting::SceneSchema();
    if (!bodies_.empty()) {
      frames_ = file_.AddChannel("/tf", "foxglove.FrameTransforms", exporting::FramesSchema());
    }
    if (robot_ != nullptr && !bodies_.empty()) {
      shapes_ = file_.AddChannel("/scene/robot", "foxglove.SceneUpdate", scene);
      cables_ = exporting::CableLines::Of(*robot_, trace_, bodies_);
      if (cables_) lines_ = file_.AddChannel("/scene/cables", "foxglove.SceneUpdate", scene);
    }
    for (std::size_t c = 0; c < trace_.channels.size(); ++c) {
      const std::string& name = trace_.channels[c].name;
      const std::size_t slash = name.find('/');
      const std::string topic = slash == name.npos ? kNoGroup : name.substr(0, slash);
      auto group = std::find_if(groups_.begin(), groups_.end(),
                                [&](const Group& one) { return one.name == topic; });
      if (group == groups_.end()) {
        groups_.emplace_back().name = topic;
        group = groups_.end() - 1;
      }
      group->messages.Add(slash == name.npos ? name : name.substr(slash + 1), c);
    }
    for (Group& group : groups_) {
      group.channel =
          file_.AddChannel("/" + group.name, "taut." + group.name, group.messages.Schema(trace_));
    }
  }

  bool WriteRow(std::size_t row, std::uint64_t time_ns) {
    if (frames_ > 0 &&
        !file_.Write(frames_, time_ns, exporting::FramesAt(trace_, bodies_, row, time_ns))) {
      return false;
    }
    if (shapes_ > 0 && row == 0 &&
        !file_.Write(shapes_, time_ns, exporting::RobotShapes(*robot_, time_ns))) {
      return false;
    }
    if (lines_ > 0 && !file_.Write(lines_, time_ns, cables_->At(trace_, row, time_ns))) {
      return false;
    }
    for (const Group& group : groups_) {
      json_.clear();
      group.messages.Write(trace_, row, json_);
      if (!file_.Write(group.channel, time_ns, json_)) return false;
    }
    return true;
  }

  const Trace& trace_;
  const ModelDef* robot_;
  trace::McapWriter file_;
  std::vector<exporting::BodyChannels> bodies_;
  std::optional<exporting::CableLines> cables_;
  std::uint16_t frames_ = 0, shapes_ = 0, lines_ = 0;  ///< MCAP channel ids; 0: none.
  std::vector<Group> groups_;
  std::string json_;
};

}  // namespace

std::optional<Trace> SelectFrom(Trace trace, const std::vector<std::string>& channels,
                                double period_s, const std::string& path, Diagnostics& out) {
  std::vector<std::size_t> rows;
  double next_s = trace.time_s.empty() ? 0 : trace.time_s.front();
  const double first_s = next_s;
  for (std::size_t row = 0; row < trace.time_s.size(); ++row) {
    const double time_s = trace.time_s[row];
    // The tolerance accepts rows whose times are rounded slightly below the period's grid.
    if (period_s > 0 && time_s < next_s - 1e-6 * period_s) continue;
    rows.push_back(row);
    if (period_s > 0) {
      next_s = first_s + (std::floor((time_s - first_s) / period_s + 1e-6) + 1) * period_s;
    }
  }
  const auto thin = [&](std::vector<double>& column) {
    for (std::size_t i = 0; i < rows.size(); ++i) column[i] = column[rows[i]];
    column.resize(rows.size());
  };
  Trace kept;
  for (std::size_t c = 0; c < trace.channels.size(); ++c) {
    if (!base::FitsAny(channels, trace.channels[c].name)) continue;
    kept.channels.push_back(trace.channels[c]);
    kept.values.push_back(std::move(trace.values[c]));
    thin(kept.values.back());
  }
  if (kept.channels.empty()) {
    out.Error("trace.no_matching_channel", {path, 0, 0},
              "no channel of the trace matches the patterns",
              trace.channels.empty()
                  ? "the trace has no channels"
                  : "the trace has channels such as \"" + trace.channels.front().name + "\"");
    return std::nullopt;
  }
  kept.time_s = std::move(trace.time_s);
  thin(kept.time_s);
  kept.metadata = std::move(trace.metadata);
  kept.unfinished = trace.unfinished;
  return kept;
}

Conversion WriteTraceCsv(const Trace& trace, const std::string& path, const GoOn& go_on,
                         Diagnostics& out) {
  const auto writer = trace::CreateWholeCsvTrace(path, trace.channels, out);
  if (!writer) return Conversion::kFailed;
  const std::size_t rows = trace.time_s.size();
  std::vector<double> values(trace.channels.size());
  for (std::size_t row = 0; row < rows; ++row) {
    if (!GoesOn(go_on, row, rows)) return Conversion::kStopped;
    for (std::size_t c = 0; c < values.size(); ++c) values[c] = trace.values[c][row];
    if (!writer->Append(trace.time_s[row], values.data())) break;
  }
  if (writer->Finish()) return Conversion::kDone;
  out.Error("trace.not_written", {}, writer->error());
  return Conversion::kFailed;
}

Conversion WriteTraceMcap(const Trace& trace, const ModelDef* robot, const std::string& path,
                          const GoOn& go_on, Diagnostics& out) {
  if (!trace.time_s.empty() &&
      !(trace.time_s.back() - std::min(trace.time_s.front(), 0.0) < kMostSeconds)) {
    out.Error("trace.times_too_long", {path, 0, 0},
              "times beyond 570 years do not fit into the file");
    return Conversion::kFailed;
  }
  ToMcap to(trace, robot, path);
  const Conversion end = to.Run(go_on);
  if (end == Conversion::kFailed) {
    out.Error("file.not_writable", {path, 0, 0}, "cannot write: " + to.why());
  }
  return end;
}

}  // namespace taut
