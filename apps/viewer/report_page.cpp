#include "report.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "protocol_messages.h"
#include "report_facts.h"
#include "taut/compare.h"
#include "taut/files.h"
#include "web_files.h"

namespace taut::viewer {
namespace {

constexpr double kFramesPerS = 30;
constexpr std::size_t kMaxFrames = 4000;

std::string Base64(const std::string& bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

/// Returns whether a report plots a channel. Orientations, contacts and bends are contained in its
/// frames; velocities would only enlarge it.
bool IsPlotted(const ChannelInfo& channel) {
  if (channel.name.starts_with("contact/")) return false;
  if (channel.name.starts_with("cable/") &&
      channel.name.substr(channel.name.rfind('/')).starts_with("/bend_")) {
    return false;
  }
  return !channel.name.starts_with("body/") || channel.name.find("/position_") != std::string::npos;
}

std::vector<ChannelInfo> Plotted(const std::vector<ChannelInfo>& channels) {
  std::vector<ChannelInfo> plotted;
  std::copy_if(channels.begin(), channels.end(), std::back_inserter(plotted), IsPlotted);
  return plotted;
}

void AppendNumbers(const std::vector<double>& numbers, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double));
}

/// Returns the Rows of web/protocol/messages.json: all rows of the plotted channels, or, above
/// `max_numbers` numbers, the smallest blocks of rows within this limit.
Json RowsOf(const Recorded& recorded, const Trace& trace, int source, std::size_t max_numbers) {
  const std::vector<ChannelInfo> channels = Plotted(trace.channels);
  const std::size_t rows = trace.time_s.size();
  std::size_t level = 1;
  const auto count = [&] { return (rows + level - 1) / level; };
  while (count() > 1 && count() * (1 + channels.size() * (level == 1 ? 1 : 3)) > max_numbers) {
    level *= 2;
  }
  Json names = Json::array();
  std::vector<double> times;
  for (std::size_t row = 0; row < rows; row += level) times.push_back(trace.time_s[row]);
  std::string bytes;
  AppendNumbers(times, bytes);
  for (const ChannelInfo& channel : channels) {
    names.push_back(channel.name);
    const auto series = recorded.SeriesOf(channel.name, source, times.front(), HUGE_VAL, count());
    AppendNumbers(series->first, bytes);
    if (level == 1) continue;
    AppendNumbers(series->min, bytes);
    AppendNumbers(series->max, bytes);
  }
  return {{"source", source},
          {"level", level},
          {"count", count()},
          {"channels", names},
          {"base64", Base64(bytes)}};
}

void AddFrames(const Recorded& recorded, Json& report) {
  const std::vector<double>& times = recorded.trace().time_s;
  const double span_s = times.back() - times.front();
  const auto frames =
      std::clamp<std::size_t>(static_cast<std::size_t>(std::min(span_s * kFramesPerS, 1e9)) + 1, 1,
                              std::min(kMaxFrames, times.size()));
  std::vector<Frame> all;
  std::size_t pushes = 0, contacts = 0, bends = 0, spans = 0;
  for (std::size_t i = 0; i < frames; ++i) {
    const double share = frames == 1 ? 0 : static_cast<double>(i) / static_cast<double>(frames - 1);
    // The time of a row may be reached only within round-off.
    all.push_back(recorded.FrameOf(recorded.RowAt(times.front() + share * span_s + 1e-9)));
    pushes = std::max(pushes, all.back().pushes.size());
    contacts = std::max(contacts, all.back().contacts.size());
    bends = std::max(bends, all.back().bends.size());
    spans = std::max(spans, all.back().spans.size());
  }
  std::string bytes;
  std::size_t values = 0;
  for (Frame& frame : all) {
    // all frames must have the same size; added entries have no force, or no cable
    frame.pushes.resize(pushes);
    frame.contacts.resize(contacts);
    frame.bends.resize(bends);
    frame.spans.resize(spans);
    frame.run = 1;
    frame.now_s = frame.time_s;
    const std::vector<double> numbers = FrameNumbers(frame);
    values = numbers.size();
    AppendNumbers(numbers, bytes);
  }
  report["frame_count"] = frames;
  report["frame_values"] = values;
  report["frames_base64"] = Base64(bytes);
}

std::string ReadText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

Json ReportOf(const Recorded& recorded, std::size_t max_numbers) {
  Json report;
  report["version"] = kProtocolVersion;
  report["title"] = recorded.title();
  report["scene"] = recorded.scene();
  report["scene"]["channels"] = ToJson(Plotted(recorded.trace().channels));
  const auto& experiment = recorded.experiment();
  report["description"] = experiment ? experiment->description : "";
  report["facts"] = experiment ? FactsOf(*experiment) : Json::object();
  report["metadata"] = Json::object();
  for (const auto& [key, text] : recorded.trace().metadata) report["metadata"][key] = text;
  report["inputs"] = recorded.inputs();
  report["summary"] = recorded.summary();
  report["comparisons"] = Json::array();
  const std::size_t share = max_numbers / (1 + recorded.compared().size());
  report["rows"] = Json::array({RowsOf(recorded, recorded.trace(), 0, share)});
  CompareOptions options;
  if (experiment) {
    for (const PhaseSpec& phase : experiment->phases) {
      options.phases.push_back({phase.name, phase.from_s, phase.to_s});
    }
  }
  for (std::size_t k = 0; k < recorded.compared().size(); ++k) {
    const Recorded& run = *recorded.compared()[k];
    report["scene"]["compared"][k]["channels"] = ToJson(Plotted(run.trace().channels));
    report["rows"].push_back(RowsOf(recorded, run.trace(), static_cast<int>(k + 1), share));
    // difference of the compared run from this run
    report["comparisons"].push_back(
        Json::parse(ComparisonJson(Compare(run.trace(), recorded.trace(), options), run.run_name(),
                                   recorded.run_name()),
                    nullptr, false));
  }
  AddFrames(recorded, report);
  return report;
}

std::optional<std::string> ReportPage(const Json& report, const std::string& page) {
  static constexpr std::string_view kPlace =
      R"(<script type="application/json" id="taut-report"></script>)";
  const std::size_t at = page.find(kPlace);
  if (at == page.npos) return std::nullopt;
  std::string data;
  for (const char c : Dump(report)) {
    if (c == '<') {
      data += "\\u003c";  // so that no data can end the surrounding element
    } else {
      data += c;
    }
  }
  const std::size_t end = at + kPlace.size() - std::strlen("</script>");
  return page.substr(0, end) + data + page.substr(end);
}

bool WriteReport(const std::string& trace, const std::vector<std::string>& compare,
                 const std::string& path, Diagnostics& out) {
  std::string error;
  const std::optional<std::string> folder = FindWebFolder(error);
  if (!folder) {
    out.Error("report.not_made", {path}, "cannot create the report: " + error);
    return false;
  }
  const auto recorded = Recorded::Load(trace, compare, out);
  if (!recorded) return false;
  if (!recorded->notice().empty()) out.Warning("trace.notice", {trace}, recorded->notice());
  const auto page = ReportPage(ReportOf(*recorded), ReadText(*folder + "/report.html"));
  if (!page) {
    out.Error("report.foreign_page", {*folder + "/report.html"},
              "this page is not the template of reports",
              "build the viewer's pages again: script/build");
    return false;
  }
  return WriteWholeFile(path, *page, out);
}

}  // namespace taut::viewer
