#include "output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "member_groups.h"
#include "taut/files.h"
#include "taut/summary.h"
#include "taut/trace.h"

namespace taut::cli {
namespace {

/// Quotes a word for shells if it contains special characters.
std::string ShellWord(const std::string& word) {
  const bool plain = std::all_of(word.begin(), word.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("-_./:=+,@%").find(c) != std::string_view::npos;
  });
  if (plain && !word.empty()) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

/// Prints a command after a label.
void SayCommand(const char* label, const std::vector<std::string>& words) {
  std::string line = fmt::format("{}:", label);
  for (const std::string& word : words) line += " " + ShellWord(word);
  fmt::print("{}\n", Printable(line));
}

/// Returns the largest tensions of a group of cables, and their means in the phases of the run.
std::string TensionLine(const RunSummary& summary, const CableGroup& group) {
  const auto range = [&](const auto& value) {
    return RangeOver(group, [&](std::size_t c) { return value(summary.cables[c].tension); })
        .Text(2, "N");
  };
  std::string line = fmt::format("{}: max tension {}", group.name,
                                 range([](const auto& tension) { return tension.max_n; }));
  constexpr std::size_t kMostPhases = 3;
  for (std::size_t i = 0; i < std::min(summary.phases.size(), kMostPhases); ++i) {
    const PhaseSpec& phase = summary.phases[i];
    const bool reached = phase.to_s <= summary.simulated_s * (1.0 + 1e-9) &&
                         i < summary.cables[group.cables.front()].tension.phases.size();
    if (!reached) continue;
    line += fmt::format("; mean {} {}", phase.name,
                        range([&](const auto& tension) { return tension.phases[i].mean; }));
  }
  return line;
}

}  // namespace

int Fail(const Diagnostics& found, Exit exit) {
  fmt::print(stderr, "{}", found.Format());
  return exit;
}

bool IsTaken(const std::string& path) {
  std::error_code failed;
  if (!std::filesystem::exists(std::filesystem::symlink_status(path, failed))) return false;
  fmt::print(stderr, "{}: error: the file exists already, and is not overwritten\n", path);
  return true;
}

bool Passes(Diagnostics& found, bool strict) {
  if (strict) found.WarningsToErrors();
  return found.ok();
}

bool Pass(Diagnostics& found, bool strict) {
  if (!Passes(found, strict)) return false;
  fmt::print(stderr, "{}", found.Format());
  found = {};
  return true;
}

int WriteNamed(const std::string& path, const std::string& text) {
  Diagnostics found;
  return WriteWholeFile(path, text, found) ? kOk : Fail(found, kFailed);
}

int WriteOrPrint(const std::string& path, const std::string& text) {
  if (!path.empty()) return WriteNamed(path, text);
  fmt::print("{}", text);
  return kOk;
}

void SayNext(std::vector<std::string> words) {
  words.insert(words.begin(), "taut");
  SayNextProgram(words);
}

void SayFigure(std::vector<std::string> runs, const std::string& page,
               const std::vector<std::string>& more) {
  constexpr std::size_t kMostRuns = 4;  // limit of `taut plot`
  runs.resize(std::min(runs.size(), kMostRuns));
  std::vector<std::string> words{"taut", "plot"};
  words.insert(words.end(), runs.begin(), runs.end());
  words.insert(words.end(), more.begin(), more.end());
  words.insert(words.end(), {"--out", std::filesystem::path(page).replace_extension("pdf")});
  SayCommand("figure", words);
}

void SayNextProgram(const std::vector<std::string>& words) { SayCommand("next", words); }

std::optional<RunSummary> RunInto(RunFolder& folder, const ExperimentSpec& experiment,
                                  RunOptions options, bool csv, Diagnostics& out,
                                  const TraceMetadata& more) {
  const std::vector<ChannelInfo> channels = RunChannels(experiment, options.plant);
  TraceMetadata metadata = RunMetadata(experiment);
  metadata.emplace_back(kRunIdKey, folder.id());
  metadata.insert(metadata.end(), more.begin(), more.end());
  std::vector<std::unique_ptr<TraceWriter>> writers;
  std::vector<std::string> names{"trace.h5"};
  writers.push_back(CreateHdf5Trace(folder.Path("trace.h5"), channels, metadata, out));
  if (csv) {
    names.push_back("trace.csv");
    writers.push_back(CreateCsvTrace(folder.Path("trace.csv"), channels, out));
  }
  folder.Prepare(ResolvedYaml(experiment), out);
  if (!out.ok()) return std::nullopt;
  writers.back() = folder.BeginWith(std::move(writers.back()), std::move(names));
  for (const auto& writer : writers) options.traces.push_back(writer.get());
  options.begin = [refuses = std::move(options.begin)](Diagnostics& found) {
    return (!refuses || refuses(found)) && Pass(found, false);
  };
  auto summary = RunExperiment(experiment, options, out);
  if (!summary) return std::nullopt;
  summary->run = folder.id();
  if (out.ok()) folder.Finish(SummaryJson(*summary), out);
  return summary;
}

void PrintRun(const RunSummary& summary, const RobotSpec& robot) {
  const std::vector<std::string> all = SummaryLines(summary);
  CappedLines lines(all);
  if (summary.cables.size() == robot.def.cables.size() && summary.cables.size() > 1) {
    for (const CableGroup& group : GroupCables(robot, 6)) lines.Add(TensionLine(summary, group));
  }
  fmt::print("{}", lines.Text(all.front()));
}

}  // namespace taut::cli
