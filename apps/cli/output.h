/// Output common to several subcommands: diagnostics, files, the folder of a run.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "taut/run.h"
#include "taut/run_folder.h"
#include "taut/spec.h"

namespace taut::cli {

/// Prints diagnostics on stderr. Returns `exit`.
int Fail(const Diagnostics& found, Exit exit);

/// Returns whether a command can continue: prints warnings on stderr and removes them. With
/// `strict`, warnings become errors. Errors stay in `found` for `Fail`.
bool Pass(Diagnostics& found, bool strict);
/// Same as `Pass` without printing, for processes of a cluster other than rank 0.
bool Passes(Diagnostics& found, bool strict);

/// Help text of `--strict`.
inline constexpr const char* kStrictHelp = "Warnings are errors";

/// Help text of `--tables`.
inline constexpr const char* kTablesHelp = "Also print the tables of all members";

/// Returns whether a path exists already, after an error that it is not overwritten.
bool IsTaken(const std::string& path);

/// Writes a file whose path the user gave. Reports errors on stderr, returns the exit status.
int WriteNamed(const std::string& path, const std::string& text);

/// Same as `WriteNamed`, but prints to standard output if the path is empty.
int WriteOrPrint(const std::string& path, const std::string& text);

/// Prints the suggested next command as the last line of a command's output: `next: taut view
/// runs/hang`.
void SayNext(std::vector<std::string> words);

/// Prints the command that draws channels of runs for a paper: `figure: taut plot runs/hang ...`.
/// `page`: page of these runs; the figure gets the same file name.
void SayFigure(std::vector<std::string> runs, const std::string& page,
               const std::vector<std::string>& more = {});

/// Same as `SayNext` for another program, whose name is the first word.
void SayNextProgram(const std::vector<std::string>& words);

/// Runs an experiment and writes traces, inputs.yaml and summary.json into a folder. `options`
/// contain no traces; their `begin` may refuse the run before warnings about the start are printed.
/// `more`: additional metadata of the trace. Returns nothing, with an error, if the experiment did
/// not run. A file that cannot be written is also an error, and then there is no summary.json.
std::optional<RunSummary> RunInto(RunFolder& folder, const ExperimentSpec& experiment,
                                  RunOptions options, bool csv, Diagnostics& out,
                                  const TraceMetadata& more = {});

/// Prints the verdict on a run and its summary, with the largest tensions of groups of cables.
void PrintRun(const RunSummary& summary, const RobotSpec& robot);

/// Values of `--symmetry`.
inline const std::map<std::string, CpgSymmetry> kSymmetries{{"segments", CpgSymmetry::kSegments},
                                                            {"index", CpgSymmetry::kIndex},
                                                            {"none", CpgSymmetry::kNone}};

}  // namespace taut::cli
