#include "output.h"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <memory>
#include <vector>

#include "taut/summary.h"
#include "taut/trace.h"

namespace taut::cli {
namespace {

namespace fs = std::filesystem;

bool Put(const fs::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file << text;
  file.close();
  return !file.fail();
}

}  // namespace

int Fail(const Diagnostics& found, Exit exit) {
  fmt::print(stderr, "{}", found.Format());
  return exit;
}

bool Pass(Diagnostics& found, bool strict) {
  if (strict) found.WarningsToErrors();
  if (!found.ok()) return false;
  fmt::print(stderr, "{}", found.Format());
  found = {};
  return true;
}

bool WriteText(const fs::path& path, const std::string& text, Diagnostics& out) {
  if (Put(path, text)) return true;
  out.Error({path.string()}, "cannot be written", "is the disk full, or the folder not yours?");
  return false;
}

int WriteNamed(const std::string& path, const std::string& text) {
  if (Put(path, text)) return kOk;
  fmt::print(stderr, "error: {} cannot be written\n", path);
  return kFailed;
}

std::optional<RunSummary> RunInto(const fs::path& folder, const ExperimentSpec& experiment,
                                  RunOptions options, bool csv, Diagnostics& out) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) out.Error({folder.string()}, "cannot make this folder: " + error.message());
  if (!out.ok()) return std::nullopt;
  const std::vector<ChannelInfo> channels = RunChannels(experiment);
  std::vector<std::unique_ptr<TraceWriter>> writers;
  writers.push_back(
      CreateHdf5Trace((folder / "trace.h5").string(), channels, RunMetadata(experiment), out));
  if (csv) writers.push_back(CreateCsvTrace((folder / "trace.csv").string(), channels, out));
  WriteText(folder / "inputs.yaml", ResolvedYaml(experiment), out);
  if (!out.ok()) return std::nullopt;
  for (const auto& writer : writers) options.traces.push_back(writer.get());
  auto summary = RunExperiment(experiment, options, out);
  if (summary) WriteText(folder / "summary.json", SummaryJson(*summary), out);
  return summary;
}

}  // namespace taut::cli
