// `taut trace convert`: a recording as CSV or MCAP.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "commands.h"
#include "interrupt.h"
#include "output.h"
#include "overrides.h"
#include "progress_line.h"
#include "standard_streams.h"
#include "taut/convert_trace.h"
#include "taut/run_folder.h"
#include "trace_command.h"

namespace taut::cli {
namespace {

namespace fs = std::filesystem;

struct ConvertArguments {
  std::string path, out;
  std::vector<std::string> channels;
  double period_s = 0;
  bool quiet = false;
};

/// Returns the recorded robot, from the inputs in the trace's folder; nothing if there are none.
std::optional<ModelDef> RobotOf(const std::string& trace, Diagnostics& out) {
  const std::string inputs = BesideTrace(trace, "inputs", ".yaml");
  std::error_code error;
  if (!fs::is_regular_file(inputs, error)) return std::nullopt;
  const auto experiment = LoadExperiment(inputs, {}, out);
  if (!experiment) return std::nullopt;
  return experiment->robot.def;
}

int Convert(const ConvertArguments& args) {
  const bool mcap = args.out.ends_with(".mcap");
  if (!mcap && !args.out.ends_with(".csv")) {
    fmt::print(stderr, "error: unknown format of {} (expected .csv or .mcap)\n", args.out);
    return kUsage;
  }
  const std::string path = TraceOfRun(args.path);
  Diagnostics found;
  auto whole = ReadTraceOfRun(path, found);
  if (!whole) return Fail(found, kBadInput);
  const auto trace = SelectFrom(std::move(*whole), args.channels, args.period_s, path, found);
  std::optional<ModelDef> robot;
  if (mcap) robot = RobotOf(path, found);
  if (!found.ok()) return Fail(found, kBadInput);
  WarnIfUnfinished(*trace, path, "converted", found);
  Pass(found, false);

  OutputIsNews();
  CatchInterrupts();
  ProgressLine line(args.quiet, false);
  const auto go_on = [&](double share) {
    if (line.Due()) line.Show(fmt::format("{:.0f} % of {}", 100 * share, args.out));
    return !interrupt_asked;
  };
  const Conversion end =
      mcap ? WriteTraceMcap(*trace, robot ? &*robot : nullptr, args.out, go_on, found)
           : WriteTraceCsv(*trace, args.out, go_on, found);
  line.Clear();
  if (end == Conversion::kFailed) return Fail(found, kFailed);
  if (end == Conversion::kStopped) {
    fmt::print(stderr, "interrupted; {} was not written\n", args.out);
    return kInterrupted;
  }
  if (!args.quiet) {
    fmt::print("{}: rows: {}, channels: {}\n", args.out, trace->time_s.size(),
               trace->channels.size());
    if (!mcap) SayNext({"view", args.out});
  }
  return kOk;
}

}  // namespace

void AddTraceConvert(CLI::App& group, int& exit_code) {
  auto args = std::make_shared<ConvertArguments>();
  CLI::App* command = group.add_subcommand(
      "convert", "Convert a recording to CSV, or to MCAP for Foxglove, PlotJuggler and Rerun.");
  command->add_option("recording", args->path, "Trace (.h5, .csv, .csv.gz) or folder of a run")
      ->required();
  command->add_option("--out", args->out, "Output file (.csv or .mcap)")
      ->option_text("FILE")
      ->required();
  command
      ->add_option("--channels", args->channels,
                   "Channels to convert, by patterns such as 'cable/*/tension_n' (default: all)")
      ->option_text("PATTERN")
      ->allow_extra_args(false);
  command->add_option("--period_s", args->period_s, "Time between rows [s] (default: 0, all rows)")
      ->option_text("NUMBER")
      ->check(NumberWithin(0, 1e9));
  command->add_flag("--quiet", args->quiet, "No progress, no result");
  command->footer(
      "Examples:\n"
      "  taut trace convert runs/push_20n --out push_20n.mcap\n"
      "  taut trace convert trace.h5 --out tensions.csv --channels 'cable/*/tension_n' \\\n"
      "    --period_s 0.1\n"
      "MCAP files contain one topic for each prefix of the channel names (before the first /), "
      "the\n"
      "frames of bodies (/tf) and, with inputs.yaml in the trace's folder, the robot\n"
      "(/scene/robot, /scene/cables).\n"
      "An interrupted conversion writes no file.\n"
      "Exit status: 0 success, 1 a file cannot be written, 2 bad usage, 3 bad input, 130 "
      "interrupted.");
  command->callback([args, &exit_code] { exit_code = Convert(*args); });
}

}  // namespace taut::cli
