// Command `taut report`: report pages of runs.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "apps/viewer/report.h"
#include "apps/viewer/web_files.h"
#include "commands.h"
#include "output.h"
#include "standard_streams.h"
#include "taut/run_folder.h"

namespace taut::cli {
namespace {

struct ReportArguments {
  std::string trace, out;
  std::vector<std::string> compare;
};

int Report(ReportArguments args) {
  args.trace = TraceOfRun(args.trace);
  for (std::string& other : args.compare) other = TraceOfRun(other);
  std::string missing;
  if (!viewer::FindWebFolder(missing)) {
    fmt::print(stderr, "error: {}\n", missing);
    return kFailed;
  }
  const std::string path =
      args.out.empty() ? (std::filesystem::path(args.trace).parent_path() / "report.html").string()
                       : args.out;
  OutputIsNews();
  Diagnostics found;
  const bool written = viewer::WriteReport(args.trace, args.compare, path, found);
  fmt::print(stderr, "{}", found.Format());
  if (!written) {
    const bool unwritten = found.items().front().at.file == path;
    return unwritten ? kFailed : kBadInput;
  }
  fmt::print("Report: {}\n", path);
  std::vector<std::string> runs{args.trace};
  runs.insert(runs.end(), args.compare.begin(), args.compare.end());
  SayFigure(runs, path);
  SayNextProgram({"xdg-open", path});
  return kOk;
}

}  // namespace

void AddReport(CLI::App& app, int& exit_code) {
  auto args = std::make_shared<ReportArguments>();
  CLI::App* report = app.add_subcommand("report", "Write the report of a run as one HTML file.");
  report->add_option("trace", args->trace, "Trace of the run (.h5, .csv, .csv.gz) or its folder")
      ->required();
  report->add_option("--out", args->out, "Output file (default: report.html in the trace's folder)")
      ->option_text("FILE");
  report
      ->add_option("--compare", args->compare,
                   "Traces or folders of at most 7 other runs to compare with (default: those that "
                   "the experiment lists)")
      ->option_text("TRACE");
  report->footer(
      "Examples:\n"
      "  taut report runs/push_20n\n"
      "  taut report runs/push_20n/trace.h5 --compare runs/a runs/b --out all.html\n"
      "Inputs and summary come from the trace's folder. The report opens in any browser, offline.");
  report->callback([args, &exit_code] { exit_code = Report(*args); });
}

}  // namespace taut::cli
