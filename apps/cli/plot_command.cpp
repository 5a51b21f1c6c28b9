// Command `taut plot`: figures of runs for papers. It checks the arguments and reads the traces;
// matplotlib draws.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "figure_program.h"
#include "output.h"
#include "overrides.h"
#include "shipped_inputs.h"
#include "standard_streams.h"
#include "taut/compare.h"
#include "taut/run_folder.h"
#include "taut/trace_channels.h"

namespace taut::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostRuns = 4, kMostChannels = 24;
const std::vector<std::string> kFigureFormats{".pdf", ".svg", ".png"};
const std::vector<std::string> kLayouts{"one", "many"};

struct PlotArguments {
  std::vector<std::string> runs, channels{"cable/*/tension_n"};
  std::string measured, map, out, layout;
  double width_mm = 88, dpi = 300;
  std::optional<double> height_mm, from_s, to_s;
};

/// Channel to draw, with its unit.
struct Drawn {
  std::string name, unit;
};

/// Returns the channels of the first run that match the patterns, in the order of the patterns.
std::vector<Drawn> Chosen(const PlotArguments& args, const Trace& run, Diagnostics& out) {
  std::vector<Drawn> drawn;
  std::vector<std::string> names;
  for (const ChannelInfo& channel : run.channels) names.push_back(channel.name);
  for (const std::string& pattern : args.channels) {
    const std::vector<std::size_t> matching = MatchingChannels(run, pattern);
    for (const std::size_t i : matching) {
      const ChannelInfo& channel = run.channels[i];
      const bool twice =
          std::ranges::any_of(drawn, [&](const Drawn& one) { return one.name == channel.name; });
      if (!twice) drawn.push_back({channel.name, channel.unit});
    }
    if (matching.empty()) {
      out.Error("plot.no_such_channel", {args.runs.front()},
                fmt::format("no channel matches \"{}\"", pattern), DidYouMean(pattern, names));
    }
  }
  return drawn;
}

/// Checks that one figure can show the channels.
void CheckDrawn(const PlotArguments& args, const std::vector<Drawn>& drawn, Diagnostics& out) {
  if (drawn.size() > kMostChannels) {
    out.Error(
        "plot.too_many_channels", {},
        fmt::format("{} channels match; a figure shows at most {}", drawn.size(), kMostChannels),
        "choose fewer with --channels, such as 'cable/outer_*/tension_n'");
  }
  const auto other =
      std::ranges::find_if(drawn, [&](const Drawn& one) { return one.unit != drawn.front().unit; });
  if (args.layout == "one" && other != drawn.end()) {
    out.Error("plot.units_on_one_axis", {},
              fmt::format("one axis cannot show {} [{}] and {} [{}]", drawn.front().name,
                          drawn.front().unit, other->name, other->unit),
              "choose channels with one unit, or --layout many");
  }
}

/// Returns the rows of the drawn channels within the time span, for the program that draws.
Json Sent(const Trace& trace, const std::vector<Drawn>& drawn, const PlotArguments& args) {
  const auto first =
      args.from_s ? std::ranges::lower_bound(trace.time_s, *args.from_s) : trace.time_s.begin();
  const auto last =
      args.to_s ? std::upper_bound(first, trace.time_s.end(), *args.to_s) : trace.time_s.end();
  const auto from = first - trace.time_s.begin(), to = last - trace.time_s.begin();
  Json values = Json::object();
  for (const Drawn& channel : drawn) {
    const auto at = trace.Find(channel.name);
    if (!at) continue;
    const std::vector<double>& column = trace.values[*at];
    values[channel.name] = std::vector<double>(column.begin() + from, column.begin() + to);
  }
  return {{"time_s", std::vector<double>(first, last)}, {"values", std::move(values)}};
}

bool HasAny(const Trace& trace, const std::vector<Drawn>& drawn) {
  return std::ranges::any_of(drawn,
                             [&](const Drawn& one) { return trace.Find(one.name).has_value(); });
}

Json OrNull(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

void CheckOut(const PlotArguments& args, Diagnostics& out) {
  const std::string format = std::filesystem::path(args.out).extension().string();
  if (std::ranges::find(kFigureFormats, format) == kFigureFormats.end()) {
    out.Error("plot.unknown_format", {args.out},
              fmt::format("unknown figure format \"{}\"", format), "expected .pdf, .svg or .png");
  }
  if (args.from_s && args.to_s && *args.from_s >= *args.to_s) {
    out.Error("plot.empty_span", {},
              fmt::format("--from_s {} is not before --to_s {}", *args.from_s, *args.to_s));
  }
  if (!args.map.empty() && args.measured.empty()) {
    out.Error("plot.map_of_nothing", {}, "--map needs a measurement",
              "name the measurement with --with");
  }
}

int Plot(PlotArguments args) {
  Diagnostics found;
  CheckOut(args, found);
  for (std::string& run : args.runs) run = TraceOfRun(run);
  std::vector<std::optional<Trace>> runs;
  for (const std::string& run : args.runs) runs.push_back(ReadTraceOrLog(run, "", "drawn", found));
  std::optional<Trace> measured;
  if (!args.measured.empty()) {
    args.measured = TraceOfRun(args.measured);
    measured = ReadTraceOrLog(args.measured, args.map, "drawn", found);
  }
  std::vector<Drawn> drawn;
  if (runs.front()) {
    drawn = Chosen(args, *runs.front(), found);
    CheckDrawn(args, drawn, found);
  }
  for (std::size_t i = 1; i < runs.size(); ++i) {
    if (runs[i] && !drawn.empty() && !HasAny(*runs[i], drawn)) {
      found.Error(
          "plot.nothing_in_common", {args.runs[i]},
          fmt::format("the run has none of the drawn channels, such as {}", drawn.front().name));
    }
  }
  if (measured && !drawn.empty() && !HasAny(*measured, drawn)) {
    found.Error("plot.nothing_measured", {args.measured},
                fmt::format("the measurement has none of the drawn channels, such as {}",
                            drawn.front().name),
                "write a mapping with `taut new mapping` and pass it to --map");
  }
  if (!found.ok()) return Fail(found, kBadInput);
  Pass(found, false);

  Json units = Json::array(), sent = Json::array();
  for (const Drawn& channel : drawn) units.push_back({channel.name, channel.unit});
  for (const auto& run : runs) sent.push_back(Sent(*run, drawn, args));
  const Json request{{"paths", args.runs},
                     {"format", std::filesystem::path(args.out).extension().string()},
                     {"units", units},
                     {"runs", std::move(sent)},
                     {"measured", measured ? Sent(*measured, drawn, args) : Json()},
                     {"layout", args.layout},
                     {"from_s", OrNull(args.from_s)},
                     {"to_s", OrNull(args.to_s)},
                     {"width_mm", args.width_mm},
                     {"height_mm", OrNull(args.height_mm)},
                     {"dpi", args.dpi}};
  OutputIsNews();
  const auto figure =
      DrawFigure(request.dump(-1, ' ', false, Json::error_handler_t::replace), found);
  if (!figure) return Fail(found, kFailed);
  if (const int failed = WriteNamed(args.out, *figure); failed != kOk) return failed;
  fmt::print("Figure: {} ({} channels, {} mm wide)\n", args.out, drawn.size(), args.width_mm);
  SayNextProgram({"xdg-open", args.out});
  return kOk;
}

}  // namespace

void AddPlot(CLI::App& app, int& exit_code) {
  auto args = std::make_shared<PlotArguments>();
  CLI::App* command = app.add_subcommand("plot", "Draw channels of runs as a figure for a paper.");
  command
      ->add_option("RUN", args->runs,
                   "Folders of runs, or traces, at most 4; a line style for each")
      ->required()
      ->expected(1, static_cast<int>(kMostRuns));
  command->add_option("--out", args->out, "Figure: .pdf, .svg or .png")
      ->required()
      ->option_text("FILE");
  command
      ->add_option("--channels", args->channels,
                   "Channels to draw, by patterns (default: 'cable/*/tension_n')")
      ->option_text("PATTERN...");
  command->add_option("--with", args->measured, "Measurement to draw as dots: trace or log")
      ->option_text("FILE");
  AddInput(*command, "--map", {"mapping"}, args->map, "Mapping file of the measurement")
      ->option_text("FILE");
  command
      ->add_option("--layout", args->layout,
                   "one: all channels on one axis. many: a small plot for each (default: one for "
                   "at most 8 channels with one unit)")
      ->option_text(Alternatives(kLayouts))
      ->check(OneOf(kLayouts));
  command->add_option("--width_mm", args->width_mm, "Width of the figure [mm]")
      ->option_text("MM")
      ->check(NumberWithin(20, 2000))
      ->capture_default_str();
  command->add_option("--height_mm", args->height_mm, "Height [mm] (default: set by the layout)")
      ->option_text("MM")
      ->check(NumberWithin(10, 2000));
  command->add_option("--from_s", args->from_s, "Start of the figure [s]")
      ->option_text("S")
      ->check(NumberWithin(-1e9, 1e9));
  command->add_option("--to_s", args->to_s, "End of the figure [s]")
      ->option_text("S")
      ->check(NumberWithin(-1e9, 1e9));
  command->add_option("--dpi", args->dpi, "Resolution of a PNG [1/inch]")
      ->option_text("N")
      ->check(NumberWithin(20, 1200))
      ->capture_default_str();
  command->footer(
      "Examples:\n"
      "  taut plot runs/push_20n --channels 'cable/outer_*/tension_n' --out push.pdf\n"
      "  taut plot runs/drop --with lab.csv --map lab.map.json --out drop.pdf --width_mm 180\n"
      "  taut plot runs/drop runs/soft --channels 'body/*/position_z_m' --from_s 1 --out z.svg\n"
      "Every other phase of the first run is shaded. Requires Python 3 with matplotlib\n"
      "(python3-matplotlib).\n"
      "Exit status: 0 written, 1 not drawn, 2 bad usage, 3 bad input.");
  command->callback([args, &exit_code] { exit_code = Plot(*args); });
}

}  // namespace taut::cli
