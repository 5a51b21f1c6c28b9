// Command `taut compare`: comparison of two traces.
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "member_groups.h"
#include "output.h"
#include "overrides.h"
#include "shipped_inputs.h"
#include "taut/compare.h"
#include "taut/run_folder.h"

namespace taut::cli {
namespace {

struct CompareArguments {
  std::string path_a, path_b, map_a, map_b, page;
  std::vector<std::string> phases;
  CompareOptions options;
  CompareLimits limits;
  bool json = false, tables = false;
  bool measured = false;  ///< B is the log of a measurement.
};

/// Parses "before=25:30"; nothing if the text has another form.
std::optional<TimeWindow> ParsePhase(const std::string& text) {
  const std::size_t equals = text.find('='), colon = text.find(':', equals);
  if (equals == 0 || equals == text.npos || colon == text.npos) return std::nullopt;
  TimeWindow phase;
  phase.name = text.substr(0, equals);
  if (!CLI::detail::lexical_cast(text.substr(equals + 1, colon - equals - 1), phase.from_s) ||
      !CLI::detail::lexical_cast(text.substr(colon + 1), phase.to_s) ||
      !(phase.from_s <= phase.to_s)) {
    return std::nullopt;
  }
  return phase;
}

/// Prints the verdict and the summary of a comparison, and its tables on request.
void PrintComparison(const Comparison& comparison, const CompareArguments& given) {
  if (given.measured) {
    const auto verdict = MeasuredVerdict(comparison, given.path_a, given.path_b);
    for (const std::string& line : verdict) fmt::print("{}\n", line);
    if (!verdict.empty()) fmt::print("\n");
  }
  const std::vector<std::string> lines = ComparisonLines(comparison, given.path_a, given.path_b);
  fmt::print("{}", CappedLines(lines).Text(lines.front()));
  if (!given.tables) return;
  fmt::print("\n{}\n", ComparisonTable(comparison, given.path_a, given.path_b));
}

void SayNextStep(const CompareArguments& given) {
  if (!given.page.empty()) {
    if (!given.measured && given.map_a.empty()) {
      SayFigure({given.path_a, given.path_b}, given.page);
      return SayNextProgram({"xdg-open", given.page});
    }
    // Only the reference can have a mapping in `taut plot`.
    std::vector<std::string> measured{"--with", given.path_b};
    if (!given.map_b.empty()) measured.insert(measured.end(), {"--map", given.map_b});
    if (given.map_a.empty()) SayFigure({given.path_a}, given.page, measured);
    return SayNextProgram({"xdg-open", given.page});
  }
  if (given.map_a.empty() && given.map_b.empty()) {
    return SayNext({"report", given.path_a, "--compare", given.path_b});
  }
  std::vector<std::string> words{"compare", given.path_a, given.path_b};
  if (!given.map_b.empty()) words.insert(words.end(), {"--map", given.map_b});
  if (!given.map_a.empty()) words.insert(words.end(), {"--map_a", given.map_a});
  words.insert(words.end(), {"--page", "compare.html"});
  SayNext(words);
}

int RunCompare(CompareArguments given) {
  for (std::string* path : {&given.path_a, &given.path_b}) *path = TraceOfRun(*path);
  Diagnostics found;
  const auto a = ReadTraceOrLog(given.path_a, given.map_a, "compared", found);
  const auto b = ReadTraceOrLog(given.path_b, given.map_b, "compared", found, &given.measured);
  if (!a || !b) return Fail(found, kBadInput);
  Pass(found, false);
  const Comparison comparison = Compare(*a, *b, given.options);
  const bool limited = given.limits.max_error_percent || given.limits.max_rmse;
  const bool comparable = comparison.rows > 0 && !comparison.channels.empty();
  const std::vector<std::string> exceeded =
      limited && comparable ? ExceededLimits(comparison, given.limits) : std::vector<std::string>();
  if (limited && comparable) {
    std::FILE* const to = given.json ? stderr : stdout;  // stdout contains only the JSON
    const std::size_t most = given.tables || exceeded.size() <= 4 ? exceeded.size() : 3;
    for (std::size_t i = 0; i < most; ++i) fmt::print(to, "FAIL: {}\n", exceeded[i]);
    if (most < exceeded.size()) {
      fmt::print(to, "FAIL: {} more limits are exceeded\n", exceeded.size() - most);
    }
    if (exceeded.empty()) fmt::print(to, "PASS: within the limits\n");
  }
  if (given.json) {
    fmt::print("{}", ComparisonJson(comparison, given.path_a, given.path_b));
  } else {
    PrintComparison(comparison, given);
  }
  if (comparison.rows == 0) {
    fmt::print(stderr, "error: the time ranges of the traces do not overlap\n");
    return kBadInput;
  }
  if (comparison.channels.empty()) {
    fmt::print(stderr, "error: the traces have no channel in common (--map translates names)\n");
    return kBadInput;
  }
  if (!given.page.empty()) {
    const std::string page =
        ComparisonPage(comparison, *a, *b, given.path_a, given.path_b, given.measured);
    if (const int failed = WriteNamed(given.page, page); failed != kOk) return failed;
    if (!given.json) fmt::print("Page: {}\n", given.page);
  }
  if (!given.json) SayNextStep(given);
  return exceeded.empty() ? kOk : kFailed;
}

}  // namespace

void AddCompare(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("compare", "Compute the differences of two traces.");
  const auto given = std::make_shared<CompareArguments>();
  command->add_option("A", given->path_a, "Trace (.h5, .csv, .csv.gz, .mcap) or folder of a run")
      ->required();
  command->add_option("B", given->path_b, "Reference: trace or folder of a run")->required();
  AddInput(*command, "--map", {"mapping"}, given->map_b,
           "Mapping file of B: channel names, units and axes")
      ->option_text("FILE");
  AddInput(*command, "--map_a", {"mapping"}, given->map_a, "Mapping file of A")
      ->option_text("FILE");
  command
      ->add_option("--channels", given->options.channels,
                   "Channels to compare, by patterns such as 'cable/*/tension_n' (default: all)")
      ->option_text("PATTERN")
      ->allow_extra_args(false);
  command->add_option("--from_s", given->options.from_s, "Start of the comparison [s]")
      ->option_text("S")
      ->check(NumberWithin(-1e9, 1e9));
  command->add_option("--to_s", given->options.to_s, "End of the comparison [s]")
      ->option_text("S")
      ->check(NumberWithin(-1e9, 1e9));
  command
      ->add_option("--phase", given->phases,
                   "Window for the mean, min and max, such as before=25:30 [s]")
      ->option_text("NAME=FROM:TO")
      ->allow_extra_args(false)
      ->check([](const std::string& text) {
        return ParsePhase(text)
                   ? std::string()
                   : "\"" + text + "\" is not of the form NAME=FROM:TO, such as before=25:30";
      });
  command
      ->add_option("--system", given->options.system,
                   "Channels whose largest value is compared as the system's largest value")
      ->option_text("PATTERN")
      ->allow_extra_args(false)
      ->default_str("cable/*/tension_n cable/*/elastic_n");
  command
      ->add_option("--max_lag_s", given->options.max_lag_s,
                   "Largest delay to estimate [s]; 0: none")
      ->option_text("S")
      ->check(NumberWithin(0, 1e9))
      ->capture_default_str();
  command
      ->add_option("--max_error_percent", given->limits.max_error_percent,
                   "Limit of the error of the system's largest value [%]")
      ->option_text("X")
      ->check(NumberWithin(0, 1e9));
  command
      ->add_option("--max_rmse", given->limits.max_rmse,
                   "Limit of the RMSE of every compared channel, in its unit")
      ->option_text("X")
      ->check(NumberWithin(0, 1e300));
  command->add_option("--page", given->page, "Also write the comparison as an HTML page")
      ->option_text("FILE");
  command->add_flag("--json", given->json, "JSON instead of text");
  command->add_flag("--tables", given->tables, "Also print the tables of all channels");
  command->footer(
      "Examples:\n"
      "  taut compare runs/push/trace.h5 measured.csv --max_error_percent 6.1\n"
      "  taut compare runs/push/trace.h5 push_1000hz.csv.gz --map mappings/ntrt.json \\\n"
      "    --channels 'cable/*/elastic_n' --from_s 5 --phase before=25:30 --phase during=35:40\n"
      "  taut compare runs/drop lab.csv --map lab.map.json --page compare.html\n"
      "Exit status: 0 within the limits (or no limits), 1 limits exceeded, 2 bad usage, 3 bad "
      "input.");
  command->callback([given, &exit_code] {
    for (const std::string& phase : given->phases) {
      given->options.phases.push_back(*ParsePhase(phase));
    }
    exit_code = RunCompare(*given);
  });
}

}  // namespace taut::cli
